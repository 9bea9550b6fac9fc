"""The exported critical damping inside an NLP of one's own: CasADi and the exported files, nothing of this package.

    yawdesign export problems/table1.yaml --to exported
    python examples/casadi/lighter_frame.py exported

A lighter frame hunts less, but costs; so does a stronger motor damper. Which yaw inertia J_b of the frame, which motor
damping C_m and which motor suspension K_m bring C_sl under a limit at the least cost?
"""

import json
import sys
from pathlib import Path

import casadi as ca

FOLDER = Path(sys.argv[1])
LIMIT = 60e3  # largest critical damping that the yaw damper may be asked for [N s/m]

described = json.loads((FOLDER / "manifest.json").read_text(encoding="utf-8"))["functions"]["critical_damping"]
critical_damping = ca.Function.load(str(FOLDER / described["files"]["casadi"]))
given = described["self_test"]["inputs"]

# The variables are J_b, C_m and K_m in shares of their given values.
share = ca.MX.sym("share", 3)
J_b, C_m, K_m = (share[k] * given[name][0] for k, name in enumerate(("J_b", "C_m", "K_m")))
found = critical_damping(**{**given, "J_b": J_b, "C_m": C_m, "K_m": K_m})

cost = (1 / share[0] - 1) + 0.2 * share[1] + 0.5 * (share[2] - 1) ** 2
nlp = {"x": share, "f": cost, "g": ca.vertcat(found["C_sl"] / LIMIT, found["residual"])}
solver = ca.nlpsol("lighter", "ipopt", nlp, {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False})
solution = solver(x0=[1, 1, 1], lbx=[0.7, 0.5, 0.7], ubx=[1.2, 2, 1.4], lbg=[0, 0], ubg=[1, 1e-10])

print(solver.stats()["return_status"])
for name, part in zip(("J_b", "C_m", "K_m"), solution["x"].full().ravel(), strict=True):
    print(f"{name} {part * given[name][0]:.10g}")
print(f"C_sl {float(solution['g'][0]) * LIMIT:.10g}")
print(f"residual {float(solution['g'][1]):.3g}")
