"""One result of every kind, made once."""

from functools import cache
from pathlib import Path

import pytest

import yawdesign as yd
from yawdesign.output.tables_by_result import TABLES_BY

PROBLEMS = Path(__file__).parents[2] / "problems"
FAULTS = {"one of the two yaw dampers of the bogie lost": {"C_s": "50 %", "K_ds": "50 %"}}
LOADS = {"laden": {"W": "210 kN"}, "tare": {"W": "150 kN"}}
CONDITIONS = {"lambda": [0.05, 0.4], "creep_factor": [1.0, 0.5], "load": LOADS}
UNCERTAIN = {"lambda": {"uniform": [0.05, 0.4]}, "creep_factor": {"uniform": [0.5, 1]}}
LEAST = {"damping_ratio": "1 %", "cases": {"damping_ratio": "0.1 %"}}


def problem():
    """Return a problem that has something of everything."""
    given = yd.table1().replace(title="Bogie of Table I", C_s="1 046 770 N s/m", cases=FAULTS, requirements=LEAST)
    design = yd.Design(variables={"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")})
    return given.replace(conditions=CONDITIONS, design=design)


def choice():
    rows = [yd.CatalogueDamper(name=f"damper {k} of a maker", damping=2e5 + 5e3 * k, stiffness=2e7) for k in range(200)]
    return yd.choose(problem().replace(design=yd.Design(catalogue=rows)))


def trade_off():
    point = {"rotational_resistance": 0.0512345, "margin": -0.317031, "C_s": 1e6, "K_m": 62648e2, "C_m": 25799.4}
    point |= {"stable": False, "checked": True, "requirements": ()}
    worst = [{"speed": 250 / 3, "lambda": x, "creep_factor": 0.5, "load": "tare"} for x in (0.05, 0.25)]
    points = [{**point, "worst_condition": each} for each in worst]
    return yd.TradeOff(tuple(points), "decay_rate", 0.08, points[0], None, 0.09, "ok", "found", "all 15 conditions")


class Results:
    """Every kind of result; each is made when it is first asked for."""

    names = tuple(TABLES_BY)

    def __init__(self, folder):
        self.folder = folder

    @cache  # noqa: B019 - one object, for the whole session
    def __getitem__(self, name):
        plain, whole = yd.table1().replace(C_s="1 046 770 N s/m"), problem()
        return {
            "Problem": problem,
            "Stability": lambda: yd.stability(whole),
            "CriticalSpeeds": lambda: yd.critical_speed(plain),
            "ForwardDesign": lambda: yd.design(whole),
            "Optimum": lambda: yd.optimise(whole),
            "Choice": choice,
            "TradeOff": trade_off,
            "Sweep": lambda: yd.sweep(plain, of="critical", f_m=[2.0, 3.27]),
            "Uncertainty": lambda: yd.uncertainty(plain.replace(uncertainty=UNCERTAIN), samples=2**10),
            "Simulation": lambda: yd.simulate(yd.load(PROBLEMS / "vehicle.yaml"), duration="2 s"),
            "DamperComponent": lambda: yd.damper_component(plain, duration="2 s"),
            "FrequencyResponse": lambda: yd.frequency_response(plain, wavelength=[5.0, 10.0, 20.0]),
            "StationaryResponse": lambda: yd.stationary_response(plain),
            "SpectrumCheck": lambda: yd.spectrum_check(length="2 km"),
            "Modes": lambda: yd.modes(yd.load(PROBLEMS / "vehicle.yaml")),
            "FollowedModes": lambda: yd.follow_modes(plain, v=[60.0, 70.0, 80.0]),
            "Export": lambda: yd.export(plain, self.folder / "export", only="dynamic_stiffness", formats="casadi"),
            "Fmu": lambda: yd.Fmu(str(self.folder / "a.fmu"), None, "there is no compiler", {"values": "as written"}),
            "StateSpaceModel": lambda: yd.state_space(plain),
        }[name]()


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Return one result of every kind by its name, and a problem."""
    return Results(tmp_path_factory.mktemp("results"))


def pytest_generate_tests(metafunc):
    """Run a test that asks for the name of a kind of result once for each."""
    if "kind_of_result" in metafunc.fixturenames:
        metafunc.parametrize("kind_of_result", Results.names)
