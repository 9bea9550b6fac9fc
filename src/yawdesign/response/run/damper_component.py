"""The yaw damper as something to order: its dynamic stiffness, and what it does in a run."""

from dataclasses import dataclass
from math import atan2, pi

import numpy as np

from yawdesign.hunting.eigenvalues import decay_rate, motion_eigenvalues
from yawdesign.problem.result import Result
from yawdesign.response.run.frequency import outputs
from yawdesign.response.run.run import Run
from yawdesign.response.run.system import System
from yawdesign.vehicle.elements import Maxwell
from yawdesign.vehicle.polynomials import evaluate
from yawdesign.vehicle.vehicle import Vehicle

RIGID = 1e4  # joints so many times as stiff as they are count as rigid
RATED_VELOCITY = 0.1  # [m/s]: where catalogues give the force
FREQUENCIES = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)  # [Hz]
EXACT = 1e-6


@dataclass(frozen=True)
class DynamicStiffness:
    """The pair of yaw dampers, joints included, under a harmonic displacement.

    Parameters
    ----------
    frequency : float
        Frequency [Hz].
    stiffness : float
        |Z|, force over displacement [N/m].
    phase : float
        By which the force leads the displacement [rad]; pi/2 for a damper with rigid joints.
    loss_factor : float
        Im Z / Re Z [-].
    damping : float
        Im Z / (2 pi frequency) [N s/m]: what is left of C_s.
    """

    frequency: float
    stiffness: float
    phase: float
    loss_factor: float
    damping: float


@dataclass(frozen=True, repr=False)
class DamperComponent(Result):
    """What to order for a chosen C_s. `Z` belongs to the pair of dampers, forces and strokes to each of the two.

    Z(s) = K_ds C_s s / (K_ds + C_s s) for the pair; each damper has half of C_s and stands between two joints of
    stiffness K_ds.

    Parameters
    ----------
    C_s, K_ds : float
        Damping of the pair [N s/m], and stiffness of a joint [N/m], which is also that of the pair's four in series
        and parallel.
    C_each : float
        Damping of each damper, C_s / 2 [N s/m].
    force_at_rated_velocity : float
        Of each damper at 0.1 m/s [N]. A linear damper does not blow off.
    corner_frequency : float
        K_ds / (2 pi C_s) [Hz]: above it the joints give way more than the damper.
    hunting_frequency : float or None
        Of the hunting, the mode that `yawdesign.modes` calls so [Hz].
    at_hunting : DynamicStiffness or None
        There.
    over_frequency : tuple of DynamicStiffness
        From 0.5 to 10 Hz.
    decay_rate, decay_rate_rigid : float
        Of the coupled motion with the joints as they are, and with rigid ones [1/s].
    speed : float
        Speed of the run [m/s].
    force_rms, force_peak : float
        Of each damper in the run [N].
    stroke_rms, stroke_peak : float
        Of each piston in the run [m].
    velocity_rms, velocity_peak : float
        Of each piston in the run [m/s].
    checked : bool
        True if Z is also what force over displacement is in the frequency response of the bogie.
    """

    C_s: float
    K_ds: float
    C_each: float
    force_at_rated_velocity: float
    corner_frequency: float
    hunting_frequency: float | None
    at_hunting: DynamicStiffness | None
    over_frequency: tuple[DynamicStiffness, ...]
    decay_rate: float
    decay_rate_rigid: float
    speed: float
    force_rms: float
    force_peak: float
    stroke_rms: float
    stroke_peak: float
    velocity_rms: float
    velocity_peak: float
    checked: bool


def component(system: System, run: Run) -> DamperComponent | None:
    """Return the yaw damper of a bogie in a run; None if it has no damping."""
    vehicle, C_s, K_ds = system.vehicle, system.C_s, float(system.vehicle.p["K_ds"])
    if C_s == 0:
        return None
    each = C_s / 2
    force_rms, force_peak = run.rms["yaw_damper_force"], run.peak["yaw_damper_force"]
    return DamperComponent(
        C_s=C_s,
        K_ds=K_ds,
        C_each=each,
        force_at_rated_velocity=each * RATED_VELOCITY,
        corner_frequency=K_ds / (2 * pi * C_s),
        hunting_frequency=run.frequency,
        at_hunting=None if run.frequency is None else dynamic_stiffness(K_ds, C_s, run.frequency),
        over_frequency=tuple(dynamic_stiffness(K_ds, C_s, f) for f in FREQUENCIES),
        decay_rate=_coupled_decay_rate(vehicle),
        decay_rate_rigid=_coupled_decay_rate(vehicle.replace(K_ds=K_ds * RIGID)),
        speed=run.speed,
        force_rms=force_rms,
        force_peak=force_peak,
        stroke_rms=run.rms["yaw_damper_stroke"],
        stroke_peak=run.peak["yaw_damper_stroke"],
        velocity_rms=force_rms / each,
        velocity_peak=force_peak / each,
        checked=_same_in_the_bogie(system, K_ds),
    )


def _coupled_decay_rate(vehicle: Vehicle) -> float:
    return float(decay_rate(motion_eigenvalues(vehicle, vehicle.model.motions[0])))


def dynamic_stiffness(K_ds: float, C_s: float, frequency: float) -> DynamicStiffness:
    """Return Z of the pair of dampers at a frequency [Hz]."""
    omega = 2 * pi * frequency
    law = Maxwell(K_ds, C_s)
    Z = complex(evaluate(law.numerator, 1j * omega) / evaluate(law.denominator, 1j * omega))
    loss = Z.imag / Z.real if Z.real else float("inf")
    return DynamicStiffness(frequency, abs(Z), atan2(Z.imag, Z.real), loss, Z.imag / omega)


def _same_in_the_bogie(system: System, K_ds: float) -> bool:
    omega = 2 * pi * np.array(FREQUENCIES)
    y = outputs(system, omega, system.wheelsets.harmonic(omega, "alignment"))
    u, found = (np.abs(y[:, system.outputs[f"yaw_damper_{what}"]]) for what in ("displacement", "pair_force"))
    expected = [dynamic_stiffness(K_ds, system.C_s, f).stiffness for f in FREQUENCIES] * u
    return bool(np.allclose(found, expected, rtol=EXACT, atol=0.0))
