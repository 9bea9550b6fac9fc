"""The option by which a command is told under which condition it looks at a vehicle, and what it says of that."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.output.streams import tell

if TYPE_CHECKING:
    from yawdesign.hunting.chosen_condition import Asked
    from yawdesign.problem import Problem

AskedCondition = Annotated[
    list[str] | None,
    typer.Option(
        "--condition",
        metavar="WHICH",
        help="as-written (default), worst, or NAME=VALUE, again and again: lambda=0.4, creep_factor=0.5, load=laden, "
        "tolerance.K_m='-10 %', speed='330 km/h'.",
    ),
]


def asked_condition(texts: list[str] | None) -> "Asked":
    """Return the condition that --condition asks for."""
    from yawdesign.hunting.chosen_condition import AS_WRITTEN, WORST
    from yawdesign.problem import ProblemError
    from yawdesign.problem.diagnostics import suggestion
    from yawdesign.problem.table import key_of

    words = {"as-written": AS_WRITTEN, WORST: WORST}
    given: dict[str, str] = {}
    for text in texts or ["as-written"]:
        name, sign, value = text.partition("=")
        if not sign and text not in words:
            raise ProblemError(f"--condition {text}: is none of as-written, worst, NAME=VALUE{suggestion(text, words)}")
        if not sign and len(texts or ()) > 1:
            raise ProblemError(f"--condition {text}: stands alone, and other conditions are given")
        if not sign:
            return words[text]
        if (name := key_of(name.strip())) in given:
            raise ProblemError(f"--condition {text}: {name} is given twice")
        given[name] = value.strip()
    return given


def tell_condition(problem: "Problem", result: Any) -> None:
    """Say that an answer is for the values as written, where the problem has other conditions."""
    from yawdesign.hunting.chosen_condition import AS_WRITTEN, VALUES, condition_in_words
    from yawdesign.problem.conditions import condition_set

    if problem.conditions and result.condition[VALUES] == AS_WRITTEN:
        every = condition_set(problem)
        ranges = [f"ranges of {', '.join(name for name, _ in every.ranges)}"] if every.ranges else []
        lists = [f"{len(every.lists)} conditions"] if len(every.lists) > 1 else []
        tell(f"{condition_in_words(result.condition)}; the problem has {' x '.join(lists + ranges)}: --condition worst")
