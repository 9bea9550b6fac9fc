"""The stability boundary as CasADi graphs: values, derivatives, and failures that must be seen."""

import numpy as np
import pytest

from yawdesign.hunting import boundary as graphs
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.routh import routh_column
from yawdesign.vehicle.polynomials import scale_variable
from yawdesign.vehicle.vehicle import Model

PRINTED, RECIPROCAL = Model(equations="as-printed"), Model()

# d ln C_sl / d ln p of the model as printed at 300 km/h, to the digits that are known
SENSITIVITIES = {
    "a": -20.6, "v": 13.7, "f_11": -7.9, "b": 6.0, "f_22": 5.9, "r": -5.9, "lambda": 5.8, "J_b": 4.4, "K_m": -4.3,
    "C_m": 3.4, "M_m": -3.4, "M_w": 2.4, "J_w": 2.2, "C_t": -2.1, "b_3": -1.7, "b_2": -1.6, "M_b": 1.2, "K_2x": -0.8,
}  # fmt: skip


def solve(vehicle, C_s, omega):
    names = graphs.parameter_names(vehicle.p)
    values = graphs.critical_damping(vehicle.model, names)([vehicle.p[name] for name in names], C_s, omega)
    return [np.array(value).squeeze() for value in values]


def near(vehicle):
    first = critical_damping(vehicle).critical[0]
    return solve(vehicle, first.C_s, first.omega)


def test_solution(table1, vehicle_model):
    vehicle = vehicle_model.at(table1)
    expected = critical_damping(vehicle).critical[0]
    C_s, omega, residual, *_ = solve(vehicle, 1.05 * expected.C_s, 0.98 * expected.omega)
    assert C_s == pytest.approx(expected.C_s, rel=1e-10)
    assert omega == pytest.approx(expected.omega, rel=1e-10)
    assert residual < 1e-13


def test_sensitivities_of_table_1(table1):
    C_s, _, _, gradient, _ = near(PRINTED.at(table1))
    relative = {name: g * table1[name] / C_s for name, g in zip(table1, gradient, strict=True)}
    for name, expected in SENSITIVITIES.items():
        assert relative[name] == pytest.approx(expected, rel=0.01, abs=0.051)
    others = [abs(x) for name, x in relative.items() if name not in SENSITIVITIES]
    assert max(others) < 0.85


def test_gradient_against_differences(table1, vehicle_model):
    C_s, _, _, gradient, _ = near(vehicle_model.at(table1))
    for k, name in enumerate(table1):
        step = 1e-5 * table1[name]
        up, down = (near(vehicle_model.at({**table1, name: table1[name] + h}))[0] for h in (step, -step))
        assert gradient[k] * table1[name] / C_s == pytest.approx((up - down) / (2e-5 * C_s), rel=1e-5, abs=1e-6)


def test_hessian_against_differences_of_the_gradient(table1, vehicle_model):
    C_s, _, _, _, hessian = near(vehicle_model.at(table1))
    assert hessian == pytest.approx(hessian.T, rel=1e-6, abs=1e-9 * np.abs(hessian).max())
    sizes = np.array(list(table1.values()))
    for name in ("v", "lambda", "K_1x", "C_t"):
        k, step = list(table1).index(name), 1e-5 * table1[name]
        up, down = (near(vehicle_model.at({**table1, name: table1[name] + h}))[3] for h in (step, -step))
        expected = (up - down) / (2 * step) * sizes * sizes[k] / C_s
        assert hessian[k] * sizes * sizes[k] / C_s == pytest.approx(expected, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize(("C_s", "omega"), [(np.nan, 23.0), (1e300, 1e-300), (1e-5, 1e6)])
def test_a_rootfinder_that_goes_astray_shows_in_the_residual(table1, C_s, omega):
    found, frequency, residual, *_ = solve(RECIPROCAL.at(table1), C_s, omega)
    assert not residual < 1e-10 or abs(found / 63607.4140611465 - 1) > 1e-3 or abs(frequency - 22.73440508) > 1e-3


def test_a_bogie_without_critical_value_shows_in_the_residual(table1):
    _, _, residual, *_ = solve(PRINTED.at(table1, v=250 / 3.6), 9e4, 23.0)
    assert not residual < 1e-10


def test_polish_keeps_a_guess_that_is_led_astray(table1):
    vehicle, guess = RECIPROCAL.at(table1), (1e-5, 1e6)
    assert graphs.polish(vehicle, [guess]) == [guess]
    (polished,) = graphs.polish(vehicle, [(63607.4142, 22.73440505)])
    assert polished == pytest.approx((63607.4140611465, 22.73440507931), rel=1e-10)


def test_routh_column_equals_numbers(table1, vehicle_model):
    column = graphs.routh_column(vehicle_model, tuple(table1))(list(table1.values()), 1e6)
    expected = routh_column(scale_variable(vehicle_model.at(table1).coupled.polynomial(1e6), 100.0))
    assert np.array(column).ravel() == pytest.approx(expected, rel=1e-9)


def test_boundary_is_scaled_to_order_one(random_vehicles):
    for vehicle in random_vehicles(20, seed=8):
        names = graphs.parameter_names(vehicle.p)
        g = np.array(graphs.boundary(vehicle.model, names)([np.log(1e5), 0.2], [vehicle.p[name] for name in names]))
        assert np.all(np.abs(g) <= 1)


def test_parameter_names_leave_the_unknown_out(table1):
    assert graphs.parameter_names({**table1, "C_s": 1e6}) == tuple(table1)
