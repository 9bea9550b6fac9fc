"""Derivatives of a critical value by eigenvectors, against those of the boundary's graph and against differences."""

import numpy as np
import pytest

from yawdesign import table1
from yawdesign.hunting.boundary import boundary_slope, parameter_names
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.sensitivity import sensitivity
from yawdesign.vehicle.vehicle import Model, Vehicle


def by_the_graph(vehicle, x):
    names = parameter_names(vehicle.p)
    p, z = [vehicle.p[name] for name in names], [np.log(x.C_s), x.omega / TIME_UNIT]
    slope = np.array(boundary_slope(vehicle.model, names)(z, p)).ravel()
    return {name: value * g for name, value, g in zip(names, p, slope, strict=True)}


def last(vehicle):
    return critical_damping(vehicle).critical[-1]


def test_a_bogie(table1, vehicle_model):
    vehicle = vehicle_model.at(table1)
    x = last(vehicle)
    assert sensitivity(vehicle, x.C_s, x.omega) == pytest.approx(by_the_graph(vehicle, x), abs=1e-8)


def test_a_vehicle_with_a_car_body(reference_vehicle):
    vehicle = reference_vehicle("trailer")
    x = last(vehicle)
    found = sensitivity(vehicle, x.C_s, x.omega)
    assert found == pytest.approx(by_the_graph(vehicle, x), abs=1e-8)
    for name in found:
        up, down = (last(vehicle.replace(**{name: vehicle.p[name] * (1 + h)})).C_s for h in (1e-5, -1e-5))
        assert found[name] == pytest.approx((up - down) / (2e-5 * x.C_s), rel=1e-5, abs=1e-6)


def test_the_rootfinder_solves_a_vehicle(reference_vehicle):
    from yawdesign.hunting import boundary as graphs

    vehicle = reference_vehicle("trailer")
    names, x = parameter_names(vehicle.p), last(vehicle)
    p = [vehicle.p[name] for name in names]
    z = np.array(graphs.rootfinder(vehicle.model, names)([np.log(x.C_s) + 0.01, x.omega / TIME_UNIT], p)).ravel()
    assert (np.exp(z[0]), z[1] * TIME_UNIT) == pytest.approx((x.C_s, x.omega), rel=1e-8)


def test_where_no_eigenvalue_lies_there_are_no_derivatives():
    (vehicle,) = Vehicle.of(table1())
    x = last(vehicle)
    assert sensitivity(vehicle, 2 * x.C_s, x.omega) == {}


def test_zero_parameters_have_no_relative_slope(table1):
    vehicle = Model().at(table1, C_m=0.0)
    x = last(vehicle)
    assert sensitivity(vehicle, x.C_s, x.omega)["C_m"] == 0
