"""A name for every mode: a property of the vehicle with its numbers and of nothing else."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.hunting.eigenvalues import folded_matrix
from yawdesign.response.modes.eigenvectors import Eigensystem, parts, spectrum
from yawdesign.response.modes.participation import (
    Group,
    Owner,
    assign_groups,
    conicity_share,
    of_bogies,
    owners,
    shares,
)
from yawdesign.vehicle.elements import parted
from yawdesign.vehicle.motions import BOGIES
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Vehicle

DEPENDS = 0.1  # of the largest dependence on the conicity: a root with less is not hunting
OF_ONE_BOGIE = 0.5  # more of one bogie than of the other by this: three quarters of the motion are there
CERTAIN = 1e30  # the share of a root whose group is known: no other root can take its place
ENDS = {"+": ", both alike", "-": ", against each other"}
RANKED = {"sway": ("lower sway", "upper sway")}  # what two modes are called that would be numbered, the slower first


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
    hunting : bool
        Whether this is the hunting of the vehicle.
    """

    name: str
    states: Index
    part: Eigensystem
    place: int
    conicity: float
    hunting: bool

    @property
    def s(self) -> complex:
        """The root [1/s]."""
        return complex(self.part.s[self.place])


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
    naming = Naming.of(vehicle.folded_state_space, places, found, conicity_share(change, places, found))
    names, hunting = naming.names, naming.hunting[:1]
    roots = [(states, part, k) for states, part in zip(places, found, strict=True) for k in range(len(part.s))]
    return tuple(
        NamedRoot(names[i], *root, float(naming.conicity[i]), hunting=i in hunting)
        for i, root in enumerate(roots)
        if i in names
    )


def hunting_roots(s: Complex, conicity: Float, side: Float, carried: NDArray[np.bool_], bogies: int) -> list[int]:
    """Return the places of the hunting roots, one for each bogie: first that of the least decay rate, the hunting.

    They are the least decaying oscillations of those that depend on the conicity. An oscillation depends on it if it
    does so by a tenth of what the one that depends most does. One that grows always counts, since only the contact of
    wheel and rail can feed it; but what moves most in it must not be the car body.

    Parameters
    ----------
    s : ndarray
        Roots of the vehicle [1/s].
    conicity : ndarray
        |d ln s / d ln lambda| of each.
    side : ndarray
        How much more it belongs to the leading than to the trailing bogie [-].
    carried : ndarray of bool
        Whether it is named after what stands on two bogies.
    bogies : int
        How many there are.
    """
    waves = (s.imag > 0) & ~carried
    largest = float(np.max(conicity[waves], initial=0.0))
    hunts = waves & ((conicity >= DEPENDS * largest) & (largest > 0) | (s.real > 0))
    found: list[int] = []
    for _ in range(bogies):
        if not hunts.any():
            break
        found.append(int(np.argmax(np.where(hunts, s.real, -np.inf))))
        hunts[found] = False
        if abs(side[found[0]]) > OF_ONE_BOGIE:  # the next one is that of the other bogie
            hunts &= side * np.sign(side[found[0]]) <= OF_ONE_BOGIE
    return found


