"""The vehicle a second time, written from its equations and with nothing of the package: for comparison in tests.

x points forward, y to the left, z up; yaw turns x to y, roll turns y to z. A point at x, h above the centre of mass,
of a body moves sideways by ``y + x yaw - h roll``. Every spring and every damper acts between two such points, in
the coordinates of each body. The state of a damper in series with a spring is its force F: ``F' = K u' - K/c F``.
Numbers may be of any type.
"""

from dataclasses import dataclass, field

import numpy as np

GRAVITY = (980665, 100000)  # m/s^2
BOGIES = {"leading": 1, "trailing": -1}


@dataclass
class Equations:
    """``M q'' + C q' + K q + sum of u F = 0`` with a force F for each (K, c, u) in `maxwell`."""

    names: list
    M: list = field(default_factory=list)
    C: list = field(default_factory=list)
    K: list = field(default_factory=list)
    maxwell: list = field(default_factory=list)

    def __post_init__(self):
        n = len(self.names)
        self.M = [0] * n
        self.C, self.K = ([[0] * n for _ in range(n)] for _ in range(2))

    def mass(self, name, m):
        self.M[self.names.index(name)] = m

    def add(self, matrix, row, column, x):
        i, j = self.names.index(row), self.names.index(column)
        matrix[i][j] = matrix[i][j] + x

    def between(self, matrix, constant, u):
        """Add a spring (in K) or a damper (in C) whose length changes by the sum of u[name] * name."""
        for row, left in u.items():
            for column, right in u.items():
                self.add(matrix, row, column, constant * left * right)

    def damper(self, c, stiffness, u):
        """Add a damper, in series with a spring unless its mounting is rigid (None)."""
        if not isinstance(c, np.ndarray) and c == 0:
            return
        if stiffness is None:
            self.between(self.C, c, u)
        else:
            self.maxwell.append((stiffness, c, u))

    def state_matrix(self):
        """Return A of x' = A x with x = (q, q', F), as a list of rows."""
        n, size = len(self.names), 2 * len(self.names) + len(self.maxwell)
        A = [[0] * size for _ in range(size)]
        for i in range(n):
            A[i][n + i] = 1
            for j in range(n):
                A[n + i][j] = -self.K[i][j] / self.M[i]
                A[n + i][n + j] = -self.C[i][j] / self.M[i]
        for k, (stiffness, c, u) in enumerate(self.maxwell, start=2 * n):
            A[k][k] = -stiffness / c
            for name, g in u.items():
                i = self.names.index(name)
                A[n + i][k] = -g / self.M[i]
                A[k][n + i] = stiffness * g
        return A

    def dynamic_stiffness(self, s):
        """Return the matrix of the equations of motion at a number s, as a list of rows."""
        n = range(len(self.names))
        D = [[self.K[i][j] + s * self.C[i][j] + (s * s * self.M[i] if i == j else 0) for j in n] for i in n]
        for stiffness, c, u in self.maxwell:
            for row, left in u.items():
                for column, right in u.items():
                    i, j = self.names.index(row), self.names.index(column)
                    D[i][j] = D[i][j] + stiffness * c * s / (stiffness + c * s) * left * right
        return D


def equations(kind, p, flags=()):
    """Return the equations of a bogie under a car body that stands still or, with ``M_c``, of a whole vehicle."""
    if "M_c" not in p:
        names = coordinates(kind, "I_b" in p, "")
        found = Equations(names)
        bogie(found, kind, p, flags, "", None)
        return found
    ends = {"leading": "1", "trailing": "2"}
    found = Equations(["y_c", "psi_c", "th_c", *(x for e in ends.values() for x in coordinates(kind, "I_b" in p, e))])
    for name, m in (("y_c", "M_c"), ("psi_c", "J_c"), ("th_c", "I_c")):
        found.mass(name, p[m])
    if "overturning" in flags:
        found.add(found.K, "th_c", "th_c", -p["M_c"] * GRAVITY[0] / GRAVITY[1] * p["h_s"])
    for which, end in ends.items():
        own = {name.removeprefix(f"{which}."): x for name, x in p.items() if name.startswith(f"{which}.")}
        bogie(found, kind, {**p, **own}, flags, end, BOGIES[which])
    return found


def eigenvalues(kind, p):
    """Return the eigenvalues of vehicles, shape (n, states); numbers may be arrays of shape (n,)."""
    rows = equations(kind, p).state_matrix()
    entries = np.broadcast_arrays(*[np.asarray(x, dtype=float) for row in rows for x in row], np.zeros(1))[:-1]
    return np.linalg.eigvals(np.stack(entries, axis=-1).reshape(-1, len(rows), len(rows)))


def coordinates(kind, rolls, end):
    bodies = [*("w" + end + k for k in "12"), *("m" + end + k for k in "12" if kind == "power")]
    frame = [f"y_b{end}", f"phi_b{end}", *([f"th_b{end}"] if rolls else [])]
    return [*frame, *(f"{q}_{x}" for x in bodies for q in ("y", "phi"))]


