"""Which critical value continues which."""

import numpy as np

from yawdesign.output.branches import CriticalColumn, curves


def test_a_value_turns_back_into_one_other_only():
    """Of three values that the next place has not, two are one fold; the third leaves through the bottom."""
    left = CriticalColumn(np.array([20.0, 300.0, 400.0]), np.array([23.0, 18.0, 17.0]), np.array([2.0, 0.0, 2.0, 0.0]))
    right = CriticalColumn(np.array([]), np.array([]), np.array([0.0]))
    drawn = curves(np.array([300.0, 290.0]), [left, right], 1.0, 1e4)
    ends = {piece[0][1]: piece[1][1] for pieces in drawn.values() for piece in pieces}
    assert ends == {20.0: 1.0, 300.0: np.sqrt(300.0 * 400.0), 400.0: np.sqrt(300.0 * 400.0)}
