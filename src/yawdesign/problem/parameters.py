"""The bogie and the car body: one field for every symbol, and with them the one table of parameters."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Literal, get_args

from .arguments import named
from .diagnostics import Diagnostic, Mistakes
from .table import as_choice, as_switch, check_fields, documented, field_name, parameter, table

Kind = Literal["power", "trailer"]
KINDS: tuple[str, ...] = get_args(Kind)

# Rows that stand together in a file, and what is accepted of them: room for limit studies (rigid joints, a frame that
# stands still).
_mass = partial(parameter, group="masses and yaw inertias, axle load", hard=(1e-3, 1e18))
_spring = partial(parameter, group="suspension", hard=(0.0, 1e18))
# A joint without stiffness would be a damper that is not there.
_joint = partial(
    parameter, group="joints of the dampers, a damper having one at each end", hard=(1.0, 1e18), rigid=True
)
_damper = partial(parameter, group="dampers", hard=(0.0, 1e12))
_distance = partial(parameter, group="distances", hard=(1e-3, 100.0))
_contact = partial(parameter, group="wheel and rail", hard=(1.0, 1e15))
_OFFSET = (0.0, 100.0)  # of a distance that may be none
# What Table I does not have, and a bogie may.
_primary_damper = partial(parameter, group="primary dampers, if there are any", optional=True)
_rolling = partial(parameter, group="roll of the bogie frame, if it is to be looked at", optional=True)
_HEIGHT = (-10.0, 10.0)
_carried = partial(parameter, group="car body on two bogies")


@named
@documented
@dataclass(frozen=True, kw_only=True)
class Bogie:
    """A bogie with two wheelsets and, if it is a power bogie, two motors hung on its frame.

    Values are numbers in SI or texts with a unit, such as ``"626.48 kN/m"``; the fields hold SI numbers that remember
    the decimal as it was written. The motor's parameters are None in a trailer bogie. `C_s` may be left out.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With or without motors.
    gravitational_stiffness : bool
        Whether the axle load acts on a displaced wheelset.
    """

    kind: Kind = "power"
    M_b: float = _mass(r"M_\mathrm{b}", "kg", "mass of the bogie frame", usual=(1e3, 20e3), source="7 186")
    J_b: float = _mass(r"J_\mathrm{b}", "kg·m²", "yaw inertia of the bogie frame", usual=(500, 50e3), source="9 751")
    M_w: float = _mass(r"M_\mathrm{w}", "kg", "mass of each wheelset", usual=(500, 6e3), source="3 085")
    J_w: float = _mass(r"J_\mathrm{w}", "kg·m²", "yaw inertia of each wheelset", usual=(200, 5e3), source="2 024")
    M_m: float | None = _mass(r"M_\mathrm{m}", "kg", "mass of each motor", usual=(100, 6e3), source="1 765", motor=True)
    J_m: float | None = _mass(
        r"J_\mathrm{m}", "kg·m²", "yaw inertia of each motor", usual=(5, 5e3), source="1 019", motor=True
    )
    W: float = _mass("W", "N", "axle load", hard=(0.0, 1e9), usual=(20e3, 500e3), source="200 000")
    K_1x: float = _spring(
        r"K_{1x}",
        "MN/m",
        "longitudinal stiffness of the primary suspension of each wheelset",
        usual=(1e6, 500e6),
        source="40",
    )
    K_1y: float = _spring(
        r"K_{1y}",
        "MN/m",
        "lateral stiffness of the primary suspension of each wheelset",
        usual=(0.2e6, 200e6),
        source="6",
    )
    K_2x: float = _spring(
        r"K_{2x}",
        "MN/m",
        "longitudinal stiffness of the secondary suspension of the bogie",
        usual=(10e3, 20e6),
        source="0.8",
    )
    K_2y: float = _spring(
        r"K_{2y}",
        "MN/m",
        "lateral stiffness of the secondary suspension of the bogie",
        usual=(10e3, 20e6),
        source="0.8",
    )
    K_m: float | None = _spring(
        r"K_\mathrm{m}",
        "kN/m",
        "lateral stiffness of the suspension of each motor",
        usual=(10e3, 100e6),
        source="626.48",
        motor=True,
    )
    K_mphi: float | None = _spring(
        r"K_{\mathrm{m}\varphi}",
        "kN·m/rad",
        "yaw stiffness of the suspension of each motor",
        usual=(1e3, 1e9),
        source="361.69",
        motor=True,
    )
    K_ds: float = _joint(
        r"K_\mathrm{ds}", "MN/m", "stiffness of each joint of a yaw damper", usual=(0.5e6, 500e6), source="40"
    )
    K_dt: float = _joint(
        r"K_\mathrm{dt}",
        "MN/m",
        "stiffness of each joint of a secondary lateral damper",
        usual=(0.5e6, 500e6),
        source="40",
    )
    K_dm: float | None = _joint(
        r"K_\mathrm{dm}",
        "MN/m",
        "stiffness of each joint of a motor lateral damper",
        usual=(0.5e6, 500e6),
        source="40",
        motor=True,
    )
    C_t: float = _damper(
        r"C_\mathrm{t}", "kN·s/m", "damping of the pair of secondary lateral dampers", usual=(1e3, 1e6), source="60"
    )
    C_s: float | None = _damper(
        r"C_\mathrm{s}",
        "kN·s/m",
        "damping of the pair of yaw dampers",
        usual=(10e3, 20e6),
        source="1 000",
        optional=True,
    )
    C_mphi: float | None = _damper(
        r"C_{\mathrm{m}\varphi}",
        "kN·s·m/rad",
        "yaw damping of the suspension of each motor",
        usual=(10, 1e6),
        source="11.52",
        motor=True,
    )
    C_m: float | None = _damper(
        r"C_\mathrm{m}", "kN·s/m", "damping of one motor lateral damper", usual=(100, 1e6), source="19.95", motor=True
    )
    a: float = _distance("a", "m", "half the wheelbase", usual=(0.6, 2.5), source="1.25")
    b: float = _distance(
        "b", "m", "half the lateral distance of the contact points of a wheelset", usual=(0.4, 1.0), source="0.746 5"
    )
    a_0: float | None = _distance(
        "a_0",
        "m",
        "longitudinal distance of each motor from the centre of the frame",
        hard=_OFFSET,
        usual=(0.1, 2.5),
        source="0.75",
        motor=True,
    )
    b_0: float = _distance(
        "b_0",
        "m",
        "half the longitudinal distance of the secondary lateral dampers",
        hard=_OFFSET,
        usual=(0.0, 2.0),
        source="0.3",
    )
    b_1: float = _distance(
        "b_1", "m", "half the lateral distance of the primary springs", hard=_OFFSET, usual=(0.4, 1.6), source="1.1"
    )
    b_2: float = _distance(
        "b_2", "m", "half the lateral distance of the secondary springs", hard=_OFFSET, usual=(0.4, 1.6), source="1.1"
    )
    b_3: float = _distance("b_3", "m", "half the lateral distance of the yaw dampers", usual=(0.5, 1.7), source="1.2")
    r: float = _contact("r", "m", "rolling radius of the wheels", hard=(1e-3, 100.0), usual=(0.25, 0.7), source="0.625")
    lambda_: float = _contact(
        r"\lambda", "-", "equivalent conicity of the wheelsets", hard=(0.0, 10.0), usual=(0.005, 0.6), source="0.15"
    )
    f_11: float = _contact(
        r"f_{11}", "kN", "lateral creep coefficient of each wheel", usual=(0.5e6, 50e6), source="11 511"
    )
    f_22: float = _contact(
        r"f_{22}", "kN", "longitudinal creep coefficient of each wheel", usual=(0.5e6, 50e6), source="11 511"
    )

    J_wy: float | None = parameter(
        r"J_\mathrm{wy}",
        "kg·m²",
        "moment of inertia of a wheelset about its axle, for its gyroscopic moment",
        hard=(0.0, 1e18),
        usual=(20, 500),
        source="180",
        group="gyroscopic moment, if it is to be looked at",
        optional=True,
    )
    C_1x: float | None = _primary_damper(
        r"C_{1x}",
        "kN·s/m",
        "damping of the pair of longitudinal primary dampers of each wheelset",
        hard=(0.0, 1e12),
        usual=(1e3, 1e6),
        source="20",
    )
    C_1y: float | None = _primary_damper(
        r"C_{1y}",
        "kN·s/m",
        "damping of the pair of lateral primary dampers of each wheelset",
        hard=(0.0, 1e12),
        usual=(1e3, 1e6),
        source="20",
    )
    K_d1x: float | None = _primary_damper(
        r"K_\mathrm{d1x}",
        "MN/m",
        "stiffness of each joint of a longitudinal primary damper; without it they are rigid",
        hard=(1.0, 1e18),
        usual=(0.5e6, 500e6),
        source="10",
        rigid=True,
    )
    K_d1y: float | None = _primary_damper(
        r"K_\mathrm{d1y}",
        "MN/m",
        "stiffness of each joint of a lateral primary damper; without it they are rigid",
        hard=(1.0, 1e18),
        usual=(0.5e6, 500e6),
        source="10",
        rigid=True,
    )
    I_b: float | None = _rolling(
        r"I_\mathrm{b}",
        "kg·m²",
        "roll inertia of the bogie frame",
        hard=(1e-3, 1e18),
        usual=(200, 20e3),
        source="3 000",
    )
    K_1z: float | None = _rolling(
        r"K_{1z}",
        "MN/m",
        "vertical stiffness of the primary suspension of one axle box",
        hard=(0.0, 1e18),
        usual=(0.1e6, 20e6),
        source="1.2",
    )
    C_1z: float | None = _rolling(
        r"C_{1z}",
        "kN·s/m",
        "vertical damping of the primary suspension of one axle box",
        hard=(0.0, 1e12),
        usual=(0, 200e3),
        source="10",
    )
    h_1: float | None = _rolling(
        "h_1",
        "m",
        "centre of mass of the frame above the primary springs",
        hard=_HEIGHT,
        usual=(-0.5, 0.5),
        source="0.1",
    )
    h_2: float | None = _rolling(
        "h_2",
        "m",
        "secondary springs above the centre of mass of the frame",
        hard=_HEIGHT,
        usual=(-0.5, 1.0),
        source="0.2",
    )
    h_2t: float | None = _rolling(
        r"h_\mathrm{2t}",
        "m",
        "secondary lateral dampers above the centre of mass of the frame",
        hard=_HEIGHT,
        usual=(-0.5, 1.0),
        source="0.1",
    )
    K_2z: float | None = _rolling(
        r"K_{2z}",
        "MN/m",
        "vertical stiffness of the secondary suspension on one side of the bogie",
        hard=(0.0, 1e18),
        usual=(50e3, 5e6),
        source="0.61",
    )
    C_2z: float | None = _rolling(
        r"C_{2z}",
        "kN·s/m",
        "vertical damping of the secondary suspension on one side of the bogie",
        hard=(0.0, 1e12),
        usual=(0, 500e3),
        source="9.8",
    )
    gravitational_stiffness: bool = True

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("bogie"):
            check_fields(self)
        with mistakes.under("bogie.gravitational_stiffness"):
            as_switch(self.gravitational_stiffness)
        with mistakes.under("bogie.kind"):
            as_choice(self.kind, KINDS)
            mistakes.found.extend(self._misplaced())
        mistakes.found.extend(incomplete(given_of(self)))
        mistakes.report()

    def _misplaced(self) -> list[Diagnostic]:
        """Return what is wrong with the motor's values: all are needed, or none is allowed."""
        given = {key for key in MOTOR_KEYS if getattr(self, key) is not None}
        wrong = given if self.kind == "trailer" else set(MOTOR_KEYS) - given
        text = NO_MOTOR if self.kind == "trailer" else "is missing: a power bogie needs it"
        return [Diagnostic(key=f"bogie.{key}", message=text, at_key=True) for key in MOTOR_KEYS if key in wrong]

    def parameters(self) -> dict[str, float]:
        """Return the values in SI by key (``lambda``, not ``lambda_``), without those that are None.

        Returns
        -------
        dict of str to float
            In the order of Table I.
        """
        return given_values(self)


