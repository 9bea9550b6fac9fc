"""Forward design of the yaw damper: stable intervals, curving limit, golden section (eqs (11) to (15))."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.decision import decide
from yawdesign.damper.single_bogie import CONICITIES, SingleBogie, partings
from yawdesign.damper.status import Status
from yawdesign.hunting.critical_damping import CriticalDamping, CriticalValue, Interval, critical_damping
from yawdesign.hunting.routh import count_unstable
from yawdesign.hunting.scope import scope
from yawdesign.hunting.sensitivity import sensitivity
from yawdesign.hunting.verdict import stability_at
from yawdesign.problem import Curve, Problem
from yawdesign.problem.result import Result
from yawdesign.vehicle.vehicle import Vehicle


@dataclass(frozen=True)
class Critical(CriticalValue):
    """A critical value and the speed it belongs to.

    Parameters
    ----------
    speed : float
        Running speed [m/s].
    """

    speed: float


@dataclass(frozen=True, repr=False)
class ForwardDesign(Result):
    """Answer of the forward design.

    Parameters
    ----------
    critical : tuple of Critical
        All critical values, ascending at each speed.
    stable_intervals : tuple of (low, high)
        Open intervals of C_s [N s/m] that are stable at every speed; high is infinite where there is no limit.
    C_sl : float or None
        Lower end of the stable interval the design lies in [N s/m]; without a design that of the lowest interval.
    C_su : float or None
        What the curve allows, eq. (14) [N s/m].
    C_s : float or None
        Golden section 0.382 of the way from C_sl to C_su, or to the end of the stable interval if that is lower
        [N s/m].
    status : Status
        What kind of answer this is.
    message : str
        The same in a sentence, and what to do.
    stable : bool
        Whether that C_s is stable at every speed, by eigenvalues and by Routh's array.
    rotational_resistance : float or None
        T / (4 Q a) with that C_s [-].
    sensitivity : mapping
        d ln C_sl / d ln p [-] for every parameter p and the speed v.
    load : str or None
        The load that stands for Q in eq. (13): axle or wheel.
    checked : bool
        Whether the stable intervals were confirmed by two ways of counting roots.
    single_bogie : SingleBogie or None
        For a vehicle with a car body: what one of its bogies alone would have answered.
    scope : str
        What this answer does not hold; empty where a car body moves in it.
    """

    critical: tuple[Critical, ...]
    stable_intervals: tuple[Interval, ...]
    C_sl: float | None
    C_su: float | None
    C_s: float | None
    status: str
    message: str
    stable: bool
    rotational_resistance: float | None
    sensitivity: Mapping[str, float]
    load: str | None
    checked: bool
    single_bogie: SingleBogie | None = None
    scope: str = ""


def design(problem: Problem) -> ForwardDesign:
    """Return the forward design of a problem's yaw damper.

    Parameters
    ----------
    problem : Problem
        ``C_s`` need not be given; without a curve there may be no upper limit and so no choice.

    Examples
    --------
    >>> import yawdesign as yd
    >>> result = yd.design(yd.table1(equations="as-printed"))
    >>> round(result.C_sl, 3), round(result.C_su, 3), round(result.C_s)
    (90702.89, 2593442.982, 1046750)
    """
    return forward_design(Vehicle.of(problem), problem.curve)


def forward_design(vehicles: Sequence[Vehicle], curve: Curve | None) -> ForwardDesign:
    """Return the forward design of a vehicle; with a car body, what a single bogie would have answered stands in it.

    Parameters
    ----------
    vehicles : sequence of Vehicle
        It under each of its conditions; their own C_s is not looked at.
    curve : Curve or None
        What limits C_s.
    """
    found = _forward_design(vehicles, curve)
    if not vehicles[0].model.has_car_body:
        return found
    alone = _forward_design([vehicle.bogie for vehicle in vehicles], curve)
    fastest = max(vehicles, key=lambda vehicle: float(vehicle.v))
    beside = SingleBogie(
        C_sl=alone.C_sl,
        C_s=alone.C_s,
        stable_intervals=alone.stable_intervals,
        status=alone.status,
        stable=None if alone.C_s is None else _is_stable(vehicles, alone.C_s),
        partings=partings(fastest),
        searched=CONICITIES,
        speed=float(fastest.v),
    )
    return replace(found, single_bogie=beside)


def _forward_design(vehicles: Sequence[Vehicle], curve: Curve | None) -> ForwardDesign:
    found = [critical_damping(vehicle) for vehicle in vehicles]
    crossings = [(np.array([[x.C_s for x in sets.critical]]), np.array([sets.unstable_roots])) for sets in found]
    upper = None if curve is None else min(float(curving_limit(vehicle.p, curve)) for vehicle in vehicles)
    most = np.array([np.inf if upper is None else upper])
    decision = decide(crossings, most, np.array([others_stable(vehicles)]))
    C_sl, golden = (None if np.isnan(x[0]) else float(x[0]) for x in (decision.C_sl, decision.C_s))
    checked = all(sets.checked for sets in found) and (golden is None or _is_stable(vehicles, golden))
    status = Status.named(decision.status[0]) if checked else Status.UNVERIFIED
    C_s = golden if checked else None
    return ForwardDesign(
        critical=tuple(
            _at_speed(x, vehicle) for sets, vehicle in zip(found, vehicles, strict=True) for x in sets.critical
        ),
        stable_intervals=decision.stable_intervals(0),
        C_sl=C_sl,
        C_su=upper,
        C_s=C_s,
        status=status,
        message=status.message,
        stable=C_s is not None,
        rotational_resistance=resistance(vehicles, C_s, curve),
        sensitivity=_sensitivity(vehicles, found, C_sl),
        load=None if curve is None else curve.load,
        checked=checked,
        scope=scope(vehicles),
    )


def others_stable(vehicles: Iterable[Vehicle]) -> bool:
    """Return whether all motions that no yaw damper reaches are stable; no C_s can help there."""
    others = [motion for vehicle in vehicles for motion in vehicle.motions if not motion.varied]
    return all(count_unstable(motion.polynomial(0)) == 0 for motion in others)


def _at_speed(x: CriticalValue, vehicle: Vehicle) -> Critical:
    return Critical(x.C_s, x.omega, x.becomes, x.residual, float(vehicle.v))


def _is_stable(vehicles: Iterable[Vehicle], C_s: float) -> bool:
    """Return whether the eigenvalues and Routh's array confirm a design that lies in a stable interval."""
    verdicts = [stability_at(vehicle.replace(C_s=C_s)) for vehicle in vehicles]
    return all(x.stable and x.checked for x in verdicts)


def resistance(vehicles: Sequence[Vehicle], C_s: float | None, curve: Curve | None) -> float | None:
    """Return the largest T / (4 Q a) [-] of a vehicle under its conditions, where there is one."""
    if C_s is None or curve is None or not all(vehicle.p["W"] for vehicle in vehicles):
        return None
    return max(float(rotational_resistance(vehicle.p, C_s, curve)) for vehicle in vehicles)


def _sensitivity(vehicles: Sequence[Vehicle], found: Sequence[CriticalDamping], C_sl: float | None) -> dict[str, float]:
    for sets, vehicle in zip(found, vehicles, strict=True):
        for x in sets.critical:
            if x.C_s == C_sl:
                return sensitivity(vehicle, x.C_s, x.omega)
    return {}
