"""A catalogue of yaw dampers: what the data sheet of each says, and what a pair of such dampers is in the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .arguments import named
from .diagnostics import Mistakes, ProblemError, unknown_key
from .parameters import BOGIE
from .quantities import Written, exact
from .table import RIGID, Parameter, as_count, as_text, check_fields, documented, parameter, shown, table

MOST_PER_SIDE = 10
_EXAMPLE = "[{name: A, damping: 400 kN s/m, stiffness: 20 MN/m}] or the name of a file, dampers.csv"
_C_S, _K_DS = BOGIE["C_s"], BOGIE["K_ds"]


@documented
@named
@dataclass(frozen=True, kw_only=True)
class CatalogueDamper:
    """One yaw damper as a data sheet has it: one piece, with its joints.

    Parameters
    ----------
    name : str
        What it is called.
    per_side : int
        How many of them each side of a bogie has.
    """

    name: str
    damping: float = parameter(
        "c", "kN·s/m", "damping of one damper", hard=_C_S.hard, usual=(_C_S.usual[0] / 2, _C_S.usual[1]), source="400"
    )
    stiffness: float = parameter(
        "k",
        "MN/m",
        "stiffness of one damper in series with its damping: oil, joints and mounting together",
        hard=_K_DS.hard,
        usual=(0.5e6, 500e6),
        source="20",
        rigid=True,
    )
    per_side: int = 1
    blow_off: float | None = parameter(
        r"F_\mathrm{b}",
        "kN",
        "force at which its valve opens; outside a linear model, and kept to be seen",
        hard=(0.0, 1e9),
        usual=(1e3, 50e3),
        source="12",
        optional=True,
    )
    damping_after: float | None = parameter(
        r"c_\mathrm{b}",
        "kN·s/m",
        "damping above that force; outside a linear model, and kept to be seen",
        hard=_C_S.hard,
        usual=(0.0, 1e6),
        source="20",
        optional=True,
    )

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("name"):
            object.__setattr__(self, "name", as_text(self.name).strip())
            if not self.name:
                raise ProblemError("a damper needs a name")
        with mistakes.under("per_side"):
            object.__setattr__(self, "per_side", as_count(self.per_side, 1, MOST_PER_SIDE))
        with mistakes.under(""):
            check_fields(self)
        mistakes.report()

    @property
    def C_s(self) -> float:
        """Damping of the pair of yaw dampers [N s/m]: those of both sides together."""
        return Written(2 * self.per_side * exact(self.damping))

    @property
    def K_ds(self) -> float:
        """Stiffness in series with it [N/m]: of both sides together; infinite if it is rigid."""
        return self.stiffness if self.stiffness == RIGID else Written(2 * self.per_side * exact(self.stiffness))

    @property
    def written(self) -> dict[str, Any]:
        """It with the keys of a problem file, in SI units [SI]."""
        values = {name: getattr(self, name) for name in COLUMNS}
        return {name: "rigid" if x == RIGID else x for name, x in values.items() if x is not None}


QUANTITIES: Mapping[str, Parameter] = table(CatalogueDamper)
COLUMNS = ("name", "damping", "stiffness", "per_side", "blow_off", "damping_after")
NEEDED = COLUMNS[:3]


def as_catalogue(value: object, *, optional: bool = False) -> tuple[CatalogueDamper, ...]:
    """Return dampers, given as such or as a problem file has them.

    Examples
    --------
    >>> [damper] = as_catalogue([{"name": "A", "damping": "400 kN s/m", "stiffness": "20 MN/m"}])
    >>> damper.C_s, damper.K_ds
    (800000.0, 40000000.0)
    """
    if isinstance(value, str):
        raise ProblemError(f"{shown(value)} is the name of a file: yawdesign.read_catalogue reads it")
    if optional and isinstance(value, tuple) and not value:
        return ()
    if not isinstance(value, (list, tuple)) or not value:
        empty = isinstance(value, (list, tuple))
        what = "has no value" if value is None else "has no damper in it" if empty else f"{shown(value)} is none"
        raise ProblemError(f"{what}, expected a catalogue of yaw dampers, {_EXAMPLE}")
    mistakes, found = Mistakes(), dict[str, CatalogueDamper]()
    for place, each in enumerate(value):
        with mistakes.under(f"{place}"):
            damper = each if isinstance(each, CatalogueDamper) else _damper(each)
            with mistakes.under(f"{place}.name"):
                if damper.name in found:
                    raise ProblemError(f"{shown(damper.name)} stands twice")
            found.setdefault(damper.name, damper)
    mistakes.report()
    return tuple(found.values())


def _damper(value: object) -> CatalogueDamper:
    if not isinstance(value, Mapping):
        raise ProblemError(f"{shown(value)} is no damper, such as {{name: A, damping: 400 kN s/m, stiffness: 20 MN/m}}")
    mistakes = Mistakes()
    for key in value:
        with mistakes.under(str(key)):
            if key not in COLUMNS:
                raise ProblemError(unknown_key(str(key), COLUMNS))
    for key in NEEDED:
        with mistakes.under(""):
            if key not in value:
                raise ProblemError(f"{key} is missing")
    mistakes.report()
    return CatalogueDamper(**value)


def catalogue_schema() -> dict[str, Any]:
    """Return the JSON Schema of a catalogue: the name of a file, or dampers."""
    quantities = {
        key: {"type": ["number", "string"], "description": f"{row.meaning} [{row.unit}]"}
        for key, row in QUANTITIES.items()
    }
    entries = {"name": {"type": "string"}, "per_side": {"type": ["integer", "string"]}, **quantities}
    damper = {"type": "object", "additionalProperties": False, "required": list(NEEDED), "properties": entries}
    meaning = "The yaw damper is one of these: the name of a file beside this one, or a list."
    return {"description": meaning, "anyOf": [{"type": "string"}, {"type": "array", "minItems": 1, "items": damper}]}
