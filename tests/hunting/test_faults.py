"""Faults of a vehicle: one yaw damper of one bogie lost, and of both."""

from dataclasses import replace

import pytest

import yawdesign as yd
from yawdesign.problem.cases import Case, Change

CAR_BODY = yd.CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)


def lost(end):
    return Case(f"lost {end}", tuple(Change(f"{end}{name}", 0.5, share=True) for name in ("C_s", "K_ds")))


CASES = (lost("leading."), lost("trailing."), lost(""))
VEHICLE = replace(yd.table1(), car_body=CAR_BODY, cases=CASES).replace(C_s=1.047e6)


@pytest.mark.parametrize(
    ("conicity", "all_there", "leading", "trailing"), [(0.15, 0.0336, 0.0186, 0.0403), (0.10, None, -0.022, 0.017)]
)
def test_one_yaw_damper_of_one_bogie(conicity, all_there, leading, trailing):
    """Leading and trailing differ: a single bogie cannot answer this."""
    result = yd.stability(VEHICLE.replace(lambda_=conicity))
    assert all_there is None or result.damping_ratio == pytest.approx(all_there, abs=6e-5)
    found = result.cases
    assert [case.damping_ratio for case in found[:2]] == pytest.approx([leading, trailing], abs=6e-4)
    assert [case.stable for case in found[:2]] == [leading > 0, trailing > 0]
    assert all(case.checked for case in found)
    assert found[0].worst_condition == {"speed": pytest.approx(300 / 3.6)}


def test_a_fault_of_both_bogies_is_another_design():
    p = VEHICLE.bogie
    both = yd.stability(VEHICLE).cases[2]
    designed = yd.stability(replace(VEHICLE, cases=()).replace(C_s=p.C_s / 2, K_ds=p.K_ds / 2))
    assert both.decay_rate == pytest.approx(designed.decay_rate, rel=1e-9)
    assert both.damping_ratio == pytest.approx(designed.damping_ratio, rel=1e-9)


def test_a_bogie_whose_dampers_are_gone():
    """A share of zero removes them: their strokes are no states, and their modes are not listed."""
    none = Case("none left", (Change("trailing.C_s", 0.0, share=True),))
    result = yd.stability(replace(VEHICLE, cases=(none,)))
    assert result.cases[0].checked
    assert result.cases[0].damping_ratio < result.damping_ratio


def test_dampers_against_each_other_have_the_bogie_in_their_name():
    fixed = yd.stability(replace(VEHICLE, cases=())).fixed_modes
    root = -VEHICLE.bogie.K_ds / VEHICLE.bogie.C_s
    for bogie in ("leading", "trailing"):
        assert fixed[f"yaw dampers against each other, {bogie} bogie"] == (pytest.approx(root),)


def test_what_the_answer_does_not_hold():
    assert yd.stability(VEHICLE).scope == ""
    assert "DO NOT RELY" in yd.stability(yd.table1()).scope
    assert "stands still" in yd.design(yd.table1().replace(lambda_=0.3)).scope
    assert "DO NOT RELY" not in yd.design(yd.table1().replace(lambda_=0.3)).scope


def test_a_vehicle_without_conicity_is_held_by_nothing():
    """Its shift meets no force: a root at zero, which both ways of counting see."""
    result = yd.stability(replace(VEHICLE, cases=()).replace(lambda_=0.0))
    assert not result.stable
    assert result.checked
    assert result.spectral_abscissa == 0.0
