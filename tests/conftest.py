"""Reference bogies, random bogies and exact arithmetic for the tests."""

import importlib.util
import json
import signal
from fractions import Fraction
from pathlib import Path

import flint
import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from yawdesign.vehicle.vehicle import Model

# How long an example takes says nothing where other work goes on beside it.
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")

CASES = json.loads((Path(__file__).parent / "data" / "cases.json").read_text(encoding="utf-8"))["cases"]
TABLE_1 = CASES[0]["bogie"]
VEHICLES = json.loads((Path(__file__).parent / "data" / "vehicle.json").read_text(encoding="utf-8"))["cases"]
CAR_BODY = VEHICLES[0]["car_body"]
MODELS = [("power", "as-printed"), ("power", "reciprocal"), ("trailer", "reciprocal")]
NARROW = {
    "M_b": 9039.58, "J_b": 9902.78, "M_w": 2217.15, "J_w": 2202.6, "M_m": 1617.43, "J_m": 1261.39, "W": 185130,
    "K_1x": 49286400, "K_1y": 5213830, "K_2x": 931438, "K_2y": 675889, "K_m": 489176, "K_mphi": 333243,
    "K_ds": 29312600, "K_dt": 33808300, "K_dm": 33011400, "C_t": 65410.1, "C_mphi": 16413.4, "C_m": 28991.4,
    "a": 1.5399, "b": 0.91796, "a_0": 1.00365, "b_0": 0.420661, "b_1": 0.811462, "b_2": 1.27891, "b_3": 0.916541,
    "r": 0.748269, "lambda": 0.5, "f_11": 8008740, "f_22": 10645000, "C_s": 117280.942,
}  # fmt: skip


def pytest_configure():
    """Take requests to stop as a terminal gives them: what starts tests in the background may have them ignored."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler if name == "SIGINT" else signal.SIG_DFL)


def pytest_generate_tests(metafunc):
    """Run a test that asks for `case` on every reference bogie, one that asks for a model on all three models.

    One that asks for `reference_case` is run on every reference vehicle with a car body.
    """
    if "case" in metafunc.fixturenames:
        names = [f"{c['name']}-{c['equations']}-{c['kind']}" for c in CASES]
        metafunc.parametrize("case", CASES, ids=names)
    if "reference_case" in metafunc.fixturenames:
        metafunc.parametrize("reference_case", VEHICLES, ids=[c["name"] for c in VEHICLES])
    if "model" in metafunc.fixturenames:
        models = [{"kind": kind, "equations": equations} for kind, equations in MODELS]
        metafunc.parametrize("model", models, ids=[" ".join(m) for m in MODELS])
    if "vehicle_model" in metafunc.fixturenames:
        metafunc.parametrize("vehicle_model", [Model(*m) for m in MODELS], ids=[" ".join(m) for m in MODELS])


# What may come into a text by mistake or on purpose.
PIECES = (
    *(
        "",
        " ",
        "  ",
        "\n",
        "\t",
        ",",
        ";",
        ".",
        ":",
        ": ",
        "#",
        "[",
        "]",
        "{",
        "}",
        "(",
        ")",
        "-",
        "+",
        "*",
        "/",
        "^",
        "_",
        "%",
    ),
    *(
        "'",
        '"',
        "\\",
        "\0",
        "\x1b",
        "\u2028",
        "\u00a0",
        "\u2212",
        "²",
        "⁻",
        "×",
        "é",
        "😀",
        "\ufeff",
        "\uffff",
        '"\\ud800"',
    ),
    *(
        "1e400",
        "1e-400",
        "9" * 400,
        "1_0",
        ".nan",
        "inf",
        "0x1F",
        "1,5",
        "1 000",
        "×10⁶",
        "^9)^9",
        "((((((((((",
        "12+345.6",
    ),
    *(
        "km/h",
        "kN.s/m",
        "rad/m",
        "1/m",
        "m^2/(1/m)",
        "[mm]",
        "[rad/m]",
        "km+m",
        "&a [*a]",
        "*a",
        "&a ",
        "!t ",
        "<<: ",
        "? ",
    ),
    *(
        "- ",
        "| ",
        "> ",
        "~",
        "true",
        "---\n",
        "...\n",
        "%YAML 1.1\n",
        "wavenumber",
        "distance",
        "alignment",
        "speed",
        "base",
    ),
)


@pytest.fixture(scope="session")
def mutated():
    """Return a text after a few random edits: pieces put in, cut out, doubled and exchanged."""

    def mutate(text, rng):
        for _ in range(rng.integers(1, 4)):
            low, high = sorted(rng.integers(0, len(text) + 1, 2))
            high = min(high, low + int(rng.choice([1, 1, 2, 30])))
            piece = PIECES[rng.integers(len(PIECES))]
            edits = (
                piece,
                "",
                2 * text[low:high],
                text[low:high][::-1],
                text[low:high] + piece,
                piece * int(rng.choice([2, 50])),
            )
            text = text[:low] + edits[rng.integers(len(edits))] + text[high:]
        return text

    return mutate


def _module(path):
    """Return a module of the tests that no test is in."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def browser():
    """A running browser without a window; the test is skipped where there is none."""
    pipes = _module(Path(__file__).parent / "browser.py")
    if not pipes.found():
        pytest.skip(pipes.MISSING)
    with pipes.Browser() as running:
        yield running


