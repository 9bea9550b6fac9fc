"""Draws Figure 3 of the paper and a stability chart into docs/figures, and writes the data beside them if asked.

python examples/sweeps.py [FOLDER FOR CSV FILES]
"""

import sys
from pathlib import Path

import numpy as np

import yawdesign as yd

FOLDER = Path(__file__).parents[1] / "docs" / "figures"


def sweeps():
    """Return what is drawn, by the name of its picture."""
    table1 = yd.table1(equations="as-printed")
    # Closer together where the motors move at the frequency of the hunting motion and the curve folds.
    f_m = np.unique(np.concatenate([np.linspace(1, 8, 281), np.linspace(3.2, 3.6, 161), np.linspace(3.22, 3.24, 41)]))
    return {
        "fig3a-damping-held": yd.sweep(table1, of="critical", f_m=f_m),
        "fig3a-ratio-held": yd.sweep(table1, of="critical", f_m=f_m, hold="xi_m"),
        "fig3b": yd.sweep(table1, of="critical", xi_m="0.02:1:491"),
        "chart": yd.sweep(table1, of="stable", C_s="10 kN s/m:10 MN s/m:300:log", v="200 km/h:500 km/h:300"),
        "least-damping": yd.sweep(table1, of="C_sl", f_m="1:8:300", v="150 km/h:450 km/h:300"),
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
