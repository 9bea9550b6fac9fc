"""A vehicle's answer beside that of one of its bogies: where they part."""

from dataclasses import replace

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.single_bogie import partings
from yawdesign.hunting.verdict import stability_at
from yawdesign.vehicle.vehicle import Vehicle

CAR_BODY = yd.CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
PROBLEM = replace(yd.table1(), car_body=CAR_BODY)


def needed(vehicle):
    """Return the damping above which a vehicle is stable, by a scan of eigenvalues from above."""
    values = np.geomspace(1e3, 1e8, 600)[::-1]
    unstable = (C_s for C_s in values if not stability_at(vehicle.replace(C_s=float(C_s))).stable)
    return next(unstable, 0.0)


def test_both_answers_stand_side_by_side():
    result = yd.design(PROBLEM.replace(lambda_=0.05))
    alone = yd.design(replace(yd.table1(), car_body=None).replace(lambda_=0.05))
    assert result.C_sl == pytest.approx(1.896e6, rel=1e-3)
    assert result.single_bogie.C_sl == alone.C_sl == pytest.approx(171e3, rel=5e-3)
    assert result.single_bogie.stable is False  # its own design hunts under the car body
    assert result.scope == ""
    assert alone.single_bogie is None


def test_where_they_part_by_eigenvalues():
    (vehicle,) = Vehicle.of(PROBLEM)
    found = partings(vehicle)
    assert [x.creep_factor for x in found] == [1.0, 0.7, 0.5]
    for conicity in (0.05, 0.1, 0.25):
        changed = vehicle.replace(lambda_=conicity)
        apart = needed(changed) > 1.1 * needed(changed.bogie)
        assert apart == any(low <= conicity <= high for low, high in found[0].conicities)
