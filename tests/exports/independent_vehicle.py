"""The state matrix of a bogie and of a car body on two, written down by hand; nothing of the package's vehicle is used.

For every element its relative displacement as a row over the coordinates, as the table of the equations has it. The
states are coordinates, velocities, and the strokes of the dampers behind a joint.
"""

import numpy as np

MOTOR = "M_m"


class Equations:
    """Masses, springs, dashpots and Maxwell dampers over named coordinates."""

    def __init__(self, masses):
        self.names = list(masses)
        self.M = np.diag([float(m) for m in masses.values()])
        self.K, self.C = np.zeros_like(self.M), np.zeros_like(self.M)
        self.B = {}
        self.maxwell = []

    def row(self, **u):
        out = np.zeros(len(self.names))
        for name, x in u.items():
            if name in self.names:
                out[self.names.index(name)] += x
        return out

    def spring(self, k, c=0.0, **u):
        g = self.row(**u)
        self.K += k * np.outer(g, g)
        self.C += c * np.outer(g, g)

    def damper(self, K, c, **u):
        if np.isinf(K):
            self.spring(0.0, c, **u)
        else:
            self.maxwell.append((K, c, self.row(**u)))

    def state_matrix(self):
        n, z = len(self.names), len(self.maxwell)
        K, A = self.K.copy(), np.zeros((2 * n + z, 2 * n + z))
        inverse = np.linalg.inv(self.M)
        for k, (stiffness, c, g) in enumerate(self.maxwell):
            K += stiffness * np.outer(g, g)
            A[n : 2 * n, 2 * n + k] = inverse @ g * stiffness
            A[2 * n + k, :n] = stiffness / c * g
            A[2 * n + k, 2 * n + k] = -stiffness / c
        A[:n, n : 2 * n] = np.eye(n)
        A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -inverse @ K, -inverse @ self.C
        return A


def equations(p, *, gravity=True, overturning=False):
    """Return the equations of a vehicle with the numbers p; ``M_c`` among them says that there is a car body."""
    body = "M_c" in p
    ends = (("1", 1), ("2", -1)) if body else (("", 0),)
    masses = {"y_c": p["M_c"], "psi_c": p["J_c"], "th_c": p["I_c"]} if body else {}
    for b, _ in ends:
        masses |= {f"y_b{b}": p["M_b"], f"phi_b{b}": p["J_b"]} | ({f"th_b{b}": p["I_b"]} if "I_b" in p else {})
        for w in "12":
            masses |= {f"y_w{b}{w}": p["M_w"], f"phi_w{b}{w}": p["J_w"]}
        for m in "12" if MOTOR in p else "":
            masses |= {f"y_m{b}{m}": p["M_m"], f"phi_m{b}{m}": p["J_m"]}
    out = Equations(masses)
    for b, e in ends:
        _bogie(out, p, b, e * p.get("l_c", 0.0), gravity=gravity)
    if overturning:
        out.K[out.names.index("th_c"), out.names.index("th_c")] -= p["M_c"] * 9.80665 * p["h_s"]
    return out


def _bogie(out, p, b, x, *, gravity):
    y, phi, th = f"y_b{b}", f"phi_b{b}", f"th_b{b}"
    h_s, h_t, inf = p.get("h_s", 0.0), p.get("h_t", 0.0), np.inf
    out.spring(p["K_2y"], **{y: 1, th: -p.get("h_2", 0)}, y_c=-1, psi_c=-x, th_c=-h_s)
    out.spring(p["K_2x"] * p["b_2"] ** 2, **{phi: 1}, psi_c=-1)
    out.damper(p.get("K_ds", inf), p["C_s"], **{phi: p["b_3"]}, psi_c=-p["b_3"])
    for s in (1, -1):
        at = s * p["b_0"]
        u = {y: 1, phi: at, th: -p.get("h_2t", 0), "y_c": -1, "psi_c": -(x + at), "th_c": -h_t}
        out.damper(p.get("K_dt", inf) / 2, p["C_t"] / 2, **u)
    if "K_2z" in p:
        out.spring(2 * p["K_2z"] * p["b_2"] ** 2, 2 * p["C_2z"] * p["b_2"] ** 2, **{th: 1}, th_c=-1)
    if "I_b" in p:
        out.spring(4 * p["K_1z"] * p["b_1"] ** 2, 4 * p["C_1z"] * p["b_1"] ** 2, **{th: 1})
    for w, s in (("1", 1), ("2", -1)):
        _wheelset(out, p, b, w, s, gravity=gravity)
    for m, s in (("1", 1), ("2", -1)) if MOTOR in p else ():
        u = {y: 1, phi: s * p["a_0"], f"y_m{b}{m}": -1}
        out.spring(p["K_m"], **u)
        out.damper(p.get("K_dm", inf) / 2, p["C_m"], **u)
        out.spring(p["K_mphi"], p["C_mphi"], **{phi: 1, f"phi_m{b}{m}": -1})


def _wheelset(out, p, b, w, s, *, gravity):
    y, phi = (out.names.index(f"{x}_w{b}{w}") for x in ("y", "phi"))
    lateral = {f"y_b{b}": 1, f"phi_b{b}": s * p["a"], f"th_b{b}": p.get("h_1", 0), f"y_w{b}{w}": -1}
    yaw = {f"phi_b{b}": p["b_1"], f"phi_w{b}{w}": -p["b_1"]}
    out.spring(p["K_1y"], **lateral)
    out.spring(p["K_1x"], **yaw)
    for axis, u in (("y", lateral), ("x", yaw)):
        if f"C_1{axis}" in p:
            out.damper(p.get(f"K_d1{axis}", np.inf), p[f"C_1{axis}"], **u)
    W, lam, half, v = p["W"], p["lambda"], p["b"], p["v"]
    steering = 2 * p["f_22"] * half * lam / p["r"]
    out.K[y, y] += W * lam / half * gravity
    out.K[y, phi] -= 2 * p["f_11"]
    out.K[phi, y] += steering
    out.K[phi, phi] -= W * half * lam * gravity
    out.C[y, y] += 2 * p["f_11"] / v
    out.C[phi, phi] += 2 * p["f_22"] * half**2 / v
    spin = p.get("J_wy", 0.0) * v * lam / (p["r"] * half)
    out.C[y, phi] -= spin
    out.C[phi, y] += spin
    alignment, cross = np.zeros(len(out.names)), np.zeros(len(out.names))
    alignment[[y, phi]] = W * lam / half * gravity, steering
    cross[y] = W
    out.B[f"alignment_{b}{w}"] = np.linalg.solve(out.M, alignment)
    out.B[f"cross_level_{b}{w}"] = np.linalg.solve(out.M, cross)
