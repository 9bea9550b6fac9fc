"""All critical values of the yaw damping of many vehicles with two links of yaw dampers, each checked.

At s = j w the polynomial is of second degree in mu = 1/C_s: two branches mu(w) over the frequency, and a critical value
where one of them is real and positive. The frequencies are cut into cells. In the middle of a cell the angles of both
branches tell how far they are from straight; a cell that may hold more than one crossing is halved. What is found is
polished on the receptance at the yaw dampers, and the unstable roots are counted in every interval of C_s.
"""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float, Index
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.critical_table import FAR, CriticalField, Rows, counted, natural_damping
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.receptance import Receptance
from yawdesign.hunting.routh import TIME_UNIT

# Of the frequency, in 100 rad/s: the ends of the range and of its coarse part, and the cells in both parts. A heavy
# car body moves that slowly; far above, both branches are one but for rounding.
RANGE, CELLS = (1e-9, 1e-4, 1e2), (20, 96)
HALVINGS = 24
MOST = 64  # open cells of a vehicle: where more are open it is left to the way that looks at one
BENT = 3.0  # how many times the angle's deviation from straight in the middle a branch may stray inside a cell
STEEP = 1.0  # largest turn of a branch in half a cell [rad] that is believed
HALF_TURN = 2.0  # turn of a polynomial in half a cell [rad] that may be half a turn, others turning it on or back
SECTIONS = 6
STEPS = 5  # of Newton's method on the receptance; what needs more is left open
APART = 1e-6  # relative difference of two values between which roots are counted
BLOCK = 512  # vehicles


class _Stretches(NamedTuple):
    """Parts of the range: whose, the logarithms of their ends, and what `_solved` gives there and in the middle."""

    owner: Index
    low: Float
    high: Float
    left: Complex
    middle: Complex
    right: Complex

    def some(self, chosen: Bools | Index) -> "_Stretches":
        parts: list[Any] = [x[..., chosen] for x in self]
        return _Stretches(*parts)


class _Crossing(NamedTuple):
    """Cells in which one branch crosses the positive real axis once: whose, their ends, and the branch there."""

    owner: Index
    low: Float
    high: Float
    left: Complex
    right: Complex


def followed_branches(sets: ParameterSets) -> tuple[CriticalField, Bools]:
    """Return the critical values of many vehicles, and whether this way decides them.

    Parameters
    ----------
    sets : ParameterSets
        With ``v``.
    """
    tape, lengths = counts.boundaries(sets.model, sets.zeros - {"C_s"})
    results, n = tape(sets.values), sets.size
    results = results / np.abs(results[: lengths[0]]).max(axis=0)
    parts = np.split(results, np.cumsum(lengths)[:-1])
    with np.errstate(all="ignore"):  # what overflows is no number, and fails
        crossing, open_ = _crossings(parts)
        mu, omega = _narrowed(parts, crossing)
        own = sets.part(crossing.owner)
        found = Receptance(own.vehicle).followed(mu, omega * TIME_UNIT, STEPS)
        margin = 0.1 * (crossing.high - crossing.low)
        place = np.log(found.omega / TIME_UNIT)
        inside = (place > crossing.low - margin) & (place < crossing.high + margin)
    open_[crossing.owner[~(found.found & inside)]] = True
    rows = Rows(crossing.owner, found.C_s, n)
    critical, frequency, direction = map(rows.spread, found[:3])
    unstable, doubtful = counted(parts, critical, natural_damping(sets))
    last = np.take_along_axis(unstable, rows.count[:, None], axis=1)
    at_infinity, _ = counted(parts, np.zeros((n, 0)), natural_damping(sets) * FAR**2)  # of those without values too
    open_ |= (last != at_infinity)[:, 0]
    steps = np.diff(unstable, axis=1)
    with np.errstate(invalid="ignore"):
        right = np.where(np.isnan(critical), True, steps == 2 * direction).all(axis=1)
        close = (np.diff(critical, axis=1) < APART * critical[:, 1:]).any(axis=1)
    none = np.zeros(n, dtype=bool)
    return CriticalField(critical, frequency, unstable, none, none), right & ~(doubtful | close | open_)


def _crossings(parts: list[Float]) -> tuple[_Crossing, Bools]:
    """Return the cells with one crossing, and which vehicles have cells that stayed open."""
    n = parts[0].shape[1]
    open_ = np.zeros(n, dtype=bool)
    done: list[_Crossing] = []
    for first in range(0, n, BLOCK):
        block = [part[:, first : first + BLOCK] for part in parts]
        cells = _first_cells(block)
        for _ in range(HALVINGS):
            cells, found = _sorted_out(cells)
            done.append(found._replace(owner=found.owner + first))
            crowded = np.bincount(cells.owner, minlength=block[0].shape[1]) > MOST
            open_[first + np.flatnonzero(crowded)] = True
            cells = cells.some(~crowded[cells.owner])
            if not len(cells.owner):
                break
            cells = _halved(block, cells)
        open_[first + cells.owner] = True
    return _Crossing(*(np.concatenate(column, axis=-1) for column in zip(*done, strict=True))), open_


def _first_cells(parts: list[Float]) -> _Stretches:
    """Return all cells of some vehicles."""
    n = parts[0].shape[1]
    between = zip(pairwise(np.log(RANGE)), CELLS, strict=True)
    place = np.concatenate([np.linspace(*ends, 2 * cells, endpoint=False) for ends, cells in between])
    place = np.append(place, np.log(RANGE[-1]))
    w = np.exp(place)
    a, b, c = (_table(part, w) for part in parts)
    mu = _solved(a, b, c)
    left, middle, right = mu[:, :-2:2], mu[:, 1::2], mu[:, 2::2]
    low, high = (np.repeat(x, n) for x in (place[:-2:2], place[2::2]))
    flat = (x.reshape(len(x), -1) for x in (left, middle, right))
    return _Stretches(np.tile(np.arange(n), sum(CELLS)), low, high, *flat)


