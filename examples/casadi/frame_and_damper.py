"""The exported critical damping inside an NLP of one's own: CasADi and the exported files, nothing of this package.

    yawdesign export problems/table1.yaml --to exported
    python examples/casadi/frame_and_damper.py exported

A frame of less yaw inertia J_b hunts less, but a light frame costs, and so does a strong motor damper C_m. Which pair
of them brings C_sl under a limit at the least cost?
"""

import json
import sys
from pathlib import Path

import casadi as ca

FOLDER = Path(sys.argv[1])
LIMIT = 30e3  # largest critical damping that the yaw damper may be asked for [N s/m]

described = json.loads((FOLDER / "manifest.json").read_text(encoding="utf-8"))["functions"]["critical_damping"]
critical_damping = ca.Function.load(str(FOLDER / described["files"]["casadi"]))
given = {name: value[0] for name, value in described["self_test"]["inputs"].items()}

# Variables in shares of given values. The start of Newton's method moves with the design: two more variables, and two
# constraints that they are the solution. So it always begins nearby, and stays on the same branch of critical values.
names = ["J_b", "C_m", "C_s_start", "omega_start"]
share = ca.MX.sym("share", len(names))
found = critical_damping(**{**given, **{name: share[k] * given[name] for k, name in enumerate(names)}})
C_sl, omega = found["C_sl"] / given["C_s_start"], found["omega"] / given["omega_start"]

cost = 1 / share[0] + 0.2 * share[1]
same = ca.vertcat(C_sl - share[2], omega - share[3])
nlp = {"x": share, "f": cost, "g": ca.vertcat(C_sl * given["C_s_start"] / LIMIT, same)}
solver = ca.nlpsol("frame_and_damper", "ipopt", nlp, {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False})
solution = solver(x0=1, lbx=[0.7, 0.5, 0.1, 0.5], ubx=[1.1, 2, 2, 2], lbg=[0, 0, 0], ubg=[1, 0, 0])

# IPOPT knows nothing of the residual, and Newton's method reports no failure: look at it before using the answer.
best = {name: float(x) * given[name] for name, x in zip(names, ca.vertsplit(solution["x"]), strict=True)}
answer = critical_damping(**{**given, **best})
if not solver.stats()["success"] or not float(answer["residual"]) < 1e-10:
    sys.exit(f"no solution: {solver.stats()['return_status']}, residual {float(answer['residual'])}")
print(f"J_b {best['J_b']:.10g} kg m^2, given {given['J_b']:g}")
print(f"C_m {best['C_m']:.10g} N s/m, given {given['C_m']:g}")
print(f"C_sl {float(answer['C_sl']):.10g} N s/m, limit {LIMIT:g}")
