"""The stability boundary as CasADi graphs: values, derivatives, and failures that must be seen."""

import numpy as np
import pytest

from yawdesign.hunting.old import boundary as graphs
from yawdesign.hunting.old import critical_damping
from yawdesign.hunting.routh import routh_column
from yawdesign.vehicle.old import characteristic
from yawdesign.vehicle.polynomials import scale_variable

# d ln C_sl / d ln p of the model as printed at 300 km/h, to the digits that are known
SENSITIVITIES = {
    "a": -20.6, "v": 13.7, "f_11": -7.9, "b": 6.0, "f_22": 5.9, "r": -5.9, "lambda": 5.8, "J_b": 4.4, "K_m": -4.3,
    "C_m": 3.4, "M_m": -3.4, "M_w": 2.4, "J_w": 2.2, "C_t": -2.1, "b_3": -1.7, "b_2": -1.6, "M_b": 1.2, "K_2x": -0.8,
}  # fmt: skip


def solve(p, model, C_s, omega):
    names = graphs.parameter_names(p)
    values = graphs.critical_damping(names, **model)([p[name] for name in names], C_s, omega)
    return [np.array(value).squeeze() for value in values]


def near(p, model):
    first = critical_damping(p, **model).critical[0]
    return solve(p, model, first.C_s, first.omega)


def test_solution(table1, model):
    expected = critical_damping(table1, **model).critical[0]
    C_s, omega, residual, *_ = solve(table1, model, 1.05 * expected.C_s, 0.98 * expected.omega)
    assert C_s == pytest.approx(expected.C_s, rel=1e-10)
    assert omega == pytest.approx(expected.omega, rel=1e-10)
    assert residual < 1e-13


def test_sensitivities_of_table_1(table1):
    C_s, _, _, gradient, _ = near(table1, {"kind": "power", "equations": "as-printed"})
    relative = {name: g * table1[name] / C_s for name, g in zip(table1, gradient, strict=True)}
    for name, expected in SENSITIVITIES.items():
        assert relative[name] == pytest.approx(expected, rel=0.01, abs=0.051)
    others = [abs(x) for name, x in relative.items() if name not in SENSITIVITIES]
    assert max(others) < 0.85


def test_gradient_against_differences(table1, model):
    C_s, _, _, gradient, _ = near(table1, model)
    for k, name in enumerate(table1):
        step = 1e-5 * table1[name]
        up, down = (near({**table1, name: table1[name] + h}, model)[0] for h in (step, -step))
        assert gradient[k] * table1[name] / C_s == pytest.approx((up - down) / (2e-5 * C_s), rel=1e-5, abs=1e-6)


def test_hessian_against_differences_of_the_gradient(table1, model):
    C_s, _, _, _, hessian = near(table1, model)
    assert hessian == pytest.approx(hessian.T, rel=1e-6, abs=1e-9 * np.abs(hessian).max())
    sizes = np.array(list(table1.values()))
    for name in ("v", "lambda", "K_1x", "C_t"):
        k, step = list(table1).index(name), 1e-5 * table1[name]
        up, down = (near({**table1, name: table1[name] + h}, model)[3] for h in (step, -step))
        expected = (up - down) / (2 * step) * sizes * sizes[k] / C_s
        assert hessian[k] * sizes * sizes[k] / C_s == pytest.approx(expected, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize(("C_s", "omega"), [(np.nan, 23.0), (1e300, 1e-300), (1e-5, 1e6)])
def test_a_rootfinder_that_goes_astray_shows_in_the_residual(table1, C_s, omega):
    found, frequency, residual, *_ = solve(table1, {"kind": "power", "equations": "reciprocal"}, C_s, omega)
    assert not residual < 1e-10 or abs(found / 63607.4140611465 - 1) > 1e-3 or abs(frequency - 22.73440508) > 1e-3


def test_a_bogie_without_critical_value_shows_in_the_residual(table1):
    slow = {**table1, "v": 250 / 3.6}
    _, _, residual, *_ = solve(slow, {"kind": "power", "equations": "as-printed"}, 9e4, 23.0)
    assert not residual < 1e-10


def test_polish_keeps_a_guess_that_is_led_astray(table1):
    guess = (1e-5, 1e6)
    assert graphs.polish(table1, [guess]) == [guess]
    (polished,) = graphs.polish(table1, [(63607.4142, 22.73440505)])
    assert polished == pytest.approx((63607.4140611465, 22.73440507931), rel=1e-10)


def test_routh_column_equals_numbers(table1, model):
    column = graphs.routh_column(tuple(table1), **model)(list(table1.values()), 1e6)
    expected = routh_column(scale_variable(characteristic(table1, **model).core(1e6), 100.0))
    assert np.array(column).ravel() == pytest.approx(expected, rel=1e-9)


def test_boundary_is_scaled_to_order_one(random_bogies):
    for p, model in random_bogies(20, seed=8):
        names = graphs.parameter_names(p)
        g = np.array(graphs.boundary(names, **model)([np.log(1e5), 0.2], [p[name] for name in names]))
        assert np.all(np.abs(g) <= 1)


def test_parameter_names_leave_the_unknown_out(table1):
    assert graphs.parameter_names({**table1, "C_s": 1e6}) == tuple(table1)
