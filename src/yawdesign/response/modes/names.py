"""What moves in a mode, and a name for every mode: a property of the bogie with its numbers and of nothing else."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.eigenvectors import Eigensystem, Motion, motion, parts, spectrum
from yawdesign.response.modes.hunting_mode import conicity_share, hunting_root
from yawdesign.vehicle.catalogue import Parameters
from yawdesign.vehicle.old import LATERAL_DAMPER, MOTOR_DAMPER, YAW_DAMPER

HUNTING = "wheelset hunting"
GROUPS = {
    "y_b": "frame lateral",
    "phi_b": "frame yaw",
    "y_w": HUNTING,
    "phi_w": HUNTING,
    "y_m": "motor lateral",
    "phi_m": "motor yaw",
    YAW_DAMPER: "yaw damper relaxation",
    LATERAL_DAMPER: "lateral damper relaxation",
    MOTOR_DAMPER: "motor damper relaxation",
}
WITHOUT_OSCILLATION = {HUNTING: "wheelset creep"}
LEAST = 1e-3  # a smaller share is as good as none
CERTAIN = 1e30  # the share of a root whose group is known: no other root can take its place
ENDS = {"+": ", both alike", "-": ", against each other"}


@dataclass(frozen=True)
class NamedRoot:
    """A root on the real axis or above it, with its name.

    Parameters
    ----------
    name : str
        No other root has it.
    states : ndarray of int
        States of the part of the motion it belongs to.
    part : Eigensystem
        The spectrum of that part.
    place : int
        Of the root in that spectrum.
    conicity : float
        |d ln s / d ln lambda|: how much the root depends on the conicity.
    """

    name: str
    states: Index
    part: Eigensystem
    place: int
    conicity: float

    @property
    def s(self) -> complex:
        """The root [1/s]."""
        return complex(self.part.s[self.place])


def named_roots(p: Parameters, C_s: float, *, kind: str, equations: str) -> tuple[Motion, tuple[NamedRoot, ...]]:
    """Return the motion of a bogie, and its roots on the real axis and above it with their names.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units and ``v``, floats.
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    kind, equations : str
        As in `yawdesign.vehicle.catalogue.bogie`.
    """
    model = {"kind": kind, "equations": equations}
    system = motion(p, C_s, **model)
    places = parts(system.matrix != 0)
    found = [spectrum(system.matrix[np.ix_(states, states)]) for states in places]
    change = system.matrix - motion({**p, "lambda": 0.0}, C_s, **model).matrix
    conicity = conicity_share(change, places, found)
    names = _names(system, places, found, conicity)
    owners = [(states, part, k) for states, part in zip(places, found, strict=True) for k in range(len(part.s))]
    roots = [NamedRoot(names[i], *owner, float(conicity[i])) for i, owner in enumerate(owners) if i in names]
    return system, tuple(roots)


def _names(system: Motion, places: Sequence[Index], found: Sequence[Eigensystem], conicity: Float) -> dict[int, str]:
    """Return the name of each root on the real axis or above it, by its place among all roots."""
    states = [[system.states[i] for i in place] for place in places]
    groups = groups_of(system)
    share = np.hstack([shares(part, names, groups) for part, names in zip(found, states, strict=True)])
    s, twin = np.concatenate([part.s for part in found]), _joined_twins(found)
    size, hunting = np.abs(s), hunting_root(s, conicity)
    if hunting is not None:
        share[:, [hunting, twin[hunting]]] = np.where(np.array(groups) == HUNTING, CERTAIN, 0.0)[:, None]
        size[hunting] = -1.0  # number 1
    room = [sum(group(state) == name for state in system.states) for name in groups]
    chosen = assign_groups(share, room, twin)
    owner = [names for names in states for _ in names]
    upper = np.flatnonzero(s.imag >= 0)
    stems = [stem(groups[chosen[i]], owner[i], bool(s[i].imag)) for i in upper]
    return dict(zip(upper.tolist(), unique_names(stems, size[upper]), strict=True))


def _joined_twins(found: Sequence[Eigensystem]) -> Index:
    """Return for each root of all parts together the place of its conjugate."""
    start = np.cumsum([0, *(len(part.s) for part in found)])
    return np.concatenate([part.twin + first for part, first in zip(found, start, strict=False)])


def group(state: str) -> str:
    """Return the name of what a state belongs to."""
    return GROUPS[state.rstrip("+-")]


def groups_of(motion: Motion) -> tuple[str, ...]:
    """Return the groups that a motion has, in their order."""
    present = {group(state) for state in motion.states}
    return tuple(name for name in dict.fromkeys(GROUPS.values()) if name in present)


def shares(found: Eigensystem, states: Sequence[str], groups: Sequence[str]) -> Float:
    """Return by how much each group takes part in each mode, shape (groups, modes); columns sum to 1.

    The participation of a group is the sum of left times right eigenvector over its states. It does not depend on
    units, nor on the choice of coordinates inside a group.
    """
    product = found.left * found.right
    rows = np.array([np.abs(product[[group(x) == name for x in states]].sum(axis=0)) for name in groups])
    total = rows.sum(axis=0)
    return np.asarray(rows / np.where(total == 0, 1, total))


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