@dataclass(frozen=True)
class Naming:
    """What is known of all roots, those of one part of the motion after those of another.

    Parameters
    ----------
    s, conicity : ndarray, shape (roots,)
        Roots [1/s], and how much they depend on the conicity.
    moved, all_states : ndarray, shape (2, roots)
        What `of_bogies` says of them, by the motion of bodies alone and with the strokes of dampers.
    twin : ndarray of int
        For each root its conjugate.
    states : tuple of tuple of Owner
        For each root what the states of its part belong to.
    groups : tuple of Group
        What modes are named after.
    chosen : ndarray of int
        For each root its group.
    hunting : tuple of int
        The hunting roots, that of the least decay rate first.
    """

    s: Complex
    conicity: Float
    moved: Float
    all_states: Float
    twin: Index
    states: Sequence[Sequence[Owner]]
    groups: Sequence[Group]
    chosen: Index
    hunting: Sequence[int]

    @classmethod
    def of(cls, space: StateSpace, places: Sequence[Index], found: Sequence[Eigensystem], conicity: Float) -> "Naming":
        """Give every root a group, and find those that are hunting."""
        every = owners(space)
        n = len(space.coordinates)
        order = np.minimum(np.arange(space.size) // n, 2)  # displacement, velocity, stroke
        states = [[every[i] for i in place] for place in places]
        groups = tuple(dict.fromkeys(owner.group for owner in every))
        room = [sum(owner.group == group for owner in every) for group in groups]
        share = np.hstack([shares(part, own, groups) for part, own in zip(found, states, strict=True)])
        moved, all_states = (
            np.hstack(
                [of_bogies(part, own, order[x], among) for part, own, x in zip(found, states, places, strict=True)]
            )
            for among in ((0, 1), (0, 1, 2))
        )
        s, twin = np.concatenate([part.s for part in found]), _joined_twins(found)
        chosen = assign_groups(share, room, twin)
        carried = np.array([group.carried for group in groups])[chosen]
        bogies = 2 if any(owner.bogie for owner in every) else 1
        hunting = hunting_roots(s, conicity, moved[0], carried, bogies)
        if hunting:
            known = np.flatnonzero(carried)
            share[:, known] = np.where(np.arange(len(groups))[:, None] == chosen[known], CERTAIN, 0.0)
            both = [*hunting, *twin[hunting]]
            share[:, both] = np.where([group.hunts for group in groups], CERTAIN, 0.0)[:, None]
            chosen = assign_groups(share, room, twin)
        return cls(s, conicity, moved, all_states, twin, [own for own in states for _ in own], groups, chosen, hunting)

    @property
    def two_bogies(self) -> bool:
        """Whether there are two bogies under what they carry."""
        return any(owner.bogie for states in self.states for owner in states)

    @property
    def names(self) -> dict[int, str]:
        """The name of each root on the real axis or above it, by its place."""
        upper = [int(i) for i in np.flatnonzero(self.s.imag >= 0)]
        own = self._hunting_of_bogies() if self.two_bogies else {}
        others = [i for i in upper if i not in own]
        stems = [self._stem(i) for i in others]
        size = np.abs(self.s)
        size[list(self.hunting)] = -1.0  # number 1
        labels = self._bogies(others, stems)
        return own | dict(zip(others, unique_names(stems, size[others], labels), strict=True))

    def _hunting_of_bogies(self) -> dict[int, str]:
        """Return the names of the hunting of each bogie: of two that which is more of the leading one than the other.

        In a vehicle whose bogies are equal both bogies move in both.
        """
        found = sorted(self.hunting, key=lambda i: -self.moved[0, i])
        first = 1 if len(found) == 1 and self.moved[0, found[0]] < 0 else 0
        return {i: f"{BOGIES['12'[first + k]]} hunting" for k, i in enumerate(found)}

    def _stem(self, i: int) -> str:
        """Return the name of the group of a root, and how the ends of a bogie move where nothing else does."""
        group, states = self.groups[self.chosen[i]], self.states[i]
        name = group.name if self.s[i].imag else group.creeping
        if group.hunts and self.two_bogies and self.s[i].imag:
            name = f"{group.body} oscillation"
        ends = {owner.end for owner in states} if len({parted(owner.name)[0] for owner in states}) == 1 else set()
        apart = ENDS.get(ends.pop(), "") if len(ends) == 1 else ""
        return f"{name}{apart}"

    def _bogies(self, roots: Sequence[int], stems: Sequence[str]) -> list[str]:
        """Return which bogies take part in roots: of those of one name the one half is said to be so, the other so.

        They are called after the leading and the trailing bogie, or after both alike and one against the other,
        whichever the participation is nearer to.
        """
        labels = [""] * len(roots)
        for stem in dict.fromkeys(stems):
            same = [k for k, i in enumerate(roots) if stems[k] == stem and not self.groups[self.chosen[i]].carried]
            which = [roots[k] for k in same]
            bodies = bool(which) and bool(self.groups[self.chosen[which[0]]].body)
            side, phase = (self.moved if bodies else self.all_states)[:, which]
            apart = np.abs(side).sum() > np.abs(phase).sum()
            amount, (one, other) = (side, "12") if apart else (phase, "+-")
            half = len(same) // 2
            for rank, k in enumerate(np.argsort(-amount, kind="stable")):
                first = rank < half or (rank == half and len(same) % 2 == 1 and amount[k] >= 0)
                labels[same[k]] = BOGIES[one if first else other] if self.two_bogies else ""
        return labels


def _joined_twins(found: Sequence[Eigensystem]) -> Index:
    """Return for each root of all parts together the place of its conjugate."""
    start = np.cumsum([0, *(len(part.s) for part in found)])
    return np.concatenate([part.twin + first for part, first in zip(found, start, strict=False)])


def unique_names(stems: Sequence[str], size: Complex | Float, labels: Sequence[str]) -> tuple[str, ...]:
    """Return the names with a number, in the order of `size`, where several modes bear the same, and with a label."""
    full = list(zip(stems, labels, strict=True))
    often, seen, names = Counter(full), Counter[tuple[str, str]](), list(stems)
    for k in np.argsort(size, kind="stable"):
        number = seen[full[k]]
        seen[full[k]] += 1
        if often[full[k]] == len(RANKED.get(stems[k], "")):
            names[k] = RANKED[stems[k]][number]
        elif often[full[k]] > 1:
            names[k] = f"{stems[k]} {number + 1}"
    return tuple(f"{name}, {label}" if label else name for name, label in zip(names, labels, strict=True))
