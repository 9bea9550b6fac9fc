"""The published vehicles under `problems/`, against state matrices put together spring by spring from their sources.

A source says what one spring is and where it stands; a problem file says what a wheelset, a pair or a bogie has. The
two share no line: here every spring and damper stands by itself between two points.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import yawdesign as yd
from yawdesign.problem.reader import read_text

PROBLEMS = Path(__file__).parents[2] / "problems"
PUBLISHED = ("cooperrider-bogie", "cooperrider-vehicle", "high-speed-vehicle")
SIDES = (1, -1)
GROUND = -1  # body that does not move


def published(name, v=None):
    """Return a shipped problem, at a speed [m/s] or at its own."""
    problem = yd.load(PROBLEMS / f"{name}.yaml")
    return problem if v is None else problem.replace(speed=f"{v:.17g} m/s")


class Bodies:
    """Rigid bodies with lateral displacement, roll and yaw; springs and dampers between points of them."""

    def __init__(self, *bodies):
        m = np.array(bodies, float).ravel()
        self.free = m > 0  # without inertia it does not move
        self.M, self.C, self.K = np.diag(m), *np.zeros((2, m.size, m.size))
        self.series = []

    def gap(self, axis, upper, lower):
        """Return what the coordinates make of the distance of two points (x, y, z) in bodies along an axis."""
        g = np.zeros(len(self.M))
        for sign, (body, (x, y, z)) in ((1, upper), (-1, lower)):
            if body != GROUND:
                row = {"x": (0, 0, -y), "y": (1, -z, x), "z": (0, y, 0)}[axis]
                g[3 * body : 3 * body + 3] += np.multiply(sign, row)
        return g

    def join(self, axis, upper, lower, k=0.0, c=0.0):
        g = self.gap(axis, upper, lower)
        self.K += k * np.outer(g, g)
        self.C += c * np.outer(g, g)

    def join_in_series(self, axis, upper, lower, k, c):
        self.series.append((self.gap(axis, upper, lower), k, c))

    def contact(self, body, v, *, W, b, r, conicity, lateral, longitudinal, spin=0.0):
        """Add creep of two wheels, the force and moment of the axle load and the gyroscopic moment."""
        y, psi = 3 * body, 3 * body + 2
        self.C[y, y] += 2 * lateral / v
        self.C[psi, psi] += 2 * longitudinal * b**2 / v
        self.K[y, psi] -= 2 * lateral
        self.K[psi, y] += 2 * longitudinal * b * conicity / r
        self.K[y, y] += W * conicity / b
        self.K[psi, psi] -= W * conicity * b
        # Displaced to the left it rolls, left wheel up, by conicity / b of that. The angular momentum J v / r along its
        # axle follows roll and yaw and changes by -J v / r psi' about the track, by J v / r roll' about the vertical.
        gyroscopic = spin * v / r * conicity / b
        self.C[y, psi] -= gyroscopic
        self.C[psi, y] += gyroscopic

    def roots(self):
        keep = np.ix_(self.free, self.free)
        M, C, K = self.M[keep], self.C[keep], self.K[keep]
        n, s = len(M), len(self.series)
        A = np.zeros((2 * n + s, 2 * n + s))
        A[:n, n : 2 * n] = np.eye(n)
        A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
        for i, (g, k, c) in enumerate(self.series):  # force F in series: F' = k u' - k F / c
            A[n : 2 * n, 2 * n + i] = -np.linalg.solve(M, g[self.free])
            A[2 * n + i, n : 2 * n] = k * g[self.free]
            A[2 * n + i, 2 * n + i] = -k / c
        return np.linalg.eigvals(A)


def cooperrider_bogie(v):
    """Return its bodies: frame 0, wheelsets 1 and 2. Numbers as its table has them."""
    k1, k2, k3, k4, k5, k6, D1, D2, D6 = 1.823e6, 3.646e6, 3.646e6, 182.3e3, 333.3e3, 2.710e6, 20e3, 29.2e3, 500.0
    a, b, d1, d2, h1, h2, G = 0.716, 1.074, 0.620, 0.680, 0.0762, 0.6584, 6.563e6
    it = Bodies((2918, 6780, 6780), *2 * [(1022, 0, 678)])
    for wheelset, x in ((1, b), (2, -b)):
        primary_springs(it, 0, wheelset, x, height=-h1, arm=d1, lateral=k1, longitudinal=k2, vertical=k3)
        it.contact(wheelset, v, W=0, b=a, r=0.4572, conicity=0.05, lateral=G / 0.54219, longitudinal=G / 0.60252)
    for side in SIDES:
        it.join("y", (0, (0, 0, h2)), (GROUND, (0, 0, 0)), k4, D2)
        it.join("z", (0, (0, side * d2, 0)), (GROUND, (0, 0, 0)), k5, D1)
    it.K[2, 2] += k6
    it.C[2, 2] += D6
    return it


def primary_springs(it, frame, wheelset, x, *, height, arm, lateral, longitudinal, vertical, damping=(0, 0)):
    """Add the springs of both axle boxes, and their lateral and vertical damping."""
    for side in SIDES:
        it.join("y", (frame, (x, side * arm, height)), (wheelset, (0, side * arm, 0)), lateral, damping[0])
        it.join("x", (frame, (x, side * arm, height)), (wheelset, (0, side * arm, 0)), longitudinal)
        it.join("z", (frame, (x, side * arm, height)), (wheelset, (0, 0, 0)), vertical, damping[1])


def cooperrider_vehicle(v):
    """Return its bodies: car body 0, frames 1 and 4, each followed by its wheelsets."""
    k1, k2, k3, k4, k5, k6, D1, D2, D6 = 1.823e6, 3.646e6, 3.646e6, 182.3e3, 333.3e3, 903350, 20e3, 29.2e3, 166669
    u1, u2, h1, h2, s1, s2, s3, outside = 7.5, 1.074, 0.0762, 1.5584, 0.62, 0.6584, 0.68, 0.75 + 0.3 + 0.3 + 0.3 / 2
    semi_axes = 5.95185e-3 * 6.65256e-3 * 210e9 / (2 * 1.27)
    bogie = [(2918.9, 6780, 6780), *2 * [(1022, 0, 678)]]
    it = Bodies((44388, 2.80e5, 5.0e5), *bogie, *bogie)
    for frame, X in ((1, u1), (4, -u1)):
        for wheelset, x in ((frame + 1, u2), (frame + 2, -u2)):
            primary_springs(it, frame, wheelset, x, height=-h1, arm=s1, lateral=k1, longitudinal=k2, vertical=k3)
            creep = {"lateral": semi_axes * 3.5631048463, "longitudinal": semi_axes * 4.1245652728}
            it.contact(wheelset, v, W=2 * 66661.236634, b=0.756300642, r=0.4248829, conicity=0.0294, spin=80, **creep)
        for side in SIDES:
            it.join("y", (frame, (0, side, s2)), (0, (X, side, -(h2 - s2))), k4, D2)
            it.join("z", (frame, (0, side * s3, 0)), (0, (X, side * s3, 0)), k5, D1)
            it.join("x", (frame, (0, side * outside, 0)), (0, (X, side * outside, -h2)), k6, D6)
    return it


def high_speed_vehicle(v):
    """Return its bodies in the same order, with the assumptions of the file for what its table lacks."""
    bogie = [(3000, 2106, 2600), *2 * [(2400, 0, 1029)]]
    it = Bodies((28000, 84560, 1102730), *bogie, *bogie)
    springs = {"lateral": 15e6, "longitudinal": 85e6, "vertical": 1.1e6, "damping": (10e3, 20e3)}
    rail = {"W": 106.9e3, "b": 0.7465, "r": 0.43, "conicity": 0.15, "lateral": 8232.38e3, "longitudinal": 9180.66e3}
    for frame, X in ((1, 8.75), (4, -8.75)):
        for wheelset, x in ((frame + 1, 1.25), (frame + 2, -1.25)):
            primary_springs(it, frame, wheelset, x, height=-0.148, arm=1.0, **springs)
            it.contact(wheelset, v, **rail)
        for side in SIDES:
            it.join("y", (frame, (0, 0, 0.162)), (0, (X, 0, -0.852)), k=0.2e6)
            it.join("x", (frame, (0, side * 1.23, 0)), (0, (X, side * 1.23, 0)), k=0.2e6)
            it.join("z", (frame, (0, side * 1.23, 0)), (0, (X, side * 1.23, 0)), k=0.2e6)
            it.join("z", (frame, (0, side * 1.323, 0)), (0, (X, side * 1.323, 0)), c=10e3)
            it.join("y", (frame, (side * 0.2, 0, 0.044)), (0, (X + side * 0.2, 0, -0.97)), c=30e3)
            it.join_in_series("x", (frame, (0, side * 1.35, 0)), (0, (X, side * 1.35, 0)), 10e6, 300e3)
    return it


SOURCES = dict(zip(PUBLISHED, (cooperrider_bogie, cooperrider_vehicle, high_speed_vehicle), strict=True))


def distance(found, expected):
    """Return how far the roots are from the nearest expected ones and the other way round, beside their size."""
    apart = np.abs(np.subtract.outer(found, expected)) / (1 + np.abs(expected))
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@pytest.mark.parametrize("name", PUBLISHED)
@pytest.mark.parametrize("v", [20.0, 60.0, 90.0])
def test_the_file_is_what_its_source_says(name, v):
    result = yd.stability(published(name, v))
    assert result.checked
    found = np.concatenate([result.eigenvalues, *result.fixed_modes.values()])
    expected = SOURCES[name](v).roots()
    # The files round; near a double root, two wheelsets that creep alike, that is seen most.
    assert distance(found, expected) < 5e-5
    assert result.spectral_abscissa == pytest.approx(expected.real.max(), abs=5e-5)


@pytest.mark.parametrize(
    ("name", "between", "v", "omega"),
    [
        ("cooperrider-bogie", (60, 75), 68.6664, 25.123),
        ("cooperrider-vehicle", (125, 140), 132.945, 30.931),
        ("high-speed-vehicle", (55, 70), 61.351, 15.571),
    ],
)
def test_critical_speed(name, between, v, omega):
    """By two ways; that of Cooperrider's bogie is known, the other sources have none for their linear part."""

    def least_damped(v):
        return max(yd.stability(published(name, v)).eigenvalues, key=lambda s: s.real)

    found = brentq(lambda v: least_damped(v).real, *between, xtol=1e-9)
    assert (found, abs(least_damped(found).imag)) == pytest.approx((v, omega), abs=5e-4)
    assert brentq(lambda v: SOURCES[name](v).roots().real.max(), *between) == pytest.approx(v, abs=5e-4)


