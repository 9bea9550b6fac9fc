"""What moves in a mode, and a name for every mode."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from yawdesign.bogie.vehicles import LATERAL_DAMPER, MOTOR_DAMPER, YAW_DAMPER
from yawdesign.response.spectrum import Index, Motion, Spectrum
from yawdesign.stability.modes import Complex, Float

GROUPS = {
    "y_b": "frame lateral",
    "phi_b": "frame yaw",
    "y_w": "wheelset hunting",
    "phi_w": "wheelset hunting",
    "y_m": "motor lateral",
    "phi_m": "motor yaw",
    YAW_DAMPER: "yaw damper relaxation",
    LATERAL_DAMPER: "lateral damper relaxation",
    MOTOR_DAMPER: "motor damper relaxation",
}
WITHOUT_OSCILLATION = {"wheelset hunting": "wheelset creep"}
LEAST = 1e-3  # a smaller share is as good as none
ENDS = {"+": ", both alike", "-": ", against each other"}


def group(state: str) -> str:
    """Return the name of what a state belongs to."""
    return GROUPS[state.rstrip("+-")]


def groups_of(motion: Motion) -> tuple[str, ...]:
    """Return the groups that a motion has, in their order."""
    present = {group(state) for state in motion.states}
    return tuple(name for name in dict.fromkeys(GROUPS.values()) if name in present)


def shares(found: Spectrum, states: Sequence[str], groups: Sequence[str]) -> Float:
    """Return by how much each group takes part in each mode, shape (groups, modes); columns sum to 1.

    The participation of a group is the sum of left times right eigenvector over its states. It does not depend on
    units, nor on the choice of coordinates inside a group.
    """
    product = found.left * found.right
    rows = [np.abs(product[[group(x) == name for x in states]].sum(axis=0)) for name in groups]
    return normalised(np.array(rows))


def normalised(shares: Float) -> Float:
    """Return the columns divided by their sums."""
    total = shares.sum(axis=0)
    return np.asarray(shares / np.where(total == 0, 1, total))


def assign_groups(share: Float, room: Sequence[int], twin: Index) -> Index:
    """Return the group each root is named after: every group gets as many roots as it has states.

    Parameters
    ----------
    share : ndarray, shape (groups, roots)
        Participation.
    room : sequence of int
        Number of states of each group; their sum is the number of roots.
    twin : ndarray of int
        For each root its conjugate; itself, if it is real. Both get the same group.
    """
    slots = np.repeat(np.arange(len(room)), room)
    weight = np.log(share[slots] + LEAST)
    _, chosen = linear_sum_assignment(-(weight + weight[:, twin]).T)
    chosen = slots[chosen]
    better = share[chosen[twin], np.arange(len(chosen))] > share[chosen, np.arange(len(chosen))]
    level = share[chosen[twin], np.arange(len(chosen))] == share[chosen, np.arange(len(chosen))]
    swap = better | (level & (chosen[twin] < chosen))
    return np.where(swap, chosen[twin], chosen)


def unique_names(stems: Sequence[str], size: Complex | Float) -> tuple[str, ...]:
    """Return the names with a number, in the order of `size`, where several modes bear the same."""
    often, seen = Counter(stems), Counter[str]()
    names = list(stems)
    for k in np.argsort(size, kind="stable"):
        if often[stems[k]] > 1:
            seen[stems[k]] += 1
            names[k] = f"{stems[k]} {seen[stems[k]]}"
    return tuple(names)


def stem(name: str, states: Sequence[str], oscillates: bool) -> str:
    """Return the name of a mode of a group, in a part of the motion that has the given states."""
    signs = {state[-1] for state in states} if len({state.rstrip("+-") for state in states}) == 1 else set()
    apart = ENDS.get(signs.pop(), "") if len(signs) == 1 else ""
    return (name if oscillates else WITHOUT_OSCILLATION.get(name, name)) + apart
