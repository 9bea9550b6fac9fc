"""A design under all conditions by two routes: looked at one by one, or in arrays, and what each finds wrong."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.damper import second_route
from yawdesign.damper.design_space import Space
from yawdesign.damper.second_route import AGREE, checked_under_all, margin_by_routh

CONDITIONS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.7, 0.5]}


def space_of(objective="decay_rate", conditions=CONDITIONS):
    design = yd.Design(objective=objective, variables=yd.table1().design.variables)
    return Space(yd.table1().replace(design=design, conditions=conditions))


def values_of(space, C_s, K_m=626480.0):
    return {**space.fixed, "C_m": 19950.0, "K_m": K_m, "C_s": C_s}


def by_hand(independent, space, values):
    """Return decay rate and damping ratio under each condition."""
    found = []
    for condition in space.conditions:
        given = condition.described
        p = {**values, "v": given["speed"], "lambda": given["lambda"]}
        p |= {name: given["creep_factor"] * p[name] for name in ("f_11", "f_22")}
        s = independent.eigenvalues("power", p)[0]
        found.append((-s.real.max(), (-s.real / abs(s)).min()))
    return np.array(found).T


@pytest.fixture(params=[24, 2], ids=["one by one", "two of fifteen"])
def looked_at(request, monkeypatch):
    monkeypatch.setattr(second_route, "LOOKED_AT", request.param)


@given(C_s=st.floats(4.5, 6.4).map(lambda x: 10**x), objective=st.sampled_from(sorted(AGREE)))
@settings(max_examples=3, deadline=None)
def assert_found(independent, C_s, objective):
    space = space_of(objective)
    checked = checked_under_all(space, values_of(space, C_s))
    rates, ratios = by_hand(independent, space, values_of(space, C_s))
    own = rates if objective == "decay_rate" else ratios
    assert checked.margin == pytest.approx(own.min(), rel=1e-6, abs=1e-8)
    assert checked.worst == space.conditions[int(own.argmin())]
    assert checked.stable == (rates.min() > 0)
    assert checked.agree
    assert checked.second == pytest.approx(checked.margin, abs=AGREE[objective])
    assert checked.vehicles[0].p["lambda"] == checked.worst.described["lambda"]
    assert getattr(checked.results[0], objective) == checked.margin


def test_the_worst_by_both_routes(independent, looked_at):
    assert_found(independent)


def test_a_list_with_one_unstable_condition_is_unstable(independent, looked_at):
    """Whatever margin is asked for: 1 MN s/m is unstable under one of the fifteen or a few."""
    space = space_of()
    values = values_of(space, 1.1e6)
    rates, _ = by_hand(independent, space, values)
    assert 0 < np.sum(rates < 0) < 15
    assert not checked_under_all(space, values).stable


@pytest.mark.parametrize("objective", sorted(AGREE))
def test_a_margin_that_is_not_there_is_no_margin(objective):
    """Routh's array looks around the margin by eigenvalues: where this is wrong, it finds nothing there."""
    space = space_of(objective, {})
    values = values_of(space, 1.5e6)
    vehicle = space.model.at({**values, "v": 300 / 3.6})
    margin = float(space.margins(values))
    assert margin_by_routh(space, [vehicle], margin) == pytest.approx(margin, abs=AGREE[objective])
    for wrong in (margin * 0.9, margin * 1.1):
        assert not abs(margin_by_routh(space, [vehicle], wrong) - wrong) <= AGREE[objective]


@pytest.mark.parametrize(("others", "agree"), [(False, True), (True, False)], ids=["as it is", "one is wrong"])
def test_eigenvalues_that_are_wrong_are_found_out(monkeypatch, others, agree):
    """By the one of a condition that is looked at, and, of the others, by verdicts in arrays."""
    space = space_of()
    stability_at = second_route.stability_at

    def wrong(vehicle, variables):
        found = stability_at(vehicle, variables)
        return replace(found, decay_rate=found.decay_rate + 0.01) if others else found

    monkeypatch.setattr(second_route, "stability_at", wrong)
    assert checked_under_all(space, values_of(space, 2e6)).agree is agree


def test_conditions_far_from_the_worst_are_looked_at_by_verdicts(monkeypatch):
    """With a margin that those do not exceed, the routes differ."""
    monkeypatch.setattr(second_route, "LOOKED_AT", 1)
    space = space_of()
    asked = second_route.WorstMargin.exceeds
    assert checked_under_all(space, values_of(space, 2e6)).agree
    monkeypatch.setattr(second_route.WorstMargin, "exceeds", lambda own, sets, level: ~asked(own, sets, level))
    checked = checked_under_all(space, values_of(space, 2e6))
    assert not checked.agree
    assert not checked.stable
