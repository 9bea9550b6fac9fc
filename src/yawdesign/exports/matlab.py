"""The linear model as a MATLAB file."""

from pathlib import Path

import numpy as np

from yawdesign.exports.file_contents import FileContents, Unavailable
from yawdesign.exports.state_space import state_space
from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.problem import ProblemError
from yawdesign.problem.characters import printable

STATE_SPACE = "state_space.mat"


def write_mat(contents: FileContents, folder: Path) -> list[str]:
    """Write A, B, C, D, the names and units of states, inputs and outputs, C_s, speed and parameters."""
    from scipy.io import savemat

    try:
        model = state_space(contents.problem)
    except ProblemError as error:
        raise Unavailable(f"{STATE_SPACE} left out: {error}") from None
    content: dict[str, object] = {name: getattr(model, name) for name in ("A", "B", "C", "D", "C_s", "speed")}
    content["title"] = printable(model.title)
    content["condition"] = printable(condition_in_words(contents.condition))
    for kind in ("state", "input", "output"):
        content[kind + "_names"] = np.array(getattr(model, kind + "s"), dtype=object)
        content[kind + "_units"] = np.array(getattr(model, kind + "_units"), dtype=object)
    content["parameters"] = {name: float(x) for name, x in contents.problem.parameters().items()}
    savemat(folder / STATE_SPACE, content, oned_as="column")
    return [STATE_SPACE]