@pytest.mark.parametrize(
    ("name", "slip", "kmh"),
    [
        ("cooperrider-bogie", {"K_2x": "2.71 MN/m"}, 227.4),  # N m/rad taken for N/m
        ("high-speed-vehicle", {"K_1x": "85 MN/m", "K_1y": "15 MN/m"}, 359.1),  # an axle box taken for a wheelset
        ("high-speed-vehicle", {"K_ds": "10 MN/m"}, 305.9),  # a whole damper taken for its joint
        ("high-speed-vehicle", {"f_11": "9180.66 kN", "f_22": "8232.38 kN"}, 257.2),  # lateral and longitudinal swapped
    ],
)
def test_what_a_slip_costs(name, slip, kmh):
    """The numbers of docs/from-a-table.md."""

    def abscissa(kmh):
        return yd.stability(published(name).replace(speed=f"{kmh} km/h", **slip)).spectral_abscissa

    assert abscissa(kmh - 0.5) < 0 < abscissa(kmh + 0.5)


@pytest.mark.parametrize("name", PUBLISHED)
def test_what_is_unusual_is_known(name):
    problem, diagnostics = read_text((PROBLEMS / f"{name}.yaml").read_text("utf-8"), name)
    assert problem is not None
    known = {"cooperrider-bogie": ["bogie.C_s", "design.variables.C_s.min"]}  # a yaw damper that does hardly anything
    assert [d.key for d in diagnostics] == known.get(name, [])


@pytest.mark.parametrize("name", PUBLISHED)
def test_it_is_stable_at_its_speed(name):
    result = yd.stability(published(name))
    assert result.stable
    assert result.checked


@pytest.mark.parametrize(
    ("name", "status"),
    [
        ("cooperrider-bogie", "no upper limit"),
        pytest.param("cooperrider-vehicle", "no upper limit", marks=pytest.mark.slow),
        pytest.param("high-speed-vehicle", "ok", marks=pytest.mark.slow),
    ],
)
def test_it_has_a_design(name, status):
    result = yd.design(published(name))
    assert result.checked
    assert result.status == status
