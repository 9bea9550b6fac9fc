"""How fast a free motion dies out or grows, read off the motion itself."""

import numpy as np

from yawdesign.hunting.arrays import Float

SAMPLES = 40  # instants in which the size of the motion is averaged
MOST_WINDOWS = 1500
REGRESSION = 30  # windows that a straight line is laid through
SETTLED = 1e-3  # the slope has settled when it changes by less than this part of itself


def fitted_rate(transition: Float, step: float, coordinates: int, slowest: float) -> tuple[float, float]:
    """Return the growth rate [1/s] fitted on a free motion, negative if it dies out, and how long that was watched [s].

    All coordinates are displaced by different amounts and released. In each of many equal windows the root mean square
    of the displacements is taken; a straight line through its logarithm has the slope looked for, once the faster modes
    have died out and the slope no longer changes.

    Parameters
    ----------
    transition : ndarray, shape (n, n)
        exp(A step).
    step : float
        Time step [s].
    coordinates : int
        Number of states, from the first one on, that are displacements.
    slowest : float
        Frequency of the slowest oscillation that matters [Hz]; a window holds one period of it.
    """
    stride = max(1, round(1 / (slowest * SAMPLES * step)))
    jump = np.linalg.matrix_power(transition, stride)
    window = SAMPLES * stride * step
    x = np.zeros(len(transition))
    x[:coordinates] = 1 + np.arange(coordinates) / coordinates
    levels: list[float] = []
    lifted, before = 0.0, np.nan
    while len(levels) < MOST_WINDOWS:
        for _ in range(REGRESSION):
            x, size = _watch(jump, x, coordinates)
            levels.append(np.log(size) + lifted)
            scale = float(np.linalg.norm(x))
            x, lifted = x / scale, lifted + np.log(scale)
        half = levels[-max(REGRESSION, len(levels) // 2) :]
        slope = float(np.polyfit(window * np.arange(len(half)), half, 1)[0])
        if abs(slope - before) <= SETTLED * abs(slope):
            break
        before = slope
    return slope, len(levels) * window


def _watch(jump: Float, x: Float, coordinates: int) -> tuple[Float, float]:
    total = 0.0
    for _ in range(SAMPLES):
        x = jump @ x
        total += float(x[:coordinates] @ x[:coordinates])
    return x, float(np.sqrt(total / SAMPLES))
