"""What is asked of uncertain vehicles, replicate by replicate; a worker gets a few kilobytes for each."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from yawdesign.hunting.arrays import Array, Float
from yawdesign.hunting.many import margins
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.arguments import as_executor
from yawdesign.problem.progress import between
from yawdesign.study.answers import evaluate
from yawdesign.study.request import Question
from yawdesign.study.samples import Draw, Indices, Uncertain, sobol_indices


@dataclass(frozen=True)
class Counted:
    """How many samples of a replicate are unstable.

    Parameters
    ----------
    size, unstable, unverified : int
        Numbers of samples; of those without a verified verdict none counts as unstable.
    weight, squared : float
        Sum of the weights of the unstable ones, and of their squares.
    """

    size: int
    unstable: int
    unverified: int
    weight: float
    squared: float


@dataclass(frozen=True)
class UncertainVehicle:
    """A vehicle with uncertain parameters, and the conditions that stay; plain data for other processes.

    Parameters
    ----------
    question : Question
        Of its stability, under all conditions that stay.
    uncertain : Uncertain
        Its parameters.
    """

    question: Question
    uncertain: Uncertain

    def counted(self, draw: Draw, widened: float) -> Counted:
        """Return how many samples are unstable, with distributions that are widened or not."""
        found = []
        for u in draw.parts():
            answers = evaluate(self.question, self.uncertain.at(u, widened), threads=1)
            unstable = ~answers.columns["stable"].astype(bool) & ~answers.unverified
            w = self.uncertain.weights(u[unstable], widened)
            found.append((len(u), unstable.sum(), answers.unverified.sum(), w.sum(), (w * w).sum()))
        size, unstable, unverified, weight, squared = np.sum(found, axis=0)
        return Counted(int(size), int(unstable), int(unverified), float(weight), float(squared))

    def answered(self, of: str, draw: Draw, some: int) -> Array:
        """Return the answers to a question at the first few points of a replicate; NaN where there is none."""
        u = next(draw.parts())[:some]
        return evaluate(replace(self.question, of=of), self.uncertain.at(u), threads=1).columns[of]

    def differing(self, draw: Draw, some: int) -> int:
        """Return how many verdicts on the first few points of a replicate differ from eigenvalues.

        Each of the points is looked at under one of the conditions, in turn.
        """
        p, conditions = self.uncertain.at(next(draw.parts())[:some]), self.question.conditions
        different = 0
        for k, condition in enumerate(conditions):
            own = slice(k, None, len(conditions))
            here = {name: x[own] if np.ndim(x) else x for name, x in p.items()}
            sets = ParameterSets(self.question.model, condition.applied(here), len(range(some)[own]))
            if sets.size:
                yes, sure = margins.stable(sets)
                by_eigenvalues = Measure("decay_rate", self.question.model.parameters).of(sets) > 0
                different += int((sure & (yes != by_eigenvalues)).sum())
        return different

    def indices(self, of: str, size: int, seed: tuple[int, ...]) -> Indices:
        """Return the Sobol indices of a margin from one replicate; see `sobol_indices`."""

        def margin(u: Float) -> Float:
            return np.asarray(evaluate(replace(self.question, of=of), self.uncertain.at(u), threads=1).columns[of])

        return sobol_indices(margin, len(self.uncertain.distributions), size, seed)


class Workers:
    """Those who answer: threads of this process, or an executor.

    Parameters
    ----------
    executor : Executor
        Who computes.
    done : callable
        Called with a text and the share that is done of all.
    """

    def __init__(self, executor: Executor, done: Callable[[str, float], Any]) -> None:
        self.executor, self.done = executor, done

    def within(self, low: float, high: float) -> Self:
        """Return the same workers, whose work is that between two shares of the whole."""
        return type(self)(self.executor, between(self.done, low, high))

    def all(self, text: str, function: Callable[..., Any], jobs: Sequence[tuple[Any, ...]]) -> list[Any]:
        """Return what a function returns for each job, in their order."""
        futures = [self.executor.submit(function, *job) for job in jobs]
        found = []
        try:
            for k, future in enumerate(futures):
                self.done(text, k / len(futures))
                found.append(future.result())
        finally:
            for future in futures[len(found) :]:
                future.cancel()
        return found


@contextmanager
def workers_of(executor: Any, done: Callable[[str, float], Any]) -> Iterator[Workers]:
    """Give those who answer: an executor or dask client, or one thread for every core."""
    if executor is not None:
        yield Workers(as_executor(executor), done)
        return
    with ThreadPoolExecutor(os.cpu_count() or 1) as threads:
        yield Workers(threads, done)
