"""What moves in a mode, and a name for every mode: a property of the vehicle with its numbers and of nothing else."""

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.hunting.eigenvalues import folded_matrix
from yawdesign.response.modes.eigenvectors import Eigensystem, parts, spectrum
from yawdesign.vehicle.elements import Link, Mass, WheelRailContact
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Vehicle

DEPENDS = 0.1  # of the largest dependence on the conicity: a root with less is not hunting


def conicity_share(change: Float, places: Sequence[Index], found: Sequence[Eigensystem]) -> Float:
    """Return by how much each root depends on the conicity, |d ln s / d ln lambda|.

    Parameters
    ----------
    change : ndarray
        What the conicity adds to the state matrix; since it does so linearly, also the derivative to ln lambda.
    places, found : sequences
        States and spectrum of each part of the motion.
    """
    moved = [part.velocity(change[np.ix_(states, states)]) for states, part in zip(places, found, strict=True)]
    s = np.concatenate([part.s for part in found])
    return np.asarray(np.abs(np.concatenate(moved)) / np.where(s == 0, 1, np.abs(s)))


def hunting_root(s: Complex, conicity: Float) -> int | None:
    """Return the place of the hunting root: the least decaying oscillation of those that depend on the conicity.

    An oscillation depends on it if it does so by a tenth of what the one that depends most does. One that grows always
    counts, since only the contact of wheel and rail can feed it.

    Parameters
    ----------
    s : ndarray
        Roots of the bogie [1/s].
    conicity : ndarray
        |d ln s / d ln lambda| of each.

    Returns
    -------
    int or None
        None if nothing that oscillates depends on the conicity.
    """
    waves = s.imag > 0
    largest = float(np.max(conicity[waves], initial=0.0))
    hunts = waves & ((conicity >= DEPENDS * largest) & (largest > 0) | (s.real > 0))
    return int(np.argmax(np.where(hunts, s.real, -np.inf))) if hunts.any() else None


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


@dataclass(frozen=True)
class Group:
    """Bodies or dampers that modes are named after in the same words.

    Parameters
    ----------
    name : str
        What a mode is called in which they move most.
    creeping : str
        The same for a mode that does not oscillate.
    hunts : bool
        Whether they are wheelsets, after which hunting is named.
    """

    name: str
    creeping: str
    hunts: bool


@dataclass(frozen=True)
class Owner:
    """What a state belongs to: a coordinate, or a damper by its stroke.

    Parameters
    ----------
    name : str
        Of the coordinate or the damper, in half sums ``y_w+`` and half differences ``y_w-``.
    group : Group
        What is named like it.
    """

    name: str
    group: Group


def owners(space: StateSpace) -> tuple[Owner, ...]:
    """Return what each state belongs to."""
    contacts = [e for e in space.elements if isinstance(e, WheelRailContact)]
    wheelsets = {x for contact in contacts for x in (contact.y, contact.phi)}
    return tuple(_owner(element, wheelsets) for element in space.owners)


def _owner(element: Mass | Link, wheelsets: Collection[str]) -> Owner:
    if isinstance(element, Link):
        name = f"{element.name.rstrip('+- ')} relaxation"
        return Owner(element.name, Group(name, name, hunts=False))
    name = element.name or element.coordinate.rstrip("+-")
    return Owner(element.coordinate, Group(name, element.creeping or name, hunts=element.coordinate in wheelsets))


def named_roots(vehicle: Vehicle) -> tuple[NamedRoot, ...]:
    """Return the roots of a vehicle on the real axis and above it with their names.

    Parameters
    ----------
    vehicle : Vehicle
        All its numbers are floats.
    """
    matrix = folded_matrix(vehicle)
    places = parts(matrix != 0)
    found = [spectrum(matrix[np.ix_(states, states)]) for states in places]
    change = matrix - folded_matrix(vehicle.replace(lambda_=0.0))
    conicity = conicity_share(change, places, found)
    names = _names(owners(vehicle.folded_state_space), places, found, conicity)
    roots = [(states, part, k) for states, part in zip(places, found, strict=True) for k in range(len(part.s))]
    return tuple(NamedRoot(names[i], *root, float(conicity[i])) for i, root in enumerate(roots) if i in names)


def _names(
    owners: Sequence[Owner], places: Sequence[Index], found: Sequence[Eigensystem], conicity: Float
) -> dict[int, str]:
    """Return the name of each root on the real axis or above it, by its place among all roots."""
    states = [[owners[i] for i in place] for place in places]
    groups = tuple(dict.fromkeys(owner.group for owner in owners))
    share = np.hstack([shares(part, own, groups) for part, own in zip(found, states, strict=True)])
    s, twin = np.concatenate([part.s for part in found]), _joined_twins(found)
    size, hunting = np.abs(s), hunting_root(s, conicity)
    if hunting is not None:
        share[:, [hunting, twin[hunting]]] = np.where([group.hunts for group in groups], CERTAIN, 0.0)[:, None]
        size[hunting] = -1.0  # number 1
    room = [sum(owner.group == group for owner in owners) for group in groups]
    chosen = assign_groups(share, room, twin)
    part_of = [own for own in states for _ in own]
    upper = np.flatnonzero(s.imag >= 0)
    stems = [_stem(groups[chosen[i]], part_of[i], bool(s[i].imag)) for i in upper]
    return dict(zip(upper.tolist(), unique_names(stems, size[upper]), strict=True))


def _joined_twins(found: Sequence[Eigensystem]) -> Index:
    """Return for each root of all parts together the place of its conjugate."""
    start = np.cumsum([0, *(len(part.s) for part in found)])
    return np.concatenate([part.twin + first for part, first in zip(found, start, strict=False)])


def shares(found: Eigensystem, states: Sequence[Owner], groups: Sequence[Group]) -> Float:
    """Return by how much each group takes part in each mode, shape (groups, modes); columns sum to 1.

    The participation of a group is the sum of left times right eigenvector over its states. It does not depend on
    units, nor on the choice of coordinates inside a group.
    """
    product = found.left * found.right
    rows = np.array([np.abs(product[[owner.group == group for owner in states]].sum(axis=0)) for group in groups])
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


def _stem(group: Group, states: Sequence[Owner], oscillates: bool) -> str:
    """Return the name of a mode of a group, in a part of the motion that has the given states."""
    signs = {owner.name[-1] for owner in states} if len({owner.name.rstrip("+-") for owner in states}) == 1 else set()
    apart = ENDS.get(signs.pop(), "") if len(signs) == 1 else ""
    return (group.name if oscillates else group.creeping) + apart