@named
@documented
@dataclass(frozen=True, kw_only=True)
class CarBody:
    """A car body on two bogies, which moves laterally, yaws and rolls.

    Values are numbers in SI or texts with a unit, as those of `Bogie`.

    Parameters
    ----------
    overturning : bool
        Whether the weight of the rolled car body acts, a moment of -M_c g h_s per unit of its roll.
    """

    M_c: float = _carried(
        r"M_\mathrm{c}", "t", "mass of the car body", hard=(1e-3, 1e18), usual=(5e3, 100e3), source="34.5"
    )
    J_c: float = _carried(
        r"J_\mathrm{c}", "t·m²", "yaw inertia of the car body", hard=(1e-3, 1e18), usual=(50e3, 5e6), source="1 521"
    )
    I_c: float = _carried(
        r"I_\mathrm{c}", "t·m²", "roll inertia of the car body", hard=(1e-3, 1e18), usual=(5e3, 300e3), source="124.304"
    )
    l_c: float | None = _carried(
        r"l_\mathrm{c}",
        "m",
        "half the distance of the bogie centres; L/2 of the curve if not given",
        hard=(1e-3, 100.0),
        usual=(2, 15),
        source="9.5",
        optional=True,
    )
    h_s: float = _carried(
        r"h_\mathrm{s}",
        "m",
        "centre of mass of the car body above the secondary springs",
        hard=_HEIGHT,
        usual=(0.0, 2.5),
        source="0.852",
    )
    h_t: float = _carried(
        r"h_\mathrm{t}",
        "m",
        "centre of mass of the car body above the secondary lateral dampers",
        hard=_HEIGHT,
        usual=(0.0, 2.5),
        source="0.97",
    )
    K_2z: float = _carried(
        r"K_{2z}",
        "MN/m",
        "vertical stiffness of the secondary suspension on one side of a bogie",
        hard=(0.0, 1e18),
        usual=(50e3, 5e6),
        source="0.61",
    )
    C_2z: float = _carried(
        r"C_{2z}",
        "kN·s/m",
        "vertical damping of the secondary suspension on one side of a bogie",
        hard=(0.0, 1e12),
        usual=(0, 500e3),
        source="9.8",
    )
    overturning: bool = False

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("car_body"):
            check_fields(self)
        with mistakes.under("car_body.overturning"):
            as_switch(self.overturning)
        mistakes.report()

    def parameters(self) -> dict[str, float]:
        """Return the values in SI by key, without those that are None.

        Returns
        -------
        dict of str to float
        """
        return given_values(self)


