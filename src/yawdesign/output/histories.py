"""Time histories as files."""

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yawdesign.problem.whole_files import write_whole
from yawdesign.study.store import write_arrays

if TYPE_CHECKING:
    from yawdesign.response.run.simulate import Simulation


def _columns(result: "Simulation") -> dict[str, Any]:
    """Return all histories below each other, by the head of their column."""
    import numpy as np

    runs, first = result.histories, result.histories[0]
    columns = {
        "speed [m/s]": np.concatenate([np.full(len(h.time), h.speed) for h in runs]),
        "time [s]": np.concatenate([h.time for h in runs]),
        "distance [m]": np.concatenate([h.distance for h in runs]),
    }
    return columns | {f"{x} [{first.unit(x)}]": np.concatenate([h[x] for h in runs]) for x in first.values}


def write_csv(result: "Simulation", path: Path, *, replace: bool = False) -> None:
    """Write all histories as text, speeds below each other, SI units in the head."""
    import numpy as np

    columns = _columns(result)
    text = io.StringIO()
    np.savetxt(text, np.stack(list(columns.values()), 1), "%.9g", ",", header=", ".join(columns), comments="")
    write_whole(path, text.getvalue().encode(), replace=replace)


def write_npz(result: "Simulation", path: Path, *, replace: bool = False) -> None:
    """Write all histories as NumPy arrays named as in `History.values`, and speed, time and distance, in SI."""
    write_arrays(path, {name.split(" ")[0]: values for name, values in _columns(result).items()}, replace=replace)