@pytest.fixture(scope="session")
def independent():
    """Return the module that writes the equations a second time, with nothing of the package."""
    return _module(Path(__file__).parent / "vehicle" / "independent.py")


@pytest.fixture(scope="session")
def car_body():
    """The car body of the reference vehicles in SI units."""
    return dict(CAR_BODY)


@pytest.fixture
def narrow_bogie():
    """A bogie in SI units, unstable from 219.72 to 221.12 km/h: two changes that undo each other within 1.4 km/h."""
    return dict(NARROW)


@pytest.fixture
def table1():
    """Table I in SI units at 300 km/h, as floats."""
    return {**TABLE_1, "v": 300 / 3.6}


@pytest.fixture(scope="session")
def of_case():
    """Return the parameters and the model of a reference bogie."""

    def arguments(case, *, exact=False):
        speed = Fraction(str(case["speed_kmh"])) / Fraction(18, 5)
        p = {**case["bogie"], "v": speed if exact else float(speed)}
        return p, {"kind": case["kind"], "equations": case["equations"]}

    return arguments


@pytest.fixture(scope="session")
def vehicle_of_case(of_case):
    """Return the vehicle of a reference bogie, with its yaw damping."""

    def vehicle(case, *, exact=False):
        p, model = of_case(case, exact=exact)
        return Model(**model).at(p, C_s=case["C_s"])

    return vehicle


@pytest.fixture(scope="session")
def vehicle_named(vehicle_of_case):
    """Return the vehicle of the reference bogie with a name, as exactly as it is written."""

    def find(name):
        return vehicle_of_case(next(c for c in CASES if c["name"] == name), exact=True)

    return find


@pytest.fixture(scope="session")
def reference_vehicle():
    """Return the vehicle with a car body of a reference, or the first of a kind, with other numbers; inf is rigid."""

    def vehicle(reference, **changes):
        if isinstance(reference, str):
            reference = next(c for c in VEHICLES if c["kind"] == reference)
        p = {**reference["bogie"], **reference["car_body"], "v": reference["speed_kmh"] / 3.6, **changes}
        p = {name: x for name, x in p.items() if x != np.inf}
        return Model(reference["kind"], "reciprocal", (*p, "C_s")).at(p)

    return vehicle


@pytest.fixture(scope="session")
def random_bogies():
    """Return n bogies around Table I: each parameter times or divided by up to `spread`, 150 to 450 km/h."""

    def draw(n, *, spread=3.0, seed=1):
        rng = np.random.default_rng(seed)
        for _ in range(n):
            p = {name: value * spread ** rng.uniform(-1, 1) for name, value in TABLE_1.items()}
            kind, equations = MODELS[rng.integers(len(MODELS))]
            yield {**p, "v": rng.uniform(150, 450) / 3.6}, {"kind": kind, "equations": equations}

    return draw


@pytest.fixture(scope="session")
def random_vehicles(random_bogies):
    """Return n vehicles around Table I, without yaw damping: each parameter times or divided by up to `spread`."""

    def draw(n, *, spread=3.0, seed=1):
        for p, model in random_bogies(n, spread=spread, seed=seed):
            yield Model(**model).at(p)

    return draw


@pytest.fixture(scope="session")
def rational_vehicle(rational):
    """Return a vehicle in exact rationals: each double's own value."""

    def convert(vehicle):
        return vehicle.model.at(rational(vehicle.p))

    return convert


@pytest.fixture(scope="session")
def rational():
    """Return parameters as exact rationals: each double's own value."""

    def convert(p):
        return {name: flint.fmpq(*value.as_integer_ratio()) for name, value in p.items()}

    return convert


@pytest.fixture(scope="session")
def exact_roots():
    """Return the roots of a polynomial with rational coefficients, lowest power first, right to the last digit."""

    def roots(p):
        found = flint.fmpq_poly(list(p)).complex_roots()
        return np.array([complex(s.mid()) for s, times in found for _ in range(times)])

    return roots
