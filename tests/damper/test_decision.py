"""The decision of the forward design on arrays, against the same written out for one vehicle."""

import math
from functools import reduce

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from yawdesign.damper.decision import GOLDEN, decide

NONE = math.nan


def written_out(crossings, upper, others_stable):
    """Return the interval chosen, C_sl, C_s and the status of one vehicle."""
    sets = [_stable(*one) for one in crossings] if others_stable else [[]]
    stable = reduce(_common, sets)
    below = _common(stable, [(0.0, upper)])
    best = max(below, key=lambda x: x[1] - x[0], default=None)
    C_sl = best[0] if best else stable[0][0] if stable else NONE
    C_s = GOLDEN * best[1] + (1 - GOLDEN) * best[0] if best and best[1] < math.inf else NONE
    return stable, C_sl, C_s, _status(stable, below, best, upper, others_stable)


def _stable(critical, counts):
    ends = [0.0, *critical, math.inf]
    return [(ends[k], ends[k + 1]) for k, n in enumerate(counts) if n == 0]


def _common(left, right):
    both = [(max(a, c), min(b, d)) for a, b in left for c, d in right]
    return sorted((low, high) for low, high in both if low < high)


def _status(stable, below, best, upper, others_stable):
    if not others_stable:
        return "motor yaw undamped"
    if not stable:
        return "stable for none"
    if upper <= 0:
        return "infeasible in the curve"
    if not best:
        return "infeasible"
    if best[1] < upper or len(below) > 1:
        return "partly unstable"
    if math.isinf(best[1]):
        return "no upper limit"
    return "stable for every C_s" if stable == [(0.0, math.inf)] else "ok"


@st.composite
def crossings(draw):
    """Draw critical values and the number of unstable roots between them, which changes by two at each."""
    critical = sorted(draw(st.lists(st.integers(1, 40), max_size=4, unique=True)))
    counts = [draw(st.sampled_from([0, 2, 4]))]
    for _ in critical:
        counts.append(counts[-1] + draw(st.sampled_from([2, -2] if counts[-1] else [2])))
    return [float(x) for x in critical], counts


VEHICLE = st.tuples(
    st.lists(crossings(), min_size=2, max_size=2),
    st.sampled_from([-1.0, 0.0, 0.5, 10.5, 25.5, 100.0, math.inf]),
    st.booleans() | st.just(True),
)


def rows(vehicles, condition):
    """Return the critical values and the counts of all vehicles under a condition as arrays."""
    found = [vehicle[0][condition] for vehicle in vehicles]
    width = max(len(critical) for critical, _ in found)
    critical = np.full((len(found), width), np.nan)
    counts = np.full((len(found), width + 1), np.nan)
    for k, (values, numbers) in enumerate(found):
        critical[k, : len(values)], counts[k, : len(numbers)] = values, numbers
    return critical, counts


@given(st.lists(VEHICLE, min_size=1, max_size=6))
def test_the_decision_is_the_one_written_out(vehicles):
    upper, others_stable = (np.array([vehicle[k] for vehicle in vehicles]) for k in (1, 2))
    decision = decide([rows(vehicles, 0), rows(vehicles, 1)], upper, others_stable)
    for k, vehicle in enumerate(vehicles):
        stable, C_sl, C_s, status = written_out(*vehicle)
        assert decision.status[k] == status
        assert decision.C_sl[k] == pytest.approx(C_sl, nan_ok=True)
        assert decision.C_s[k] == pytest.approx(C_s, nan_ok=True)
        chosen = decision.stable[k] & (decision.low[k] < decision.high[k])
        assert list(zip(decision.low[k][chosen], decision.high[k][chosen], strict=True)) == stable