def _table(part: Float, w: Float) -> Complex:
    """Return the values of polynomials at all places j w, shape (places, polynomials)."""
    x = -w * w
    even = np.vander(x, len(part[::2]), increasing=True) @ part[::2]
    odd = np.vander(x, len(part[1::2]), increasing=True) @ part[1::2]
    return even + 1j * w[:, None] * odd


def _values(parts: list[Float], owner: Index, w: Float) -> Complex:
    """Return what `_solved` gives for some vehicles, each at a place of its own."""
    x = -w * w
    found = []
    for part in parts:
        own = np.take(part, owner, axis=1)
        even, odd = (_horner(half, x) for half in (own[::2], own[1::2]))
        found.append(even + 1j * w * odd)
    return _solved(*found)


def _horner(p: Float, x: Float) -> Float:
    value: Float = p[-1].copy()
    for a in p[-2::-1]:
        value *= x
        value += a
    return value


def _solved(a: Complex, b: Complex, c: Complex) -> Complex:
    """Return both solutions of a mu^2 + b mu + c = 0, then a, c and the discriminant, along a new first axis.

    Of the last three only the angles are looked at.
    """
    b, ratio, turn = b / a, c / a, a / np.abs(a)
    discriminant = b * b - 4 * ratio
    root = np.sqrt(discriminant)
    root = np.where((np.conj(b) * root).real < 0, -root, root)
    q = -(b + root) / 2
    return np.stack([q, ratio / q, turn, c, discriminant * turn * turn])


def _along(start: Complex, end: Complex) -> Complex:
    """Return both branches at the end in the order in which they lead there from the start."""
    start, end = start[:2], end[:2]
    same, other = (np.abs(np.log(x / start)).sum(axis=0) for x in (end, end[::-1]))
    return np.where(other < same, end[::-1], end)


def _sorted_out(cells: _Stretches) -> tuple[_Stretches, _Crossing]:
    """Return the cells that may hold more than one crossing, and those with one."""
    middle = _along(cells.left, cells.middle)
    right = _along(middle, cells.right)
    left = cells.left[:2]
    angle, first, second = np.angle(left), np.angle(middle / left), np.angle(right / middle)
    bent = BENT * np.abs(second - first) / 2
    turns = np.stack([angle, angle + first, angle + first + second])
    # In whole turns: between which multiples of a turn the branch lies.
    low, high = (np.floor(x / (2 * np.pi)) for x in (turns.min(axis=0) - bent, turns.max(axis=0) + bent))
    away = low == high
    ends = np.floor(turns[[0, 2]] / (2 * np.pi))
    once = (np.abs(ends[1] - ends[0]) == 1) & (high - low == 1) & (bent < np.abs(first + second))
    known = np.isfinite(bent) & (np.maximum(np.abs(first), np.abs(second)) < STEEP)
    # Where a branch is to be followed to its crossing the other one must be farther away than it goes.
    apart = np.abs(np.log(middle[0] / middle[1])) > np.abs(np.log(right / left))
    settled = ~_hidden(cells) & (known & (away | (once & apart))).all(axis=0)
    k, cell = np.nonzero(settled & once & ~away)
    found = _Crossing(cells.owner[cell], cells.low[cell], cells.high[cell], left[k, cell], right[k, cell])
    return cells.some(~settled), found


def _hidden(cells: _Stretches) -> Bools:
    """Return in which cells something may go on between the places looked at.

    A root of `a` near the axis makes a branch run far out and back, one of `c` to zero and back, and one of the
    discriminant makes both branches turn. However narrow that is, the angle of the polynomial turns by half a turn.
    """
    turns = [np.angle(end[2:] / start[2:]) for start, end in pairwise((cells.left, cells.middle, cells.right))]
    return np.asarray(~(np.abs(turns) < HALF_TURN).all(axis=(0, 1)))


def _halved(parts: list[Float], cells: _Stretches) -> _Stretches:
    """Return both halves of all cells."""
    middle = (cells.low + cells.high) / 2
    owner = np.tile(cells.owner, 2)
    low, high = np.concatenate([cells.low, middle]), np.concatenate([middle, cells.high])
    left, right = (np.concatenate(x, axis=1) for x in ((cells.left, cells.middle), (cells.middle, cells.right)))
    return _Stretches(owner, low, high, left, _values(parts, owner, np.exp((low + high) / 2)), right)


def _narrowed(parts: list[Float], cells: _Crossing) -> tuple[Complex, Float]:
    """Return where the branch crosses the axis (regula falsi on its angle, Illinois), and its value there."""
    owner, low, high = cells.owner, cells.low, cells.high
    start, rise = np.log(cells.left), np.log(cells.right / cells.left) / (high - low)
    at_low, at_high = np.angle(cells.left), np.angle(cells.right)
    place, value = low, cells.left
    for _ in range(SECTIONS):
        place = low - at_low * (high - low) / (at_high - at_low)
        both = _values(parts, owner, np.exp(place))[:2]
        expected = np.exp(start + rise * (place - cells.low))
        near = np.argmin(np.abs(np.log(both / expected)), axis=0)
        value = both[near, np.arange(len(near))]
        angle = np.angle(value)
        beyond = (angle > 0) == (at_high > 0)
        low, at_low = np.where(beyond, low, place), np.where(beyond, at_low / 2, angle)
        high, at_high = np.where(beyond, place, high), np.where(beyond, angle, at_high / 2)
    return value, np.exp(place)
