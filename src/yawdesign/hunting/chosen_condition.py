"""Under which condition a vehicle is looked at: the values as written, the worst condition of all, or a given one.

What shows one vehicle in motion needs one condition. With it in its values a problem has no conditions any more, so
that everything that takes a problem takes this one too. What no condition touches keeps its written decimals.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import PARAMETERS, Problem, ProblemError, Written, exact
from yawdesign.problem.condition import CREEP_FACTOR, TOLERANCE, Condition, Conditions, Load
from yawdesign.problem.condition_texts import change_text
from yawdesign.problem.diagnostics import Mistakes, suggestion, unknown_key
from yawdesign.problem.outside_the_model import answer_to
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_quantity, key_of, shown
from yawdesign.problem.written_conditions import MOST_TOLERANCE

AS_WRITTEN, WORST, GIVEN = "as written", "worst", "given"
VALUES = "values"  # the key in a result's `condition` that says which of them it is
_WORDS = {AS_WRITTEN: "values as written, at ", WORST: "worst condition: ", GIVEN: "condition: "}

Asked = str | Mapping[str, Any]


@dataclass(frozen=True)
class Chosen:
    """A problem under one condition.

    Parameters
    ----------
    problem : Problem
        With the condition in its values, and without conditions.
    speeds : tuple of float
        The speeds that are asked for [m/s]: one, unless the values are as written or the condition names none.
    values : {"as written", "worst", "given"}
        Which condition it is.
    changes : mapping
        The condition without its speed, as in `described`.
    """

    problem: Problem
    speeds: tuple[float, ...]
    values: str
    changes: Mapping[str, Any]

    def described(self, speed: float | None = None, without: str = "") -> dict[str, Any]:
        """Return the condition by the names of a problem file, and under ``values`` which one it is.

        Parameters
        ----------
        speed : float, optional
            The one to which a result belongs [m/s].
        without : str
            A parameter that has other values in a result.
        """
        at = {} if speed is None else {"speed": float(speed)}
        changes = {name: value for name, value in self.changes.items() if name != without}
        return {VALUES: self.values, **at, **changes}


def chosen(problem: Problem, condition: Asked = AS_WRITTEN, speeds: Sequence[float] = ()) -> Chosen:
    """Return a problem under one condition.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``, where the worst condition is asked for.
    condition : str or mapping
        ``"as written"``; ``"worst"``, that of the least margin, as the objective of the problem has it, or, where the
        vehicle is unstable, of the greatest growth of any mode; or values by name, such as ``{"lambda": 0.4,
        "creep_factor": 0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``.
    speeds : sequence of float
        Speeds in place of those of the problem [m/s].

    Raises
    ------
    ProblemError
        If a name or a value is not accepted, or ``C_s`` is missing.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1().replace(conditions={"lambda": [0.1, 0.4]})
    >>> under = chosen(problem, {"creep_factor": "50 %"}).problem
    >>> under.bogie.f_11 / problem.bogie.f_11, bool(under.conditions)
    (0.5, False)
    >>> chosen(problem, "worst").changes
    {'lambda': 0.4}
    """
    plain = problem.replace(conditions=Conditions()) if problem.conditions else problem
    if isinstance(condition, str):
        if condition not in (AS_WRITTEN, WORST):
            near = suggestion(condition, (AS_WRITTEN, WORST))
            raise ProblemError(
                f"{shown(condition)} is neither {AS_WRITTEN!r}, {WORST!r} nor a mapping of values{near}"
            ).under("condition")
        if condition == AS_WRITTEN:
            return Chosen(plain, tuple(speeds or problem.speeds), AS_WRITTEN, {})
        looked_at = problem.replace(speed=tuple(dict.fromkeys(speeds))) if speeds else problem
        return _with(plain, worst_of(looked_at), WORST, problem.speeds)
    given = _read(problem, condition)
    if speeds and "v" in dict(given.changes):
        raise ProblemError("is given beside a speed: give one of them").under("condition.speed")
    return _with(plain, given, GIVEN, speeds or problem.speeds)


def worst_of(problem: Problem) -> Condition:
    """Return the condition of the least margin of a problem's vehicle as it is written. As in `chosen`."""
    given_damping(problem)
    judged = Judged(problem, {name: float(value) for name, value in problem.parameters().items()})
    worst = judged.worst_condition
    return judged.least(problem.design.objective)[1] if judged.looked[worst].stable else worst


def _with(problem: Problem, condition: Condition, values: str, speeds: Sequence[float]) -> Chosen:
    """Return a problem with a condition in its values, by exact numbers."""
    before: dict[str, Any] = {name: exact(value) for name, value in problem.parameters().items()}
    load = condition.load and Load(condition.load.name, tuple((x, exact(a)) for x, a in condition.load.changes))  # type: ignore[misc]
    after = Condition(tuple((name, exact(value)) for name, value in condition.changes), load).applied(before)
    v = after.pop("v", None)
    changes: dict[str, Any] = {name: Written(x) for name, x in after.items() if x != before.get(name)}
    changes |= {} if v is None else {"speed": Written(v)}
    try:
        changed = problem.replace(**changes)
    except ProblemError as error:
        raise error.under("condition") from None
    described = {name: value for name, value in condition.described.items() if name != "speed"}
    return Chosen(changed, tuple(speeds) if v is None else changed.speeds, values, described)


def _read(problem: Problem, given: Mapping[str, Any]) -> Condition:
    """Return a condition from its values by name; the ``condition`` of a result may be given as it is."""
    mistakes = Mistakes()
    changes: dict[str, float] = {}
    load = None
    for name, value in ((key_of(str(name)), value) for name, value in given.items() if name != VALUES):
        with mistakes.under(f"condition.{name}"):
            if name == "load":
                load = _load(problem, value)
            else:
                changes["v" if name == "speed" else name] = _value(problem, name, value)
    mistakes.report()
    return Condition(tuple(changes.items()), load)


def _load(problem: Problem, name: object) -> Load:
    known = {load.name: load for load in problem.conditions.loads}
    if not known:
        raise ProblemError(f"{shown(name)} is not known: the problem has no loads")
    if not isinstance(name, str) or name not in known:
        near = suggestion(name, known) if isinstance(name, str) else ""
        raise ProblemError(f"{shown(name)} is not one of: {', '.join(known)}{near}")
    return known[name]


def _value(problem: Problem, name: str, value: object) -> Any:
    parameter = name.removeprefix(TOLERANCE)
    if name in ("speed", "v"):
        return SPEED.accept(value)
    if name == CREEP_FACTOR.key:
        return CREEP_FACTOR.check(value)
    if parameter not in problem.keys:
        raise ProblemError(answer_to(name) or unknown_key(name, tuple(_known(problem))))
    if name == parameter:
        return PARAMETERS[name].finite.check(value)
    share = as_quantity(value, "-")
    if not -MOST_TOLERANCE < share < MOST_TOLERANCE:
        raise ProblemError(f"{shown(value)} is no tolerance: it lies between -100 % and 100 % of the value")
    return share


def _known(problem: Problem) -> Iterator[str]:
    yield from ("speed", CREEP_FACTOR.key, *(("load",) if problem.conditions.loads else ()), *problem.keys)
    yield from (f"{TOLERANCE}{name}" for name in problem.keys)


def condition_in_words(condition: Mapping[str, Any]) -> str:
    """Return the condition of a result in words.

    Parameters
    ----------
    condition : mapping
        As a result has it.

    Examples
    --------
    >>> condition_in_words({"values": "worst", "speed": 250 / 3, "lambda": 0.05, "tolerance.K_m": -0.1})
    'worst condition: 300 km/h, lambda 0.05, K_m -10 %'
    >>> condition_in_words({"values": "as written", "speed": 250 / 3}), condition_in_words({"values": "as written"})
    ('values as written, at 300 km/h', 'values as written')
    """
    changes = [change_text(name, value) for name, value in condition.items() if name != VALUES]
    return f"{_WORDS[condition[VALUES]]}{', '.join(changes)}".removesuffix(", at ")


def other_condition_in_words(condition: Mapping[str, Any]) -> str:
    """Return the same where the values are not those as written, for titles; an empty text where they are."""
    return "" if condition[VALUES] == AS_WRITTEN else condition_in_words(condition)
