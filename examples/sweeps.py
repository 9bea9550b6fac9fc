"""Draws Figure 3 of the paper and a stability chart into docs/figures, and writes the data beside them if asked.

python examples/sweeps.py [FOLDER FOR CSV FILES]
"""

import sys
from dataclasses import replace
from pathlib import Path

import yawdesign as yd
from yawdesign.problem.parameters import CarBody

FOLDER = Path(__file__).parents[1] / "docs" / "figures"
# A car body of 34.5 t, as in the page on sweeps.
CAR_BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)


def sweeps():
    """Return what is drawn, by the name of its picture."""
    table1 = yd.table1(equations="as-printed")
    standing = yd.table1().replace(lambda_=0.05, C_s="1046.77 kN s/m")
    moving = replace(standing, car_body=CAR_BODY)
    chart = {"C_s": "10 kN s/m:10 MN s/m:60:log", "v": "150 km/h:450 km/h:60"}
    return {
        **{name: curves for name, curves in yd.reproduce().drawn.items() if name.startswith("fig3")},
        "chart": yd.sweep(table1, of="stable", C_s="10 kN s/m:10 MN s/m:300:log", v="200 km/h:500 km/h:300"),
        "least-damping": yd.sweep(table1, of="C_sl", f_m="1:8:300", v="150 km/h:450 km/h:300"),
        "chart-standing": yd.sweep(standing, of="stable", **chart),
        "chart-moving": yd.sweep(moving, of="stable", **chart),
        "map-moving": yd.sweep(moving, of="damping_ratio", lambda_="0.02:0.4:60", creep_factor="0.4:1:60"),
    }


def main(data=None):
    """Draw everything; with a folder, write tables there as well."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, result in sweeps().items():
        yd.plot(result).figure.savefig(FOLDER / f"{name}.png", dpi=110)
        if data:
            result.to_csv(Path(data) / f"{name}.csv", replace=True)


if __name__ == "__main__":
    main(*sys.argv[1:2])
