"""The problem of the paper: the bogie of Table I at 300 km/h with the curve of its example."""

from __future__ import annotations

from .consistency import EQUATIONS
from .diagnostics import Mistakes
from .parameters import KINDS
from .presets import preset, preset_bogie
from .problem import Problem
from .table import as_choice


def table1(kind: str = "power", equations: str = "reciprocal") -> Problem:
    """Return the bogie of Table I at 300 km/h with the curve of the paper's example.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With the motors, or without them and otherwise the same.
    equations : {"reciprocal", "as-printed"}
        Whether the motors' yaw reaction acts on the frame, or is left out as in the paper's equations.

    Returns
    -------
    Problem
        The problem.

    References
    ----------
    Y. Yu, J. Wang, Y. Song, L. Zhao: Stability Analysis of Power Bogie System and Forward Design of Its Yaw Damper
    Damping Parameter. Table I and section V-B.

    Examples
    --------
    >>> table1().bogie.M_b, table1().speeds
    (7186.0, (83.33333333333333,))
    """
    mistakes = Mistakes()
    for name, value, choices in (("kind", kind, KINDS), ("equations", equations, EQUATIONS)):
        with mistakes.under(name):
            as_choice(value, choices)
    mistakes.report()
    data = preset("table1") | {"bogie": preset_bogie("table1", kind), "equations": equations}
    if kind == "trailer":
        data["title"] = "Trailer bogie with the values of Table I"
    return Problem.from_dict(data)
