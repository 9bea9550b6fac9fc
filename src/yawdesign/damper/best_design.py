"""The best design of a space under all conditions: dense search, IPOPT, polish; conditions added while one is worse.

Of ranges the corners are known first. The worst condition of the best design is looked for inside them and added, and
the best design is looked for anew, until none is worse; then everything is searched once more with all that are known.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from yawdesign.damper.design_space import Space
from yawdesign.damper.local_nlp import LocalImprover
from yawdesign.damper.nlp import Improver
from yawdesign.damper.search import search
from yawdesign.damper.stencils import distinct, refine
from yawdesign.hunting.arrays import Float
from yawdesign.problem.arguments import Progress
from yawdesign.problem.progress import between, rounds, unseen

APART = 1e-3  # how far starts of the NLP must be from a better one
MOST_REFINED = 8  # points after each turn of the NLP
TURNS = ((6, 1e-3), (2, 1e-5))  # number of starts of the NLP, radius of the refinement after it
MOST_SEARCHES = 9  # in five variables and more; what these miss, other seeds may find
MOST_FACTORED = 30  # degree of polynomials; with that of a vehicle no start of the NLP of their factors converged
MOST_ROUNDS = 60  # in which conditions are added
POOL = 5  # points that are refined anew when conditions are added

Turns = Sequence[tuple[int, float]]
Map = Callable[..., Any]  # as the built-in map: an executor's spreads the searches


def best_design(
    space: Space,
    seed: int,
    options: Mapping[str, Any],
    progress: Progress,
    spread: Map = map,
    turns: Turns = TURNS,
) -> tuple[Space, Float]:
    """Return the best point of a design space, and the space with all conditions that decide it.

    Without requirements first: where that design meets them, they decide nothing. Not so where the search begins near
    a design that meets them.

    Parameters
    ----------
    space : Space
        With the conditions that are looked at first.
    seed : int
        Of the search points.
    options : mapping
        Of CasADi's `nlpsol`.
    progress : callable
        Called with a text and the share that is done.
    spread : callable, optional
        Like `map`; it may compute in other processes.
    turns : sequence of (int, float), optional
        How often the NLP and a refinement follow each other: the number of starts and the radius of each turn.
    """
    if not space.demands or space.near is not None:
        return _best_of_all(space, seed, options, progress, spread, turns)
    alone = replace(space, demanding=False, known=space.known[:1])
    free, x = _best_of_all(alone, seed, options, between(progress, 0.0, 0.5), spread, turns)
    asked: Space | None = replace(free, demanding=True, known=(free.conditions, *space.known[1:]))
    while asked is not None and asked.meets(x):
        space, asked = asked, asked.with_worst(x)
    if asked is None:
        return space, x
    values = asked.values(x)
    anchor = {name: float(np.squeeze(values[name])) for name in asked.names}
    known = replace(asked, anchors_given=(*asked.anchors_given, anchor))
    return _best_of_all(known, seed, options, between(progress, 0.5, 1.0), spread, turns)


def _best_of_all(
    space: Space, seed: int, options: Mapping[str, Any], progress: Progress, spread: Map, turns: Turns
) -> tuple[Space, Float]:
    every_round = rounds(progress)
    pool = searched(space, seed, next(every_round), spread)
    x, at_search, polished = pool[:, 0], space, False
    for _, told in zip(range(MOST_ROUNDS), every_round, strict=False):
        more = space.with_worst(x)
        if more is not None:
            space = more
            told(f"best design under {len(space.conditions)} conditions", 0.0)
            pool = _refined(space, np.concatenate([x[:, None], pool[:, :POOL]], axis=1), seed)
            x, polished = pool[:, 0], False
        elif polished:
            break
        else:
            if at_search is not space:
                again = searched(space, seed, between(told, 0.0, 0.5), spread)
                pool, at_search, told = np.concatenate([x[:, None], again], axis=1), space, between(told, 0.5, 1.0)
            x, polished = _best(space, pool, seed, options, told, turns), True
    return space, x


def _refined(space: Space, x: Float, seed: int) -> Float:
    rng = np.random.default_rng(seed)
    margin = space.margins_at(x)
    order = distinct(x, margin, np.full(len(margin), APART))
    return refine(space, x[:, order], margin[order], rng, radius=0.1, until=1e-4, rounds=25, points=96)


def searches(space: Space) -> int:
    """Return how many independent searches are made: what one cannot sample densely, several must not miss."""
    return 1 if space.near is not None else min(max(1, 4 * len(space.names) - 11), MOST_SEARCHES)


def searched(space: Space, seed: int, progress: Progress, spread: Map = map) -> Float:
    """Return refined points of a design space, shape (variables, points)."""
    count = searches(space)
    if count == 1:
        return search(space, seed, progress)
    found = spread(_search, [space] * count, range(seed, seed + count))
    parts = []
    for k, part in enumerate(found):
        progress("searching the design space", k / count)
        parts.append(part)
    return np.concatenate(parts, axis=1)


def _search(space: Space, seed: int) -> Float:
    return search(space, seed, unseen)


def _best(space: Space, x: Float, seed: int, options: Mapping[str, Any], progress: Progress, turns: Turns) -> Float:
    """Return the best point after IPOPT and refinement in turn: each leaves the ridges on which the other stops."""
    rng, margin, improvers = np.random.default_rng(seed), space.margins_at(x), _improvers(space, options)
    order = distinct(x, margin, np.full(len(margin), APART))  # several searches find the same
    x, margin = x[:, order], margin[order]
    # Local optima multiply with the variables; models come from farther, and take longer.
    tried: set[bytes] = set()
    more = 1 if isinstance(improvers[0], LocalImprover) else searches(space)
    for turn, (starts, radius) in enumerate(turns):
        told = between(progress, turn / len(turns), (turn + 1) / len(turns))
        starts = min(starts * more, x.shape[1])
        chosen = [(x[:, k], float(margin[k])) for k in range(starts) if x[:, k].tobytes() not in tried]
        tried |= {start.tobytes() for start, _ in chosen}
        tasks = [(improver, start) for improver in improvers for start in chosen]
        reached = []
        for k, (improver, start) in enumerate(tasks):
            told("solving the NLP", k / len(tasks))
            reached += [y[:, None] for y in improver.improve(*start)]
        x = np.concatenate([x, *reached], axis=1)
        margin = space.margins_at(x)
        order = np.argsort(-margin, kind="stable")[:MOST_REFINED]
        x = refine(space, x[:, order], margin[order], rng, radius=radius, until=1e-11, rounds=30)
        margin = space.margins_at(x)
    return x[:, 0]


def _improvers(space: Space, options: Mapping[str, Any]) -> list[Improver | LocalImprover]:
    """Return the NLP of whole polynomials and that of models.

    Models serve where coefficients of so high a degree say too little, and where requirements are to be met: these the
    NLP of polynomials does not know, and reaches a point that is no good where they decide.
    """
    coupled, states = space.model.motions[0], space.model.states
    large = len(states.states_of(coupled.coordinates)) > MOST_FACTORED
    by_models = [LocalImprover(space, options)] if space.pairs or large or space.demands else []
    return [*by_models, *([] if space.pairs or large else [Improver(space, options)])]
