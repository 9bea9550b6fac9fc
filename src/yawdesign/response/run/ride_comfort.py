"""Ride comfort: lateral acceleration of the car body, weighted by frequency as in ISO 2631-1.

W_d, for horizontal vibration, is a product of three transfer functions (ISO 2631-1:1997, Annex A; the same constants in
ISO 8041, Table 3): a high pass and a low pass of second order at f_1 = 0.4 Hz and f_2 = 100 Hz with Q = 1/sqrt(2), and
the transition from acceleration to velocity (1 + s/w_3) / (1 + s/(Q_4 w_4) + (s/w_4)^2) with f_3 = f_4 = 2 Hz and
Q_4 = 0.63.
"""

from math import pi, sqrt
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.response.run.system import System
from yawdesign.vehicle.elements import Point
from yawdesign.vehicle.polynomials import evaluate
from yawdesign.vehicle.signals import acceleration

HIGH, LOW, TURN = 2 * pi * 0.4, 2 * pi * 100.0, 2 * pi * 2.0  # [rad/s]
Q_4 = 0.63
SECTIONS = (  # numerators and denominators in s, lowest power first
    ((0.0, 0.0, 1.0), (HIGH**2, sqrt(2) * HIGH, 1.0)),
    ((1.0,), (1.0, sqrt(2) / LOW, 1 / LOW**2)),
    ((1.0, 1 / TURN), (1.0, 1 / (Q_4 * TURN), 1 / TURN**2)),
)


def horizontal_weight(omega: Float) -> Complex:
    """Return W_d of ISO 2631-1 at angular frequencies [rad/s], shape (m,) [-]."""
    s = 1j * np.asarray(omega)
    return np.asarray(np.prod([evaluate(above, s) / evaluate(below, s) for above, below in SECTIONS], axis=0))


def accelerations(system: System) -> tuple[str, ...]:
    """Return the names of the accelerations of ride comfort: those of the car body above each bogie."""
    return tuple(acceleration(e.name) for e in system.space.elements if isinstance(e, Point))


def weighted_in_run(system: System, y: Float, step: float) -> dict[str, float]:
    """Return the weighted root mean squares in a run [m/s^2], the filter at rest in the beginning.

    Parameters
    ----------
    system : System
        The vehicle.
    y : ndarray, shape (steps + 1, outputs)
        All outputs at all instants.
    step : float
        Time step [s].
    """
    names = accelerations(system)
    weighted = _filtered(y[:, [system.outputs[name] for name in names]], step) if names else np.zeros((1, 0))
    sizes = np.sqrt(np.mean(weighted**2, axis=0))
    return {name: float(size) for name, size in zip(names, sizes, strict=True)}


def _filtered(a: Float, step: float) -> Float:
    """Return accelerations after the filter W_d, each section of it exact for straight lines between the instants."""
    from scipy.signal import cont2discrete, sosfilt

    falling: list[Any] = [tuple(np.array(part[::-1], dtype=float) for part in section) for section in SECTIONS]
    discrete: list[Any] = [cont2discrete(section, step, method="foh") for section in falling]
    sections = np.array([np.hstack([np.ravel(above), below]) for above, below, _ in discrete])
    return np.asarray(sosfilt(sections, a, axis=0))
