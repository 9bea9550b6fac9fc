"""The model, which equations, and the vehicle, a model at given numbers that assembles itself once."""

import pickle
import sys

import flint
import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.catalogue import CATALOGUE
from yawdesign.vehicle.elements import Link, Maxwell
from yawdesign.vehicle.motions import COUPLED
from yawdesign.vehicle.vehicle import Model, Vehicle

PRINTED, RECIPROCAL, TRAILER = Model(equations="as-printed"), Model(), Model("trailer")
TOGETHER, AGAINST = "motors yawing together", "motors yawing against each other"


def test_a_model_is_a_key():
    assert {Model("power", "reciprocal"): 1}[Model()] == 1
    assert len({PRINTED, RECIPROCAL, TRAILER, Model("power", "as-printed")}) == 3
    with pytest.raises(AttributeError):
        PRINTED.kind = "trailer"


def test_a_model_travels_light(vehicle_model):
    sent = pickle.dumps(vehicle_model)
    assert len(sent) < 400  # the names of its parameters
    assert vehicle_model.sources  # what is found out about a model is not sent with it
    assert pickle.dumps(vehicle_model) == sent
    assert pickle.loads(sent) == vehicle_model


def test_the_model_of_a_problem():
    assert Model.of(yd.table1()) == RECIPROCAL
    assert Model.of(yd.table1(equations="as-printed")) == PRINTED
    assert Model.of(yd.table1(kind="trailer")).kind == "trailer"


def test_parameters_of_a_model(table1, vehicle_model):
    own = set(vehicle_model.parameters)
    assert {"C_s", "v", "lambda"} <= own
    assert own <= {*table1, "C_s"}
    assert ("K_m" in own) == (vehicle_model.kind == "power")


class Watched(dict):
    """Parameters that remember which of them were asked for."""

    def __init__(self, p):
        super().__init__(p)
        self.asked = set()

    def __getitem__(self, name):
        self.asked.add(name)
        return super().__getitem__(name)

    def get(self, name, default=None):  # of what a vehicle may have, and this one has not
        self.asked |= {name} & self.keys()
        return super().get(name, default)


def test_the_parameters_of_a_model_are_those_that_its_elements_ask_for(table1, vehicle_model):
    p = Watched({**table1, "C_s": 1e6})
    CATALOGUE[vehicle_model.kind](p, vehicle_model.equations)
    assert p.asked == set(vehicle_model.parameters)


def test_sources_are_what_changes_a_motion(table1, vehicle_model, random_vehicles, rational):
    """Whether a motion depends on a parameter is seen by changing it, in exact rationals."""
    for p in (table1, *(vehicle.p for vehicle in random_vehicles(1, spread=10, seed=3))):
        vehicle = vehicle_model.at(rational({**p, "C_s": 1e6}))
        changing = {motion.name: set() for motion in vehicle.motions}
        for name in vehicle_model.parameters:
            changed = vehicle.replace(**{name: vehicle.p[name] * flint.fmpq(8, 7)})
            for one, other in zip(vehicle.motions, changed.motions, strict=True):
                if one.coefficients != other.coefficients:
                    changing[one.name].add(name)
        assert vehicle_model.sources == changing
        assert list(vehicle_model.sources) == [motion.name for motion in vehicle.motions]


def test_sources_of_the_decoupled_motions():
    motors = {"J_m", "K_mphi", "C_mphi"}
    assert {name: x for name, x in PRINTED.sources.items() if name != COUPLED} == {TOGETHER: motors, AGAINST: motors}
    assert {name: x for name, x in RECIPROCAL.sources.items() if name != COUPLED} == {AGAINST: motors}
    assert list(TRAILER.sources) == [COUPLED]
    for model in (PRINTED, RECIPROCAL, TRAILER):
        assert "C_s" not in model.sources[COUPLED]
        assert {"K_ds", "b_3", "v", "lambda"} <= model.sources[COUPLED]


def test_joints():
    assert PRINTED.joints == RECIPROCAL.joints == {"C_s": "K_ds", "C_t": "K_dt", "C_m": "K_dm"}
    assert TRAILER.joints == {"C_s": "K_ds", "C_t": "K_dt"}


def test_joints_are_the_series_stiffnesses(table1, vehicle_model):
    """A damper with joints of a thousandth of the stiffness is one with hardly any force, and no other damper is."""
    for damping, joint in vehicle_model.joints.items():
        vehicle = vehicle_model.at({**table1, "C_s": 1e6})
        soft = vehicle.replace(**{joint: vehicle.p[joint] / 1000})
        laws = [
            [law for e in x.physical if isinstance(e, Link) for law in e.laws if isinstance(law, Maxwell)]
            for x in (vehicle, soft)
        ]
        changed = [one.c for one, other in zip(*laws, strict=True) if one.K != other.K]
        assert changed
        assert all(vehicle.p[damping] / c in (1, 2) for c in changed)


