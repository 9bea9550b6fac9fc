"""A problem file to start from: Table I, written out and explained."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

from .diagnostics import Mistakes
from .parameters import KINDS, PARAMETERS, parameter_keys
from .running import CURVE
from .table import Parameter, as_choice
from .variables import DEFAULT_BOUNDS, default_variables

_HEAD = """\
# yaml-language-server: $schema=problem.schema.json
# The line above gives an editor completion and hover texts. `yawdesign new` writes the file it names beside this one,
# `yawdesign schema > problem.schema.json` writes it anew.
#
# A number alone is in SI (N, m, kg, s, rad); a text has a unit: 626.48 kN/m, 300 km/h, 11.52 kN·s·m/rad.
# Blanks or _ group digits; *, · and blanks join units; ^2 or ² is a power; the decimal sign is a point.
# `yawdesign check` names every mistake with its line.

title: {title}

# reciprocal: the yaw reaction of the motors acts on the frame (action = reaction).
# as-printed: without it, as in the published equations, to compare with published numbers.
equations: reciprocal

bogie:
  kind: {kind:<22} # power: two motors hung on the frame; trailer: no motors, and none of their keys
  # base: table1               # a preset; then only the keys that differ from it need to be written
"""

_TAIL = """\

# The running speed, or a range of which every speed must be stable:
# speed: {{min: 200 km/h, max: 300 km/h, steps: 11}}
speed: 300 km/h

# The tightest curve. It limits the yaw damping from above; without it there is no upper limit.
curve:
{curve}
  load: axle                   # Q is the axle load W (axle) or the wheel load W/2 (wheel, as railway standards have it)

design:
  objective: decay_rate        # make the least decay rate [1/s] as large as possible, or the least damping_ratio [-]
  variables:                   # what may be changed; any parameter of the bogie may stand here
{variables}
"""


def starter(kind: str = "power") -> str:
    """Return a commented problem file to start from.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With or without motors.

    Returns
    -------
    str
        YAML with the values of Table I, which reads without errors.

    Examples
    --------
    >>> print(starter().splitlines()[8])
    title: A power bogie
    """
    with (mistakes := Mistakes()).under("kind"):
        as_choice(kind, KINDS)
    mistakes.report()
    head = _HEAD.format(title=f"A {kind} bogie", kind=kind)
    curve = "\n".join(_line(row, row.example) for row in CURVE.values())
    variables = "\n".join(_variable(key) for key in default_variables(kind))
    return f"{head}{bogie_lines(kind)}\n{_TAIL.format(curve=curve, variables=variables)}"


def bogie_lines(kind: str) -> str:
    """Return the values of Table I as commented lines, in groups."""
    rows = (PARAMETERS[key] for key in parameter_keys(kind))
    return "\n".join(_group(title, of_group) for title, of_group in groupby(rows, key=lambda row: row.group))


def _group(title: str, rows: Iterable[Parameter]) -> str:
    return "\n".join([f"\n  # {title}", *(_line(row, row.example) for row in rows)])


def _line(row: Parameter, value: str) -> str:
    return f"  {f'{row.key}: {value}':<28} # {row.meaning}"


def _variable(key: str) -> str:
    low, high = DEFAULT_BOUNDS[key]
    return f"    {key}: {{min: {low}, max: {high}}}"