def bogie(found, kind, p, flags, end, side):
    """Add one bogie at x = side l_c of the car body, or under one that stands still (side None)."""
    rolls = "I_b" in p
    y_b, phi_b, th_b = (f"{q}_b{end}" for q in ("y", "phi", "th"))

    def frame(x, above=None):
        """Return how a point of the frame moves sideways: x in front of its centre of mass and so much above."""
        roll = {th_b: -above} if rolls and above is not None else {}
        return {y_b: 1, phi_b: x, **roll}

    def car_body(x, below):
        """Return how a point of the car body moves sideways: x in front of the bogie's centre."""
        return {} if side is None else {"y_c": 1, "psi_c": side * p["l_c"] + x, "th_c": below}

    found.mass(y_b, p["M_b"])
    found.mass(phi_b, p["J_b"])
    below_s, below_t = p.get("h_s"), p.get("h_t")
    found.between(found.K, p["K_2y"], apart(frame(0, p.get("h_2")), car_body(0, below_s)))
    yaw = {phi_b: 1, **({} if side is None else {"psi_c": -1})}
    found.between(found.K, p["K_2x"] * p["b_2"] * p["b_2"], yaw)
    c_yaw = p.get("C_s", 0) * p.get("C_s share", 1)
    found.damper(c_yaw, p.get("K_ds"), {name: g * p["b_3"] for name, g in yaw.items()})
    for x in (p["b_0"], -p["b_0"]):
        joint = p["K_dt"] / 2 if "K_dt" in p else None
        found.damper(p["C_t"] / 2, joint, apart(frame(x, p.get("h_2t")), car_body(x, below_t)))
    roll = {**({th_b: 1} if rolls else {}), **({} if side is None else {"th_c": -1})}
    if roll:  # on a vertical spring at both sides, b_2 from the middle
        for y in (p["b_2"], -p["b_2"]):
            found.between(found.K, p["K_2z"], {name: g * y for name, g in roll.items()})
            found.between(found.C, p["C_2z"], {name: g * y for name, g in roll.items()})
    if rolls:
        found.mass(th_b, p["I_b"])
        for y in (p["b_1"], -p["b_1"], p["b_1"], -p["b_1"]):  # four axle boxes
            found.between(found.K, p["K_1z"], {th_b: y})
            found.between(found.C, p["C_1z"], {th_b: y})
    for k, sign in (("1", 1), ("2", -1)):
        wheelset(found, p, flags, f"y_w{end}{k}", f"phi_w{end}{k}", frame(sign * p["a"], minus(p.get("h_1"))), phi_b)
        if kind == "power":
            motor(found, p, f"y_m{end}{k}", f"phi_m{end}{k}", frame(sign * p["a_0"]), phi_b)


def wheelset(found, p, flags, y, phi, box, phi_b):
    found.mass(y, p["M_w"])
    found.mass(phi, p["J_w"])
    sideways, along = apart(box, {y: 1}), {phi_b: p["b_1"], phi: -p["b_1"]}
    for axis, u in (("y", sideways), ("x", along)):
        found.between(found.K, p[f"K_1{axis}"], u)
        found.damper(p.get(f"C_1{axis}", 0), p.get(f"K_d1{axis}"), u)
    v, b, r, conicity = (p[name] for name in ("v", "b", "r", "lambda"))
    # Creep: lateral velocity against the direction in which the wheelset points; each wheel's forward velocity against
    # that of its tread, whose radius has grown by conicity y on the left.
    found.add(found.C, y, y, 2 * p["f_11"] / v)
    found.add(found.K, y, phi, -2 * p["f_11"])
    found.add(found.C, phi, phi, 2 * p["f_22"] * b * b / v)
    found.add(found.K, phi, y, 2 * p["f_22"] * b * conicity / r)
    if "no gravitational stiffness" not in flags:
        found.add(found.K, y, y, p["W"] * conicity / b)
        found.add(found.K, phi, phi, -p["W"] * conicity * b)
    roll_rate, yaw_rate = gyroscopic_moments(p.get("J_wy", 0), v / r)
    # The wheelset rolls by conicity y / b: its left wheel climbs as it moves to the left.
    found.add(found.C, phi, y, roll_rate[2] * conicity / b)
    found.add(found.C, y, phi, yaw_rate[0] * conicity / b)


def gyroscopic_moments(inertia, spin):
    """Return the vectors that change the angular momentum, per roll velocity and per yaw velocity.

    Forward rolling is a rotation about +y: its cross product with the way down to the rail points backwards.
    The axle, and with it its angular momentum, is turned by a rotation: d/dt a = rotation x a.
    """
    assert cross((0, 1, 0), (0, 0, -1)) == (-1, 0, 0)
    momentum = (0, inertia * spin, 0)
    return cross((1, 0, 0), momentum), cross((0, 0, 1), momentum)


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def motor(found, p, y, phi, hanger, phi_b):
    found.mass(y, p["M_m"])
    found.mass(phi, p["J_m"])
    found.between(found.K, p["K_m"], apart(hanger, {y: 1}))
    found.damper(p["C_m"], p["K_dm"] / 2 if "K_dm" in p else None, apart(hanger, {y: 1}))
    found.between(found.K, p["K_mphi"], {phi_b: 1, phi: -1})
    found.between(found.C, p["C_mphi"], {phi_b: 1, phi: -1})


def apart(one, other):
    """Return how much further one point moves than another."""
    return {name: one.get(name, 0) - other.get(name, 0) for name in (*one, *(x for x in other if x not in one))}


def minus(x):
    return None if x is None else -x