def given_of(part: Bogie | CarBody) -> dict[str, float]:
    """Return what is given of a part, in SI by key; a joint that is rigid is infinite."""
    values = {key: getattr(part, field_name(key)) for key in table(type(part))}
    return {key: value for key, value in values.items() if value is not None}


def given_values(part: Bogie | CarBody) -> dict[str, float]:
    """Return the values of a part in SI by key, without those that are not given, and the joints that are rigid."""
    return {key: value for key, value in given_of(part).items() if not math.isinf(value)}


NO_ROLL, ROLL_NEEDS_IT = "belongs to roll: I_b is missing", "is missing: roll of the frame (I_b) needs it"
NO_MOTOR = "belongs to the motors, and a trailer bogie has none: remove it, or choose kind: power"
BOGIE, CAR_BODY = table(Bogie), table(CarBody)
PARAMETERS = MappingProxyType({**BOGIE, **CAR_BODY})
MOTOR_KEYS: tuple[str, ...] = tuple(key for key, row in BOGIE.items() if row.motor)
VERTICAL = ("K_2z", "C_2z")  # of the secondary suspension: under car_body where there is one
ROLL_KEYS = ("I_b", "K_1z", "C_1z", "h_1", "h_2", "h_2t", *VERTICAL)
ADDED = tuple(key for key, row in BOGIE.items() if row.optional and key != "C_s")  # to the bogie of Table I


def incomplete(given: Collection[str]) -> Iterator[Diagnostic]:
    """Yield what is wrong with keys of a bogie that only make sense together."""
    for joint, damper in (("K_d1x", "C_1x"), ("K_d1y", "C_1y")):
        if joint in given and damper not in given:
            yield Diagnostic(key=f"bogie.{joint}", message=f"needs the damper: {damper} is missing", at_key=True)
    for key in ROLL_KEYS:
        if key not in VERTICAL and (key in given) != ("I_b" in given):
            text = NO_ROLL if key in given else ROLL_NEEDS_IT
            yield Diagnostic(key=f"bogie.{key}", message=text, at_key=True)


def bogie_keys(kind: str) -> tuple[str, ...]:
    """Return the keys that a bogie of this kind may have, in the order of the table."""
    return tuple(key for key in BOGIE if kind != "trailer" or key not in MOTOR_KEYS)


def parameter_keys(kind: str) -> tuple[str, ...]:
    """Return the keys that every bogie of this kind has, in the order of Table I."""
    return tuple(key for key in bogie_keys(kind) if key not in ADDED)
