"""What takes part in a mode: bodies and dampers by groups, the two bogies, and the conicity."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.eigenvectors import Eigensystem
from yawdesign.vehicle.elements import Link, Mass, WheelRailContact, parted
from yawdesign.vehicle.state_space import StateSpace

LEAST = 1e-3  # a smaller share is as good as none
OTHER_END = {"+": "-", "-": "+", "1": "2", "2": "1"}
FIRST = {"+": 1.0, "1": 1.0, "-": -1.0, "2": -1.0}


@dataclass(frozen=True)
class Group:
    """Bodies or dampers that modes are named after in the same words.

    Parameters
    ----------
    name : str
        What a mode is called in which they move most.
    creeping : str
        The same for a mode that does not oscillate.
    body : str
        What they are, such as ``wheelset``; dampers have no word here.
    hunts : bool
        Whether they are wheelsets, after which hunting is named.
    carried : bool
        Whether they stand on two bogies.
    """

    name: str
    creeping: str
    body: str = ""
    hunts: bool = False
    carried: bool = False


@dataclass(frozen=True)
class Owner:
    """What a state belongs to: a coordinate, or a damper by its stroke.

    Parameters
    ----------
    name : str
        Of the coordinate or the damper, in half sums ``y_w+`` and half differences ``y_w-``.
    group : Group
        What is named like it.
    bogie : str
        Which of two bogies it is part of, "1" or "2", or "+" or "-" for half the sum and half the difference of both;
        nothing where there is one bogie, or for what both carry.
    end : str
        The same for the two ends of a bogie.
    """

    name: str
    group: Group
    bogie: str = ""
    end: str = ""

    @property
    def opposite(self) -> str:
        """Name of the same in the other bogie."""
        stem, _ = parted(self.name)
        return stem + OTHER_END.get(self.bogie, "") + self.end


def owners(space: StateSpace) -> tuple[Owner, ...]:
    """Return what each state belongs to."""
    contacts = [e for e in space.elements if isinstance(e, WheelRailContact)]
    wheelsets = {x for contact in contacts for x in (contact.y, contact.phi)}
    two = max(len(parted(x)[1]) for x in space.coordinates) > 1
    return tuple(_owner(element, wheelsets, two) for element in space.owners)


def _owner(element: Mass | Link, wheelsets: Collection[str], two: bool) -> Owner:
    full = element.name if isinstance(element, Link) else element.coordinate
    stem, ends = parted(full)
    bogie, end = (ends[:1], ends[1:]) if two else ("", ends)
    carried = two and not ends
    if isinstance(element, Link):
        name = f"{stem.strip()} relaxation"
        return Owner(full, Group(name, name, carried=carried), bogie, end)
    name = element.name or stem
    group = Group(name, element.creeping or name, element.body, full in wheelsets, carried)
    return Owner(full, group, bogie, end)


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


def of_bogies(found: Eigensystem, states: Sequence[Owner], orders: Index, among: Collection[int]) -> Float:
    """Return how much more one bogie takes part in each mode than the other, and both alike than against each other.

    The real part of left times right eigenvector is the share that damping of what moves would have in the decay rate;
    over all states it sums to 1. Both answers lie between -1 and 1 where these shares are positive, and are 0 where
    there is one bogie.

    Parameters
    ----------
    found : Eigensystem
        The spectrum of a part of the motion.
    states : sequence of Owner
        What each of its states belongs to.
    orders : ndarray of int
        Whether each is a displacement (0), a velocity (1), or a stroke (2).
    among : collection of int
        Which of these are looked at.

    Returns
    -------
    ndarray, shape (2, modes)
        Leading minus trailing bogie, alike minus against each other [-].
    """
    keys = [(owner.name, order) for owner, order in zip(states, orders.tolist(), strict=True)]
    other = [
        keys.index(key) if (key := (x.opposite, order)) in keys else -1
        for x, (_, order) in zip(states, keys, strict=True)
    ]
    sign = np.array([FIRST.get(x.bogie, 0.0) * (order in among) for x, (_, order) in zip(states, keys, strict=True)])
    both = (np.array(other) >= 0) & (sign != 0)
    own = np.real(sign @ (found.left * found.right))
    crossed = np.real(both @ (found.left * found.right[other]))
    folded = any(owner.bogie in ("+", "-") for owner in states)
    return np.array([crossed, own] if folded else [own, crossed])


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
    s: Complex = np.concatenate([part.s for part in found])
    return np.asarray(np.abs(np.concatenate(moved)) / np.where(s == 0, 1, np.abs(s)))
