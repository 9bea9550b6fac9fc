"""The front between margin and rotational resistance as data: its points, verified, and what stands beside them."""

import csv
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from yawdesign.damper.design_space import Space
from yawdesign.damper.least_resistance import resistances
from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.requirements import requirement_verdicts
from yawdesign.problem.characters import no_formula
from yawdesign.problem.result import Result, plain
from yawdesign.problem.whole_files import whole_file

Point = Mapping[str, Any]

GAIN = 1e-6  # by which the margin of a point must be larger than with less resistance, relative
DETAILS = ("worst_condition", "requirements")  # of a point: no numbers


@dataclass(frozen=True, repr=False)
class TradeOff(Result):
    """The front between margin and rotational resistance.

    Parameters
    ----------
    front : tuple of mapping
        Its points, in the order of their resistance and of their margin: ``rotational_resistance`` T / (4 Q a), the
        largest, and ``margin``, the least under all conditions, ``C_s``, ``K_m``, ``C_m`` and every other design
        variable in SI units, ``worst_condition``, ``stable``, ``checked`` (eigenvalues and Routh's array agree) and
        ``requirements``, as `stability` has them.
    objective : {"decay_rate", "damping_ratio"}
        Which margin.
    limit : float
        Of the rotational resistance, as written [-].
    golden : mapping or None
        The same of the golden section, with the other variables as written.
    written : mapping or None
        The same of the design as written, where it has a C_s.
    ends_at : float or None
        The rotational resistance [-] from which on more of it was found to leave no larger margin; None if the front
        goes on beyond twice the limit.
    status : Status
        What kind of answer this is.
    message : str
        The same in a sentence, and what to do.
    searched : str
        Under which conditions the margins are the least, in words.
    """

    front: tuple[Point, ...]
    objective: str
    limit: float
    golden: Point | None
    written: Point | None
    ends_at: float | None
    status: str
    message: str
    searched: str = ""

    @property
    def variables(self) -> tuple[str, ...]:
        """The parameters that stand at every point and change along the front, or are design variables."""
        others = {"rotational_resistance", "margin", "stable", "checked", *DETAILS}
        names = [name for name in self.front[0] if name not in others] if self.front else []
        return tuple(name for name in names if self.front[0][name] is not None)

    def to_csv(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write a table with one line for each point, in SI units; loads that begin like formulas have a ' before them.

        Parameters
        ----------
        path : path
            Name of the file; it is there as a whole or not at all.
        replace : bool
            Whether a file that is there is replaced.

        Raises
        ------
        ProblemError
            If there is a file that may not be replaced.
        OSError
            If it cannot be written.
        """
        columns = ["rotational_resistance", "margin", *self.variables, "stable", "checked"]
        conditions = list(dict.fromkeys(name for point in self.front for name in point["worst_condition"]))
        with whole_file(Path(path), replace=replace) as file:
            text = io.TextIOWrapper(file, encoding="utf-8", newline="")
            text.write(f"# trade-off: {self.objective} over rotational resistance, SI units; {self.status}\n")
            rows = csv.writer(text)
            rows.writerow([*columns, *(f"worst_{name}" for name in conditions)])
            for point in map(plain, self.front):
                worst = point["worst_condition"]
                rows.writerow(
                    [*(point[name] for name in columns), *(_cell(worst.get(name, "")) for name in conditions)]
                )
            text.detach()


def _cell(value: Any) -> Any:
    return no_formula(value) if isinstance(value, str) else value


def pareto(points: Iterable[Point]) -> tuple[Point, ...]:
    """Return those points that are stable, meet the requirements, and that none with less resistance beats."""
    front: list[Point] = []
    for point in sorted(points, key=lambda point: (point["rotational_resistance"], -point["margin"])):
        met = all(each.met for each in point["requirements"])
        more = not front or point["margin"] > front[-1]["margin"] * (1 + GAIN)
        if point["stable"] and met and more:
            front.append(point)
    return tuple(front)


def described(space: Space, values: Mapping[str, float]) -> dict[str, Any]:
    """Return a design as a point of the front has it, verified under all conditions.

    Parameters
    ----------
    space : Space
        With the problem.
    values : mapping
        All parameters, ``C_s`` among them, in SI units.
    """
    judged = Judged(space.problem, values)
    margin, worst = judged.least(space.objective)
    return {
        "rotational_resistance": float(resistances(space, dict(values))),
        "margin": margin,
        **{name: values.get(name) for name in dict.fromkeys(("C_s", "K_m", "C_m", *space.names))},
        "worst_condition": worst.described,
        "stable": judged.verdict.stable,
        "checked": judged.checked,
        "requirements": requirement_verdicts(space.problem, values),
    }
