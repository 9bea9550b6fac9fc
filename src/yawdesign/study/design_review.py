"""Everything that a design review asks of a problem, each answered once by the function that answers it alone."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from yawdesign.damper.candidates import Choice
from yawdesign.damper.choose import choose
from yawdesign.damper.forward import ForwardDesign
from yawdesign.damper.optimise import optimise
from yawdesign.damper.optimum import Optimum
from yawdesign.damper.pareto_front import TradeOff
from yawdesign.damper.scored_rows import with_damper
from yawdesign.damper.trade_off import IncompleteTradeOffError, trade_off
from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.chosen_condition import AS_WRITTEN, WORST
from yawdesign.hunting.critical_speed import CriticalSpeeds, critical_speed
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.stability import stability
from yawdesign.hunting.verdict import Stability
from yawdesign.problem import Problem
from yawdesign.problem.arguments import Progress
from yawdesign.problem.conditions import condition_set
from yawdesign.problem.quantities import Written
from yawdesign.response.modes.followed_modes import FollowedModes, follow_modes
from yawdesign.response.modes.named_modes import Modes, modes
from yawdesign.response.run.simulate import Simulation, simulate
from yawdesign.study import review_axes
from yawdesign.study.result import Sweep
from yawdesign.study.sweep import IncompleteSweepError, swept
from yawdesign.study.uncertainty import Uncertainty, uncertainty

POINTS = 12  # of the front
FOLLOWED, CHART, MAP, BODY = 81, (81, 121), 41, 25  # values of an axis; with a car body maps are coarser
COARSE = 17
SAMPLES = 2**17  # of uncertain parameters
DURATION = 20.0  # of the run [s]

T = TypeVar("T")


@dataclass(frozen=True)
class ConditionMargins:
    """What a design has under one condition.

    Parameters
    ----------
    condition : mapping
        By the names of the problem file: ``speed`` [m/s], others in SI units, a load by its name.
    decay_rate, damping_ratio : float
        Over the modes that a design variable moves [1/s], [-].
    """

    condition: Mapping[str, Any]
    decay_rate: float
    damping_ratio: float


@dataclass(frozen=True, eq=False)
class DesignReview:
    """The answers to a problem that a design review wants to see; None where what they need is not in it.

    Parameters
    ----------
    problem : Problem
        As written.
    optimum : Optimum
        The best design.
    design : Problem or None
        The problem with the design that is handed in: the optimum, or the best that was found; where nothing was, the
        design as written. None where that has no yaw damping.
    forward : ForwardDesign
        The forward design with the bogie of that design.
    before, after : Stability or None
        Of the problem as written, and of the design.
    each_condition : tuple of ConditionMargins
        Of the design, the worst first: every condition of lists, of ranges some and the worst that a search found.
    critical_speed : CriticalSpeeds or None
        Of the design.
    paths : FollowedModes or None
        Its modes over the speed, under its worst condition.
    chart : Sweep or None
        What is stable, over speed and yaw damping.
    wear : Sweep or None
        Its margin over conicity and creep.
    mounts : Sweep or None
        Its margin over frequency and damping of the motor suspension.
    front : TradeOff or None
        Margin against rotational resistance.
    choice : Choice or None
        The dampers of the catalogue.
    uncertainty : Uncertainty or None
        Of the design, with the distributions of the problem.
    modes : Modes or None
        Of the design under its worst condition.
    run : Simulation or None
        Of the design over a track, under its worst condition.
    with_body, without_body : Sweep or None
        The least stable yaw damping over the conicity, of a vehicle and of one of its bogies below a car body that
        stands still.
    seconds : mapping
        Of processor time, by part [s].
    """

    problem: Problem
    optimum: Optimum
    forward: ForwardDesign
    design: Problem | None = None
    before: Stability | None = None
    after: Stability | None = None
    each_condition: tuple[ConditionMargins, ...] = ()
    critical_speed: CriticalSpeeds | None = None
    paths: FollowedModes | None = None
    chart: Sweep | None = None
    wear: Sweep | None = None
    mounts: Sweep | None = None
    front: TradeOff | None = None
    choice: Choice | None = None
    uncertainty: Uncertainty | None = None
    modes: Modes | None = None
    run: Simulation | None = None
    with_body: Sweep | None = None
    without_body: Sweep | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)


def design_review(
    problem: Problem, *, executor: Any = None, progress: Progress = lambda text, part: None
) -> DesignReview:
    """Return everything that a design review asks of a problem.

    Parameters
    ----------
    problem : Problem
        With ``C_s`` as a design variable, or with its value.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who computes the optimum, the front, the catalogue and the samples; by default this process.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Raises
    ------
    ProblemError
        If C_s is neither given nor a design variable.
    """
    told = _Told(progress)
    optimum = told("the best design", 0.3, lambda part: optimise(problem, executor=executor, progress=part))
    found: dict[str, Any] = {"problem": problem, "optimum": optimum, "forward": optimum.forward}
    if problem.design.catalogue:
        found["choice"] = told("the catalogue", 0.05, lambda part: choose(problem, executor=executor, progress=part))
    elif problem.curve is not None:
        front = told(
            "margin against resistance",
            0.45,
            lambda part: trade_off(problem, points=POINTS, executor=executor, progress=part),
        )
        found["front"] = front if front.front else None
    if problem.bogie.C_s is not None:
        found["before"] = stability(problem)
    handed_in = designed(problem, optimum)
    if handed_in is not None:
        found |= _of_design(handed_in, optimum, told)
        if problem.uncertainty:
            found["uncertainty"] = told(
                "uncertain parameters",
                0.05,
                lambda part: uncertainty(handed_in, samples=SAMPLES, executor=executor, progress=part),
            )
    progress("done", 1.0)
    return DesignReview(**found, seconds=told.seconds)


def designed(problem: Problem, optimum: Optimum) -> Problem | None:
    """Return the problem with the design that is handed in; None where there is none."""
    if optimum.margin is None:
        return problem if problem.bogie.C_s is not None else None
    if optimum.damper is not None:
        problem = with_damper(problem, next(x for x in problem.design.catalogue if x.name == optimum.damper))
    return problem.replace(**{name: bound.value for name, bound in optimum.bounds.items()})


class _Told:
    """Tells how far the whole is while its parts are computed, and how long each took."""

    def __init__(self, progress: Progress) -> None:
        self.progress, self.done, self.shown = progress, 0.0, 0.0
        self.seconds: dict[str, float] = {}

    def __call__(self, name: str, share: float, work: Callable[[Progress], T]) -> T:
        begin, clock = self.done, time.process_time()

        def told(text: str, part: float) -> None:
            self.shown = max(self.shown, begin + share * min(max(part, 0.0), 1.0))  # it never goes back
            self.progress(f"{name}: {text}" if text else name, self.shown)

        told("", 0.0)
        try:
            answer = work(told)
        except (IncompleteSweepError, IncompleteTradeOffError) as error:  # of a review nothing is kept
            raise error.__cause__ or error from None
        self.done += share
        self.seconds[name] = time.process_time() - clock
        return answer


def _of_design(problem: Problem, optimum: Optimum, told: _Told) -> dict[str, Any]:
    """Return what is asked of the design that is handed in."""
    after = stability(problem)
    one = condition_set(problem).is_one
    which: Any = AS_WRITTEN if one else WORST
    found: dict[str, Any] = {
        "design": problem,
        "after": after,
        "each_condition": told("every condition", 0.01, lambda part: each_condition(problem)),
        "critical_speed": told("critical speeds", 0.02, lambda part: critical_speed(problem)),
        "paths": told("modes over the speed", 0.02, lambda part: _paths(problem, after.worst_condition)),
        "modes": told("modes", 0.01, lambda part: modes(problem, condition=which)),
        "run": told(
            "run over a track",
            0.02,
            lambda part: simulate(problem, duration=DURATION, condition=which, progress=part),
        ),
    }
    return found | _maps(problem, optimum, told) | _beside_one_bogie(problem, told)


def each_condition(problem: Problem) -> tuple[ConditionMargins, ...]:
    """Return the margins of a design under each condition, the least decay rate first.

    Of ranges these are the ends, some speeds, and the worst that a search found.
    """
    p = {name: float(value) for name, value in problem.parameters().items()}
    judged = Judged(problem, p)
    every = tuple(dict.fromkeys((*judged.conditions.first_look, *judged.looked)))
    sets = under_conditions(judged.model, judged.p, [(condition, 1) for condition in every])
    variables = tuple(problem.design.variables)
    rates, ratios = (Measure(of, variables).of(sets) for of in ("decay_rate", "damping_ratio"))
    rows = (
        ConditionMargins(condition.described, float(rate), float(ratio))
        for condition, rate, ratio in zip(every, rates, ratios, strict=True)
    )
    return tuple(sorted(rows, key=lambda row: row.decay_rate))


def _paths(problem: Problem, worst: Mapping[str, Any]) -> FollowedModes:
    condition = {name: value for name, value in worst.items() if name != "speed"}
    at = problem.replace(speed=Written(worst["speed"]))
    return follow_modes(at, condition=condition or AS_WRITTEN, v=review_axes.speeds(problem, FOLLOWED))


def _maps(problem: Problem, optimum: Optimum, told: _Told) -> dict[str, Any]:
    objective, cells = problem.design.objective, MAP if problem.car_body is None else COARSE
    marks = [x for x in (optimum.C_su, optimum.forward.C_sl, problem.bogie.C_s) if x is not None]
    rows, columns = CHART if problem.car_body is None else (COARSE, 2 * COARSE)
    chart = {"v": review_axes.speeds(problem, rows), "C_s": review_axes.dampings(problem, marks, columns)}
    wear = {
        "lambda": review_axes.conicities(problem, cells),
        "creep_factor": review_axes.creep_factors(problem, cells),
    }
    found = {
        "chart": told(
            "speed and yaw damping", 0.03, lambda part: swept(problem, "stable", chart.items(), progress=part)
        ),
        "wear": told("conicity and creep", 0.03, lambda part: swept(problem, objective, wear.items(), progress=part)),
    }
    if problem.bogie.kind == "power" and problem.parameters()["K_m"]:  # without it there is no frequency
        axes = review_axes.mounts(problem, cells)
        found["mounts"] = told(
            "motor mounts", 0.03, lambda part: swept(problem, objective, axes.items(), progress=part)
        )
    return found


def _beside_one_bogie(problem: Problem, told: _Told) -> dict[str, Any]:
    """Return the least stable damping over the conicity with and without the car body, where there is one."""
    alone = problem.of_one_bogie
    if alone is None:
        return {}
    axis = review_axes.conicities(problem, BODY)

    def least(of: Problem) -> Callable[[Progress], Sweep]:
        return lambda part: swept(of, "C_sl", {"lambda": axis}.items(), progress=part)

    return {
        "with_body": told("with the car body", 0.02, least(problem)),
        "without_body": told("without the car body", 0.01, least(alone)),
    }
