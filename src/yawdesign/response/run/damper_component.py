"""The yaw damper as something to order: its dynamic stiffness, and what it does in a run."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, inf, isinf, pi
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Complex
from yawdesign.hunting.eigenvalues import decay_rate, motion_eigenvalues
from yawdesign.problem.result import Result
from yawdesign.response.run.frequency import outputs
from yawdesign.response.run.run import Run
from yawdesign.response.run.system import System
from yawdesign.vehicle.elements import Law, Link, Maxwell
from yawdesign.vehicle.polynomials import evaluate
from yawdesign.vehicle.signals import of_damper
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
        ``|Z|``, force over displacement [N/m].
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

    def force(self, velocity: float) -> float:
        """Return the amplitude of the pair's force [N] for an amplitude of its velocity, joints included [m/s]."""
        return self.stiffness * velocity / (2 * pi * self.frequency)


@dataclass(frozen=True, repr=False)
class DamperComponent(Result):
    """What to order for a chosen C_s. `Z` belongs to the pair of dampers, forces and strokes to each of the two.

    Z(s) = K_ds C_s s / (K_ds + C_s s) for the pair; each damper has half of C_s and stands between two joints of
    stiffness K_ds. With rigid joints Z(s) = C_s s.

    Parameters
    ----------
    name : str
        "yaw damper", or which of two bogies has it: "yaw damper 1" of the leading one, "yaw damper 2".
    C_s, K_ds : float
        Damping of the pair [N s/m], and stiffness of a joint [N/m], which is also that of the pair's four in series
        and parallel; infinite for rigid ones.
    C_each : float
        Damping of each damper, C_s / 2 [N s/m].
    force_at_rated_velocity : float
        Of each damper at 0.1 m/s [N]. A linear damper does not blow off.
    corner_frequency : float
        K_ds / (2 pi C_s) [Hz]: above it the joints are displaced more than the damper.
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
        True if Z is also what force over displacement is in the frequency response of the vehicle.
    """

    name: str
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

    def complex_stiffness(self, frequency: Any) -> Complex:
        """Return Z of the pair under harmonic displacements, force over displacement [N/m].

        Parameters
        ----------
        frequency : float or array_like
            [Hz].
        """
        damper = 2j * pi * np.asarray(frequency) * self.C_s
        return np.asarray(damper if isinf(self.K_ds) else damper * self.K_ds / (self.K_ds + damper))


def components(system: System, run: Run) -> tuple[DamperComponent, ...]:
    """Return the yaw dampers of a vehicle in a run, one for each bogie; those without damping are left out."""
    links = [e for e in system.space.elements if isinstance(e, Link) and e.varied]
    dampers: list[tuple[Link, Any]] = [(link, law) for link in links for law in link.laws]
    rates = {"decay_rate": _coupled_decay_rate(system.vehicle), "decay_rate_rigid": _coupled_decay_rate(_rigid(system))}
    return tuple(_component(system, run, link, law, rates) for link, law in dampers if law.c)


def _component(system: System, run: Run, link: Link, law: Any, rates: Mapping[str, float]) -> DamperComponent:
    C_s, K_ds = float(law.c), float(getattr(law, "K", inf))
    each = C_s / link.pieces
    force, displacement = of_damper(link.name, "force"), of_damper(link.name, "displacement")
    stroke = of_damper(link.name, "stroke") if isinstance(law, Maxwell) else displacement
    return DamperComponent(
        name=link.name,
        C_s=C_s,
        K_ds=K_ds,
        C_each=each,
        force_at_rated_velocity=each * RATED_VELOCITY,
        corner_frequency=K_ds / (2 * pi * C_s),
        hunting_frequency=run.frequency,
        at_hunting=None if run.frequency is None else dynamic_stiffness(law, run.frequency),
        over_frequency=tuple(dynamic_stiffness(law, f) for f in FREQUENCIES),
        **rates,
        speed=run.speed,
        force_rms=run.rms[force],
        force_peak=run.peak[force],
        stroke_rms=run.rms[stroke],
        stroke_peak=run.peak[stroke],
        velocity_rms=run.rms[force] / each,
        velocity_peak=run.peak[force] / each,
        checked=_same_in_the_vehicle(system, link, law),
    )


def _rigid(system: System) -> Vehicle:
    """Return the vehicle with joints of the yaw dampers that are as good as rigid."""
    p = system.vehicle.p
    return system.vehicle.replace(**{name: K * RIGID for name, K in p.items() if name.rpartition(".")[2] == "K_ds"})


def _coupled_decay_rate(vehicle: Vehicle) -> float:
    return float(decay_rate(motion_eigenvalues(vehicle, vehicle.model.motions[0])))


def dynamic_stiffness(law: Law, frequency: float) -> DynamicStiffness:
    """Return Z of a pair of dampers with a given law at a frequency [Hz]."""
    omega = 2 * pi * frequency
    Z = complex(evaluate(law.numerator, 1j * omega) / evaluate(law.denominator, 1j * omega))
    loss = Z.imag / Z.real if Z.real else inf
    return DynamicStiffness(frequency, abs(Z), atan2(Z.imag, Z.real), loss, Z.imag / omega)


def _same_in_the_vehicle(system: System, link: Link, law: Law) -> bool:
    omega = 2 * pi * np.array(FREQUENCIES)
    y = outputs(system, omega, system.wheelsets.harmonic(omega, "alignment"))
    u, found = (np.abs(y[:, system.outputs[of_damper(link.name, what)]]) for what in ("displacement", "pair force"))
    expected = [dynamic_stiffness(law, f).stiffness for f in FREQUENCIES] * u
    return bool(np.allclose(found, expected, rtol=EXACT, atol=0.0))
