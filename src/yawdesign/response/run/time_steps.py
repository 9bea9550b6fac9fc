"""Step by step through time: the exact solution for inputs that run straight from one instant to the next."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import expm

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.response.run.frequency import states
from yawdesign.response.run.system import System
from yawdesign.response.track.lines import MOST_STEPS, Clock, Lines

PER_PERIOD = 10  # instants in the period of the fastest motion, at least
USUAL_STEP = 1e-3  # [s]
TOLD_EVERY = 10_000  # steps after which it is told how many are done
WELL_DAMPED = 0.7  # a mode with more damping has no period to look at


@dataclass(frozen=True, eq=False)
class FirstOrderHold:
    """x[k+1] = transition x[k] + before u[k] + after u[k+1], without error where u is straight between the instants.

    Parameters
    ----------
    transition : ndarray, shape (n, n)
        exp(A step).
    before, after : ndarray, shape (n, inputs)
        What the inputs at both ends of the step contribute.
    """

    transition: Float
    before: Float
    after: Float


def first_order_hold(A: Float, B: Float, step: float) -> FirstOrderHold:
    """Return the discrete model of x' = A x + B u, from one matrix exponential.

    Parameters
    ----------
    A, B : ndarray
        State and input matrix.
    step : float
        Time step [s].
    """
    n, m = B.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n], block[:n, n : n + m] = A * step, B * step
    block[n : n + m, n + m :] = np.eye(m)
    whole = expm(block)
    level, slope = whole[:n, n : n + m], whole[:n, n + m :]
    return FirstOrderHold(np.ascontiguousarray(whole[:n, :n]), level - slope, slope)


def forced(hold: FirstOrderHold, u: Float) -> Float:
    """Return what inputs of shape (steps + 1, m) add to the states in each step."""
    return np.asarray(u[:-1] @ hold.before.T + u[1:] @ hold.after.T)


def forced_by_lines(system: System, hold: FirstOrderHold, lines: Lines, clock: Clock) -> Float:
    """Return what harmonic inputs add to the states in each step, without the error of straight lines."""
    x = states(system, lines.omega, lines.amplitudes)
    turned = x * np.exp(1j * lines.omega * clock.step)[:, None] - x @ hold.transition.T
    return np.asarray((np.exp(1j * np.outer(clock.time[:-1], lines.omega)) @ turned).real)


def march(transition: Float, force: Float, x: Float, told: Callable[[float], Any] = lambda part: None) -> Float:
    """Return the states at all instants, shape (steps + 1, n); `told` is called with the share that is done."""
    history = np.empty((len(force) + 1, len(x)))
    history[0] = x
    for k, f in enumerate(force):
        if k % TOLD_EVERY == 0:
            told(k / len(force))
        x = transition @ x + f
        history[k + 1] = x
    return history


def settled(transition: Float, force: Float) -> Float:
    """Return the state from which a periodic force leads back to itself (a stable system has one)."""
    end = march(transition, force, np.zeros(len(transition)))[-1]
    return np.asarray(np.linalg.solve(np.eye(len(end)) - np.linalg.matrix_power(transition, len(force)), end))


def fastest_motion(system: System) -> float:
    """Return the frequency of the fastest oscillation of the bogie [Hz]; 0 if there is none."""
    s = system.eigenvalues
    swings = s[(s.imag > 0) & (-s.real < WELL_DAMPED * np.abs(s))]
    return float(swings.imag.max() / (2 * np.pi)) if len(swings) else 0.0


def time_step(system: System, excitation: float, step: float | None) -> float:
    """Return the time step: the one given, if it is fine enough, or the usual one, made finer where needed.

    Parameters
    ----------
    system : System
        The bogie.
    excitation : float
        Highest frequency of the track [Hz].
    step : float or None
        The step asked for [s].
    """
    fastest, what = max((fastest_motion(system), "bogie"), (excitation, "track"))
    largest = 1 / (PER_PERIOD * fastest) if fastest else np.inf
    if step is None:
        return float(min(USUAL_STEP, largest))
    if step > largest * (1 + 1e-9):
        message = f"{step:g} s is too coarse: the {what} moves at {fastest:.4g} Hz, which takes {largest:.3g} s or less"
        raise ProblemError(message).under("step")
    return step


def clock_of(duration: float, step: float) -> Clock:
    """Return the instants of a run; the step is shortened so that the last one falls on the end."""
    steps = int(np.ceil(duration / step * (1 - 1e-12)))
    if steps > MOST_STEPS:
        message = f"{duration:g} s in steps of {step:.3g} s are {steps} steps, at most {MOST_STEPS} are made"
        raise ProblemError(message).under("duration")
    if steps < PER_PERIOD:
        raise ProblemError(f"{duration:g} s are only {steps} steps of {step:.3g} s: run for longer").under("duration")
    steps += steps % 2  # an even number for the fast Fourier transform
    return Clock(duration / steps, steps)