@pytest.mark.parametrize(
    ("which", "variables", "expected"),
    [
        (RECIPROCAL, (), (COUPLED,)),
        (RECIPROCAL, ("C_s", "K_m", "C_m"), (COUPLED,)),
        (RECIPROCAL, ("K_mphi",), (COUPLED, AGAINST)),
        (PRINTED, ("C_s", "J_m"), (COUPLED, AGAINST, TOGETHER)),
        (PRINTED, ("C_s",), (COUPLED,)),
        (TRAILER, ("C_s", "K_1x"), (COUPLED,)),
    ],
)
def test_movable_motions(which, variables, expected):
    found = which.movable(variables)
    assert found[0] == COUPLED
    assert sorted(found) == sorted(expected)


def test_the_vehicles_of_a_problem():
    problem = yd.table1().replace(C_s=8e5)
    (vehicle,) = Vehicle.of(problem)
    assert vehicle.model == RECIPROCAL
    assert (vehicle.v, vehicle.C_s) == (pytest.approx(300 / 3.6), 8e5)
    assert set(vehicle.p) == set(RECIPROCAL.parameters)
    ranged = problem.replace(speed=yd.SpeedRange(min=50.0, max=80.0, steps=4))
    assert [vehicle.v for vehicle in Vehicle.of(ranged)] == pytest.approx([50, 60, 70, 80])
    assert len({vehicle.model for vehicle in Vehicle.of(ranged)}) == 1


def test_other_numbers_make_another_vehicle(table1):
    vehicle = RECIPROCAL.at(table1, C_s=1e6)
    assert vehicle.motions is vehicle.motions
    other = vehicle.replace(C_s=2e6, lambda_=0.3)
    assert (other.C_s, other.p["lambda"], vehicle.p["lambda"]) == (2e6, 0.3, table1["lambda"])
    assert "lambda_" not in other.p
    assert other.model is vehicle.model
    assert other.coupled.coefficients != vehicle.coupled.coefficients
    assert RECIPROCAL.at(table1).C_s == 0


def test_a_vehicle_under_a_condition(table1):
    vehicle = RECIPROCAL.at(table1, C_s=1e6)
    found = vehicle.under(Condition((("v", 70.0), ("lambda", 0.2), ("creep_factor", 0.5))))
    assert (found.v, found.p["lambda"], found.C_s) == (70.0, 0.2, 1e6)
    assert found.p["f_11"] == table1["f_11"] / 2
    assert vehicle.v == table1["v"]


def test_the_whole_polynomial_is_the_product(table1, vehicle_model):
    vehicle = vehicle_model.at(table1, C_s=1e6)
    s = 3 + 20j
    parts = [np.polyval(motion.polynomial(1e6)[::-1], s) for motion in vehicle.motions]
    assert np.polyval(vehicle.polynomial[::-1], s) == pytest.approx(np.prod(parts), rel=1e-12)


@pytest.fixture
def assemblies(monkeypatch):
    """Return a list that gets the types of the numbers of every vehicle that is assembled, all caches being cold."""
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] == "yawdesign":
            for cache in (x for x in vars(module).values() if hasattr(x, "cache_clear")):
                cache.cache_clear()
    found, build = [], CATALOGUE["power"]

    def counted(p, *more):
        found.append({type(x).__name__ for x in p.values()})
        return build(p, *more)

    monkeypatch.setitem(CATALOGUE, "power", counted)
    return found


def test_a_vehicle_is_assembled_once(table1, assemblies):
    vehicle = RECIPROCAL.at(table1, C_s=1e6)
    assert assemblies == []
    for _ in range(2):
        assert vehicle.motions
        assert vehicle.polynomial
        assert vehicle.paper_coefficients()
        assert vehicle.state_space.outputs
        assert vehicle.folded_state_space.states
    # Besides, once for all vehicles of a model: which parameters its dampers are made of.
    assert [kinds for kinds in assemblies if kinds != {"Sources"}] == [{"float"}]
    assert len(assemblies) == 2


def test_stability_assembles_one_vehicle_once(assemblies):
    yd.stability(yd.table1().replace(C_s=1e6))
    assert len([kinds for kinds in assemblies if kinds != {"Sources"}]) == 1
    assemblies.clear()
    yd.stability(yd.table1().replace(C_s=2e6))
    assert len(assemblies) == 1


def test_design_assembles_for_each_yaw_damping_it_looks_at(assemblies):
    """Its motions, the eigenvalues in every interval of C_s at once, those at C_sl and at the chosen C_s: no more."""
    yd.design(yd.table1())
    assemblies.clear()
    yd.design(yd.table1())
    assert len(assemblies) <= 4
