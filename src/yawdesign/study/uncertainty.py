"""The probability of instability of a problem whose parameters are uncertain, and which of them matter."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Array
from yawdesign.hunting.scope import conditions_told
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress
from yawdesign.problem.conditions import ConditionSet
from yawdesign.problem.result import Result
from yawdesign.problem.table import as_count, as_seed
from yawdesign.study.answers import evaluate
from yawdesign.study.local_effects import Effect, as_designed
from yawdesign.study.probability import draws, percentiles, probability_unstable
from yawdesign.study.replicates import UncertainVehicle, Workers, workers_of
from yawdesign.study.request import Question, remaining
from yawdesign.study.samples import REPLICATES, Draw, Estimate, Indices, Uncertain

SAMPLES = 2**20
MOST_VERDICTS = 2**22  # samples times conditions, where no number of samples is asked for
FEWEST, MOST = 2**10, 2**28  # samples that may be asked for
LEVELS = (1, 5, 50, 95, 99)  # percentiles
MOST_CONDITIONS = 50  # those inside ranges among them; with long lists there may be more
PERCENTILES_FROM = 2**15  # samples
BASE, COMPARED = 2**8, 625  # of each replicate: points of the indices, verdicts beside eigenvalues
SLOWER = 8  # so many times longer take the margins of a vehicle with a car body
EARLY = 0.25  # of the margins under several conditions are computed, the others surely exceed the least so far
USELESS = 0.2  # half the interval of an index that tells nothing
DOUBTFUL = 1e-3  # share of samples without a verdict with which a result is no longer verified


@dataclass(frozen=True)
class SobolIndex:
    """Which share of the variance of the margin a parameter has.

    Parameters
    ----------
    first, total : float or None
        Alone, and together with the others [-]; None where the interval is so wide that the number tells nothing.
    first_error, total_error : float or None
        Half the 95 % intervals [-].
    """

    first: float | None
    total: float | None
    first_error: float | None
    total_error: float | None


@dataclass(frozen=True, repr=False)
class Uncertainty(Result):
    """How likely a vehicle with uncertain parameters is unstable.

    Parameters
    ----------
    probability_unstable : float or None
        Probability [-] that it is unstable under at least one of the conditions that stay; None where the samples
        cannot tell it.
    interval : tuple of (low, high)
        95 % interval of it [-].
    samples : int
        How many samples were judged.
    percentiles : mapping
        Of the ``margin`` of the problem's objective [1/s] or [-] and of ``C_sl`` [N s/m], by the level in percent;
        None where no C_s is stable.
    sobol : mapping name -> SobolIndex
        Of the margin.
    stable : bool
        Whether it is stable as designed.
    objective : str
        Of the margin: ``decay_rate`` or ``damping_ratio``.
    margin : float
        As designed [1/s] or [-].
    worst_condition : mapping
        The condition that stays under which that is so.
    effects : mapping name -> Effect
        What each parameter does at the values as designed.
    failures : int
        How many of the samples are unstable, with widened distributions where failures are rare.
    unverified : int
        How many of the samples have no verified verdict; they widen the interval.
    status : str
        ``estimated``, ``rare`` or ``too few failures``.
    method : str
        How the probability was found, in words.
    conditions : int
        Under how many conditions each sample is judged.
    held_under : str
        The same in words.
    percentiles_from, sobol_from : int
        How many samples the percentiles, and evaluations of the margin the indices come from.
    quantiles : mapping
        ``margin`` and ``C_sl`` at 0, 1, ..., 100 percent, for pictures [SI].
    compared, differences : int
        How many verdicts were compared with eigenvalues, and how many differ.
    checked : bool
        Whether none differs, and nearly all samples have a verdict.
    seed : int
        Of the samples.
    """

    probability_unstable: float | None
    interval: tuple[float, float]
    samples: int
    percentiles: Mapping[str, Mapping[str, float | None]]
    sobol: Mapping[str, SobolIndex]
    stable: bool
    objective: str
    margin: float
    worst_condition: Mapping[str, Any]
    effects: Mapping[str, Effect]
    failures: int
    unverified: int
    status: str
    method: str
    conditions: int
    held_under: str
    percentiles_from: int
    sobol_from: int
    quantiles: Mapping[str, tuple[float | None, ...]]
    compared: int
    differences: int
    checked: bool
    seed: int

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        quantiles = {"percent": list(range(101)), **self.quantiles}
        return {**super()._tables(), "quantiles": quantiles}

    def _units(self) -> Mapping[str, str]:
        return {"margin": "1/s" if self.objective == "decay_rate" else "-"}


def uncertainty(
    problem: Problem,
    *,
    samples: int | None = None,
    seed: int = 0,
    executor: Any = None,
    progress: Progress = lambda text, part: None,
) -> Uncertainty:
    """Return how likely the vehicle of a problem is unstable, with the yaw damping written in it.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s`` and with ``uncertainty``. A distribution replaces the condition of its name, its
        tolerance too; a sample is unstable if it is under any of the other conditions. Of ranges that stay, the ends
        and some values between are looked at.
    samples : int, optional
        How many; rounded up to 16 times a power of two. By default 2**20, fewer with many conditions.
    seed : int
        Of the samples; with the same seed the answer is the same, whoever computes.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who computes; by default the threads of this process.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    Uncertainty

    Raises
    ------
    ProblemError
        If the problem has no ``uncertainty`` or no ``C_s``.

    Examples
    --------
    >>> import yawdesign as yd
    >>> distributions = {"lambda": {"uniform": [0.05, 0.4]}, "creep_factor": {"uniform": [0.5, 1]}}
    >>> problem = yd.table1().replace(C_s=1046770, uncertainty=distributions)
    >>> yd.uncertainty(problem, samples=2**10).status
    'estimated'
    """
    given_damping(problem)
    if not problem.uncertainty:
        raise ProblemError("uncertainty is missing: give distributions, such as lambda: {uniform: [0.05, 0.40]}")
    seed = as_seed(seed) or 0
    vehicle = judged_vehicle(problem)
    asked = _samples(samples, len(vehicle.question.conditions))
    with workers_of(executor, progress) as workers:
        return _found(workers, problem, vehicle, asked, seed)


def left(problem: Problem) -> ConditionSet:
    """Return the conditions that no distribution replaces."""
    return remaining(problem, "stable", [one.key for one in problem.uncertainty])


def judged_vehicle(problem: Problem) -> UncertainVehicle:
    """Return the vehicle of a problem with its uncertain parameters, and the conditions under which it is judged."""
    p = {name: float(value) for name, value in problem.parameters().items()}
    for one in problem.uncertainty:
        if one.key == "v":
            single = len(problem.speeds) == 1
            p["v"] = float(problem.speeds[0] if single else sum(one.ends(0.0)) / 2)
    question = replace(Question.about(problem, "stable"), conditions=left(problem).grid(MOST_CONDITIONS))
    return UncertainVehicle(question, Uncertain(p, problem.uncertainty))


def _samples(asked: int | None, conditions: int) -> int:
    if asked is None:
        return max(2**14, min(SAMPLES, _power(MOST_VERDICTS // conditions)))
    try:
        wanted = as_count(asked, FEWEST, MOST)
    except ProblemError as error:
        raise error.under("samples") from None
    return REPLICATES * (1 << (-(-wanted // REPLICATES) - 1).bit_length())


def _power(n: float) -> int:
    """Return the largest power of two that is not larger."""
    return 1 << (max(1, int(n)).bit_length() - 1)


def _found(workers: Workers, problem: Problem, vehicle: UncertainVehicle, samples: int, seed: int) -> Uncertainty:
    objective, conditions = problem.design.objective, len(vehicle.question.conditions)
    slower = max(1.0, conditions * EARLY) * (SLOWER if problem.car_body else 1)
    stable = bool(evaluate(vehicle.question, vehicle.uncertain.parameters).columns["stable"][0])
    designed = as_designed(vehicle, objective)
    probability = probability_unstable(workers.within(0.0, 0.3), vehicle, samples, seed)
    replicates = draws(vehicle, samples, seed)
    some = min(replicates[0].size, max(2**5, _power(PERCENTILES_FROM / REPLICATES / slower)))
    values = {"margin": objective, "C_sl": "C_sl"}
    parts = (workers.within(0.3, 0.5), workers.within(0.5, 0.7))
    answers = (_answers(part, vehicle, of, replicates, some) for part, of in zip(parts, values.values(), strict=True))
    columns = dict(zip(values, answers, strict=True))
    compared = min(replicates[0].size, COMPARED // (SLOWER if problem.car_body else 1))
    differences = sum(
        workers.within(0.7, 0.9).all("eigenvalues", vehicle.differing, [(draw, compared) for draw in replicates])
    )
    base, d = min(replicates[0].size, max(2**4, _power(BASE / slower))), len(problem.uncertainty)
    return Uncertainty(
        probability_unstable=probability.value,
        interval=probability.interval,
        samples=probability.samples,
        percentiles={
            name: dict(zip(map(str, LEVELS), percentiles(x, LEVELS), strict=True)) for name, x in columns.items()
        },
        sobol=_sobol(workers.within(0.9, 1.0), vehicle, objective, base, seed),
        stable=stable,
        objective=objective,
        margin=designed.margin,
        worst_condition=designed.condition.described,
        effects=designed.effects,
        failures=probability.failures,
        unverified=probability.unverified,
        status=probability.status,
        method=probability.method,
        conditions=conditions,
        held_under=_told(left(problem), conditions),
        percentiles_from=REPLICATES * some,
        sobol_from=REPLICATES * base * (d + 2),
        quantiles={name: percentiles(x, range(101)) for name, x in columns.items()},
        compared=REPLICATES * compared,
        differences=differences,
        checked=differences == 0 and probability.unverified <= DOUBTFUL * samples,
        seed=seed,
    )


def _answers(workers: Workers, vehicle: UncertainVehicle, of: str, replicates: Sequence[Draw], some: int) -> Array:
    jobs = [(of, draw, some) for draw in replicates]
    return np.concatenate(workers.all("percentiles", vehicle.answered, jobs))


def _told(conditions: ConditionSet, number: int) -> str:
    """Return in words under which conditions each sample is judged."""
    if not conditions.ranges:
        return conditions_told(conditions)
    names = ", ".join("speed" if name == "v" else name for name, _ in conditions.ranges)
    return f"{number} conditions, with some values of the range of {names}, the ends among them"


def _sobol(workers: Workers, vehicle: UncertainVehicle, objective: str, base: int, seed: int) -> dict[str, SobolIndex]:
    jobs = [(objective, base, (seed, 3, k)) for k in range(REPLICATES)]
    found: list[Indices] = workers.all("Sobol indices", vehicle.indices, jobs)
    each = enumerate(vehicle.uncertain.distributions)
    return {
        one.name: _index(Estimate.of([x.first[k] for x in found]), Estimate.of([x.total[k] for x in found]))
        for k, one in each
    }


def _index(first: Estimate, total: Estimate) -> SobolIndex:
    numbers = [x.value if x.half_width <= USELESS else None for x in (first, total)]
    errors = [x.half_width if np.isfinite(x.half_width) else None for x in (first, total)]
    return SobolIndex(*numbers, *errors)
