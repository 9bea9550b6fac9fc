"""A problem file to start from: Table I, written out and explained, and a car body on it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby

from .consistency import fitting_axle_load
from .diagnostics import Mistakes
from .parameters import ADDED, BOGIE, CAR_BODY, KINDS, VERTICAL, parameter_keys
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
  # base: table1               # a preset; then only the keys that differ from it need to be written"""

_OPTIONAL = """\
  # What Table I does not have, and a bogie may. A joint may be `rigid`.

{lines}

  # creep: {{kalker_factor: 0.6, rail_radius: 300 mm}} # in place of f_11, f_22: from the axle load, by Kalker
  # gravitational_stiffness: false # the axle load does not centre the wheelsets; the curve's formula has it still"""

_CAR_BODY = """\
# The car body, on two such bogies: it moves laterally, yaws and rolls. Without this part it stands still.
# The answers part where conicity is low or creep is reduced: the car body's sway joins the motion of the bogies.
car_body:
  # base: huo-dai              # a preset; then only the keys that differ from it need to be written
{lines}
  overturning: false           # true: the weight of the rolled car body acts, -M_c g h_s on its roll"""

_CASES = """\
# Faults that must be survived. A percentage is a share of the value as designed; otherwise a value with its unit.
# cases:
#   one yaw damper lost: {C_s: 50 %, K_ds: 50 %}"""
_OF_ONE_BOGIE = """
#   one yaw damper of the leading bogie lost: {leading.C_s: 50 %, leading.K_ds: 50 %}
#   lateral dampers of the trailing bogie lost: {trailing.C_t: 0 %}"""

_CONDITIONS = """\
# The conditions that will be met. A margin is the worst, and a verdict holds, under every combination of them and of
# the speeds. A parameter that stands here has these values in place of its own.
# conditions:
#   lambda: [0.05, 0.10, 0.15, 0.25, 0.40]     # a list: these values
#   creep_factor: {{min: 0.5, max: 1}}           # a range: every value in it; this one multiplies f_11 and f_22
#   tolerance: {{C_s: 15 %, C_t: 20 %}}          # by which share of its value, to either side, a parameter may deviate
#   load: {{tare: {{{tare}}}, laden: {{{laden}}}}}

# What must be reached under all conditions; `optimise` chooses among the designs that do.
# requirements:
#   damping_ratio: 5 %         # at least
#   critical_speed: 330 km/h   # stable at every speed up to this
#   cases: {{damping_ratio: 0 %}} # what the faults below must reach"""

_TAIL = """\
# The running speed; or several; or a range, every speed in it: `steps` of them are looked at first.
# speed: [200 km/h, 300 km/h]
# speed: {{min: 200 km/h, max: 300 km/h, steps: 11}}
speed: 300 km/h

# The tightest curve. It limits the yaw damping from above; without it there is no upper limit.
curve:
{curve}
  load: axle                   # Q is the axle load W (axle) or the wheel load W/2 (wheel, as railway standards have it)

{conditions}

{cases}

design:
  objective: decay_rate        # make the least decay rate [1/s] as large as possible, or the least damping_ratio [-]
  variables:                   # what may be changed; any parameter {of} may stand here
{variables}
  # catalogue: dampers.csv     # the yaw damper is one of these: `yawdesign choose` ranks them

# How parameters are distributed, creep_factor and speed too, for `yawdesign uncertainty`:
# uncertainty:
#   lambda: {{uniform: [0.05, 0.40]}}
#   K_2x: {{lognormal: 10 %}}     # standard deviation as a share of the value; or normal: 10 %
"""


_MASSES = (34.5, 42)  # of a car body without and with passengers [t]


def starter(kind: str = "power", *, car_body: bool = False) -> str:
    """Return a commented problem file to start from.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With or without motors.
    car_body : bool
        Whether a car body moves on two such bogies; the axle load is then that of this vehicle.

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
    title = f"A car body on two {kind} bogies" if car_body else f"A {kind} bogie"
    tail = _TAIL.format(
        curve=_lines(CURVE.values()),
        conditions=_conditions(kind, car_body=car_body),
        cases=_CASES + (_OF_ONE_BOGIE if car_body else ""),
        of="of bogie and car body" if car_body else "of the bogie",
        variables="\n".join(_variable(key) for key in default_variables(kind)),
    )
    body = [_CAR_BODY.format(lines=_lines(CAR_BODY.values()))] if car_body else []
    return "\n\n".join([_HEAD.format(title=title, kind=kind), _bogie_lines(kind, car_body=car_body), *body, tail])


def _bogie_lines(kind: str, *, car_body: bool) -> str:
    """Return the values of Table I as commented lines, in groups, and what else there may be as lines to uncomment."""
    load = {"W": f"{round(_axle_load(kind))} 000"} if car_body else {}
    rows = [replace(BOGIE[key], source=load.get(key, BOGIE[key].source)) for key in parameter_keys(kind)]
    more = [BOGIE[key] for key in ADDED if not (car_body and key in VERTICAL)]
    return "\n\n".join([*_groups(rows), _OPTIONAL.format(lines="\n\n".join(_groups(more, mark="# ")))])


def _conditions(kind: str, *, car_body: bool) -> str:
    """Return conditions and requirements as lines to uncomment, with an empty and a full vehicle."""
    if not car_body:
        return _CONDITIONS.format(tare="W: 120 kN", laden="W: 200 kN")
    tare, laden = (f"M_c: {mass} t, W: {round(_axle_load(kind, M_c=1e3 * mass))} kN" for mass in _MASSES)
    return _CONDITIONS.format(tare=tare, laden=laden)


def _axle_load(kind: str, **changed: float) -> float:
    """Return the axle load of the vehicle with the values of both tables, but for some [kN]."""
    values = {row.key: row.check(row.example) for row in (*BOGIE.values(), *CAR_BODY.values())} | changed
    return fitting_axle_load(values, kind) / 1e3


def _groups(rows: Iterable[Parameter], mark: str = "") -> Iterator[str]:
    for title, of_group in groupby(rows, key=lambda row: row.group):
        yield f"  # {title}\n{_lines(of_group, mark)}"


def _lines(rows: Iterable[Parameter], mark: str = "") -> str:
    return "\n".join(f"  {f'{mark}{row.key}: {row.example}':<28} # {row.meaning}" for row in rows)


def _variable(key: str) -> str:
    low, high = DEFAULT_BOUNDS[key]
    return f"    {key}: {{min: {low}, max: {high}}}"
