"""Units of exported functions: in other units of mass, length and time the same bogie gives the same answer."""

from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem.units import parse_unit

TRAILER = Path(__file__).parents[2] / "problems" / "trailer-bogie.yaml"
TASKS = {
    "as-printed": lambda: yd.table1(equations="as-printed"),
    "reciprocal": yd.table1,
    "trailer": lambda: yd.load(TRAILER).replace(C_s=9e5),
}
UNITS = {"mass": (2.0, 1.0, 1.0), "length": (1.0, 3.0, 1.0), "time": (1.0, 1.0, 2.0)}
# These count time in s/(100 rad/s), whatever the unit of time: their numbers have units of mass and length alone.
SCALED = {"characteristic_polynomial", "routh_column", "stability_margin", "margin_equations"}


@pytest.fixture(scope="module", params=TASKS)
def documented(request):
    return yd.functions(TASKS[request.param]()).documented


def recounted(units, change):
    """Return the factors by which numbers with these units change."""
    return np.exp(np.array([parse_unit(unit).dimension for unit in units]) @ np.log(change))


def entries(port):
    """Return the unit of each entry of an input or an output."""
    size = port.shape[0] * port.shape[1]
    assert len(port.units) in (0, size)
    return port.units or (port.unit,) * size


def outputs(f, change=(1.0, 1.0, 1.0)):
    given = [np.array(port.value) * recounted(entries(port), change) for port in f.inputs]
    return [np.array(x).ravel(order="F") for x in f.function.call(given)]


@pytest.mark.parametrize("quantity", UNITS)
def test_every_output_has_the_unit_that_it_says(documented, quantity):
    change = UNITS[quantity]
    for name, f in documented.items():
        if quantity == "time" and name in SCALED:
            continue
        for port, before, after in zip(f.outputs, outputs(f), outputs(f, change), strict=True):
            if "log10" not in port.name:  # logarithms of numbers in SI units
                expected = before * recounted(entries(port), change)
                assert after == pytest.approx(expected, rel=1e-6, abs=1e-12), (name, port.name)


def test_what_differs_in_its_unit_says_so(documented):
    for f in documented.values():
        assert all((port.unit == "SI") == bool(port.units) for port in (*f.inputs, *f.outputs))


def test_units_of_entries(documented):
    A = documented["state_matrix"].outputs[0]
    n = len(A.rows)
    by_place = {(A.rows[k % n], A.columns[k // n]): unit for k, unit in enumerate(A.units)}
    assert by_place["y_b_velocity", "phi_b_velocity"] == "m/s²/(rad/s)"
    assert by_place["y_b", "y_b_velocity"] == "-"
    assert by_place["phi_b_velocity", "y_b"] == "rad/s²/m"
    gradient = documented["critical_damping"].outputs[3]
    assert dict(zip(gradient.rows, gradient.units, strict=True))["M_b"] == "N·s/m/kg"
    assert dict(zip(gradient.rows, gradient.units, strict=True))["lambda"] == "N·s/m"
