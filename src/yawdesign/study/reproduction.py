"""The paper reproduced: its tables, figures and equations, each computed now, beside what it prints."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from yawdesign import __version__
from yawdesign.problem import Problem, table1
from yawdesign.problem.arguments import Progress
from yawdesign.problem.result import Result
from yawdesign.study.paper_bogie import PaperBogie, paper_bogie
from yawdesign.study.reproduced_figures import figure_3, figures_4_5, rows_of_figure_3, rows_of_figures_4_5
from yawdesign.study.reproduced_row import PRINTED, ReproducedRow
from yawdesign.study.reproduced_table_2 import figure_2, table_2
from yawdesign.study.reproduced_tables import equations_9_11, equations_13_14, table_1, table_3
from yawdesign.study.sweep import IncompleteSweepError


@dataclass(frozen=True, repr=False, eq=False)
class Reproduction(Result):
    """The paper's numbers beside those computed.

    Parameters
    ----------
    agrees : bool
        Whether every row that is compared agrees.
    checked : bool
        Whether every computed number was confirmed by a second route.
    rows : tuple of ReproducedRow
        In the order of the paper.
    changed : mapping of str to list
        Parameters that are not those of Table I, with the printed and the used value, in SI.
    version : str
        Of this package.
    drawn : mapping of str to Result
        What the figures are drawn from, by the name of the figure; it is not part of `to_dict`.
    """

    agrees: bool
    checked: bool
    rows: tuple[ReproducedRow, ...]
    changed: Mapping[str, tuple[Any, Any]]
    version: str
    drawn: Mapping[str, Any]

    @property
    def compared(self) -> tuple[ReproducedRow, ...]:
        """The rows with a judgement."""
        return tuple(row for row in self.rows if row.agrees is not None)

    def _entries(self) -> Mapping[str, Any]:
        return {name: value for name, value in super()._entries().items() if name != "drawn"}

    def __repr__(self) -> str:
        agreeing = sum(bool(row.agrees) for row in self.compared)
        head = f"Reproduction: {agreeing} of {len(self.compared)} compared rows agree, {len(self.rows)} rows in all"
        rows = (f"  {row.where:<9} {row.what}: {_cell(row)}" for row in self.rows)
        return "\n".join([head, *rows])


ROW_KEYS = tuple(field.name for field in fields(ReproducedRow))


def _cell(row: ReproducedRow) -> str:
    values = (x if isinstance(x, str) else "-" if x is None else f"{x:.9g}" for x in (row.printed, row.computed))
    verdict = {True: "agrees", False: "DIFFERS", None: "not compared"}[row.agrees]
    return f"printed {next(values)}, computed {next(values)} {row.unit} ({verdict})"


def reproduction(problem: Problem | None = None, progress: Progress = lambda text, part: None) -> Reproduction:
    """Return the paper's numbers beside those computed now.

    Parameters
    ----------
    problem : Problem, optional
        With another bogie, speed or curve in the place of the paper's; Table I if not given. Each row has its own
        equations; conditions are not looked at.
    progress : callable
        Called with a text and the part that is done, 0 to 1.

    Raises
    ------
    ProblemError
        If the paper's equations are not written for the problem.
    """
    try:
        return _computed(paper_bogie(table1(equations=PRINTED) if problem is None else problem), progress)
    except IncompleteSweepError as error:  # of a reproduction nothing is kept
        raise error.__cause__ or error from None


def _computed(bogie: PaperBogie, progress: Progress) -> Reproduction:
    rows = [*table_1(bogie)]
    progress("Fig. 2 and Table II", 0.05)
    run = figure_2(bogie)
    rows += table_2(bogie, run)
    progress("equations (9) and (11) in rational numbers", 0.3)
    rows += equations_9_11(bogie)
    progress("Fig. 3", 0.6)
    curves = figure_3(bogie)
    rows += rows_of_figure_3(bogie, curves)
    progress("Table III", 0.75)
    rows += [*equations_13_14(bogie), *table_3(bogie)]
    progress("Figs 4 and 5", 0.8)
    runs = figures_4_5(bogie)
    rows += rows_of_figures_4_5(bogie, runs)
    progress("done", 1.0)
    own = {row.what.partition(",")[0]: row for row in rows if row.where == "Table I" and row.tolerance == 0.0}
    return Reproduction(
        agrees=all(row.agrees is not False for row in rows),
        checked=all(row.checked for row in rows),
        rows=tuple(rows),
        changed={key: (row.printed, row.computed) for key, row in own.items() if not row.agrees},
        version=__version__,
        drawn={"fig2": run, **curves, **runs},
    )
