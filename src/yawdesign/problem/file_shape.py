"""The shape of a problem file as pydantic models, generated from the parameter table, and the problem they describe.

Pydantic finds what is missing, unknown or of the wrong shape; the values themselves are checked by the table, in the
same functions that the dataclasses use. Nothing of pydantic leaves this room.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from functools import cache, partial
from typing import Annotated, Any

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    PlainValidator,
    Tag,
    ValidationInfo,
    WithJsonSchema,
)
from pydantic import create_model as make

from .cases import as_cases
from .condition import Conditions
from .consistency import EQUATIONS
from .creep import CREEP, MADE, creep_coefficients
from .damper_catalogue import as_catalogue, catalogue_schema
from .diagnostics import Mistakes, ProblemError
from .distributions import as_distributions
from .parameters import BOGIE, CAR_BODY, KINDS, PARAMETERS, Bogie, CarBody, bogie_keys
from .patterns import unit_pattern
from .requirements import as_requirements
from .running import CURVE, LOADS, SPEED, STEPS, Curve, SpeedRange, as_speeds
from .table import Parameter, as_choice, as_count, as_switch, as_text, check_end, field_name
from .units import kind_of
from .variables import OBJECTIVES, Design, Variable
from .written_conditions import as_conditions

PRESETS: Mapping[str, tuple[str, ...]] = {"bogie": ("table1",), "car_body": ("huo-dai",)}
SWITCHES: Mapping[str, Mapping[str, tuple[bool, str]]] = {
    "bogie": {"gravitational_stiffness": (True, "Whether the axle load centres a displaced wheelset.")},
    "car_body": {"overturning": (False, "Whether the weight of the rolled car body acts: -M_c g h_s on its roll.")},
}
_STRICT = ConfigDict(extra="forbid")


def _leaf(check: Callable[..., Any], schema: dict[str, Any]) -> Any:
    return Annotated[Any, PlainValidator(check), WithJsonSchema(schema)]


# A number with grouped digits and perhaps a power of ten; the unit is looked at by `check`.
_TENS = r"([eE][-+]?\d+|\s*[×·⋅*x]\s*10((\^|\*\*)[-+\u2212]?\d+|[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))?"
_QUANTITY = r"^\s*[-+]?(\d[\d _\u2009\u202f\u00a0]*(\.[\d _\u2009\u202f\u00a0]*)?|\.\d+){tens}\s*{unit}$"


def quantity_schema(row: Parameter) -> dict[str, Any]:
    """Return the JSON Schema of a value of the table."""
    unit = row.unit.strip("-")
    si = f"; a number alone is in {row.si}" if unit else ""
    hover = f"{row.meaning[:1].upper()}{row.meaning[1:]}, ${row.symbol}$ [{row.unit}]{si}. "
    hover += f"Accepted: {row.range_text(row.hard)}. Usual: {row.range_text(row.usual, row.unit)}."
    number = {"type": "number", "minimum": row.hard[0], "maximum": row.hard[1]}
    pattern = _QUANTITY.format(tens=_TENS, unit=unit_pattern(row.unit))
    text = {"type": "string", "pattern": pattern, "description": kind_of(row.unit)}
    words = [{"const": "rigid"}] if row.rigid else []
    return {"description": hover, "anyOf": [number, text, *words], "examples": [row.example]}


def quantity(row: Parameter) -> Any:
    """Return the type of a value of the table."""
    return _leaf(row.check, quantity_schema(row))


def _upper_end(row: Parameter) -> Any:
    def check(value: object, info: ValidationInfo) -> object:
        return check_end(value, row, info.data.get("min"))

    return _leaf(check, quantity_schema(row))


def _choice(choices: Collection[str], meaning: str, default: str | None = None) -> Any:
    schema: dict[str, Any] = {"enum": list(choices), "description": meaning}
    if default is not None:
        schema["default"] = default
    return _leaf(partial(as_choice, choices=choices), schema)


def _model(name: str, meaning: str, entries: Mapping[str, tuple[Any, Any]]) -> type[BaseModel]:
    return make(name, __config__=_STRICT, __doc__=meaning, **entries)  # type: ignore[call-overload, no-any-return]


def _part(part: str, rows: Iterable[Parameter], *, complete: bool) -> dict[str, tuple[Any, Any]]:
    """Return the entries of bogie or car body: preset, parameters and switches."""
    base = _choice(PRESETS[part], "Preset whose values are used for all keys that are not given.")
    values = {row.key: (quantity(row), ... if complete and not row.optional else None) for row in rows}
    switches = {
        key: (_leaf(as_switch, {"type": "boolean", "default": usual, "description": meaning}), None)
        for key, (usual, meaning) in SWITCHES[part].items()
    }
    return {"base": (base, None), **values, **switches}


def _bogie_model(kind: str, *, complete: bool, by_creep: bool) -> type[BaseModel]:
    kinds = _choice(KINDS, "With or without motors hung on the frame.", "power")
    left_out = MADE if by_creep else ()
    part = _part("bogie", (BOGIE[key] for key in bogie_keys(kind) if key not in left_out), complete=complete)
    meaning = "Instead of f_11 and f_22: both from the axle load and the radius of the wheels, by Hertz and Kalker."
    creep = _model("Creep", meaning, {row.key: (quantity(row), None) for row in CREEP.values()})
    entries = {"kind": (kinds, "power"), **part, "creep": (creep, None)}
    return _model("Bogie", "The bogie, with the symbols of Table I.", entries)


def _car_body_model(*, complete: bool) -> type[BaseModel]:
    meaning = "The car body on two such bogies; without it the car body stands still."
    return _model("CarBody", meaning, _part("car_body", CAR_BODY.values(), complete=complete))


def _curve_model() -> type[BaseModel]:
    rows = {key: (quantity(row), None if key == "limit" else ...) for key, row in CURVE.items()}
    load = _choice(LOADS, "Load Q in T/(4 Q a): the axle load W as in the paper, or the wheel load W/2.", "axle")
    return _model("Curve", "The tightest curve; it limits the damping from above.", {**rows, "load": (load, None)})


def _bounds(row: Parameter) -> type[BaseModel]:
    row = row.finite
    return _model(
        f"Bounds_{row.key}",
        f"Bounds of {row.key}: {row.meaning}.",
        {"min": (quantity(row), ...), "max": (_upper_end(row), ...)},
    )


def _speed_range() -> type[BaseModel]:
    schema = {"type": "integer", "minimum": STEPS[0], "maximum": STEPS[1], "default": 11}
    steps = _leaf(partial(as_count, low=STEPS[0], high=STEPS[1]), schema | {"description": "Number of speeds."})
    entries = {"min": (quantity(SPEED), ...), "max": (_upper_end(SPEED), ...), "steps": (steps, None)}
    return _model("SpeedRange", "A range of running speeds.", entries)


def _speed() -> Any:
    def tag(value: object) -> str:
        return "<range>" if isinstance(value, dict) else "<value>"

    schema = quantity_schema(SPEED)
    listed = {"description": "These speeds.", "type": "array", "minItems": 1, "items": {"anyOf": schema["anyOf"]}}
    some = _leaf(as_speeds, {**schema, "anyOf": [*schema["anyOf"], listed]})
    one, several = Annotated[some, Tag("<value>")], Annotated[_speed_range(), Tag("<range>")]
    return Annotated[one | several, Discriminator(tag)]


def _not_empty(value: object) -> object:
    if value == {}:
        raise ProblemError("names no parameter: remove the key to change C_s, K_m and C_m")
    return value


def _design_model(kind: str) -> type[BaseModel]:
    rows = (row for key, row in PARAMETERS.items() if key in CAR_BODY or key in bogie_keys(kind))
    variables = _model(
        "Variables",
        "Parameters that may be changed, with their bounds; without this key: C_s, K_m and C_m.",
        {row.key: (_bounds(row), None) for row in rows},
    )
    some: Any = Annotated[variables, BeforeValidator(_not_empty)]
    objective = _choice(OBJECTIVES, "What is to be as large as possible.", "decay_rate")
    return _model(
        "Design",
        "What may be changed, and what is to be best.",
        {
            "objective": (objective, None),
            "variables": (some, None),
            "catalogue": (_leaf(as_catalogue, catalogue_schema()), None),
        },
    )


@cache
def problem_model(
    kind: str, complete: frozenset[str] = frozenset(PRESETS), *, by_creep: bool = False
) -> type[BaseModel]:
    """Return the model of a problem file.

    Parameters
    ----------
    kind : {"power", "trailer"}
        Whether there are motors.
    complete : frozenset of str
        Of which parts all parameters are required: ``bogie``, ``car_body``; they are not where the preset is not known.
    by_creep : bool
        Whether the creep coefficients follow from the axle load, and are not given.
    """
    text = _leaf(as_text, {"type": "string", "description": "Any text; it heads tables and plots."})
    equations = _choice(
        EQUATIONS,
        "Whether the motors' yaw reaction acts on the frame, or is left out as the paper has it.",
        "reciprocal",
    )
    return _model(
        "Problem",
        "A yawdesign problem.",
        {
            "title": (text, None),
            "equations": (equations, None),
            "bogie": (_bogie_model(kind, complete="bogie" in complete, by_creep=by_creep), ...),
            "car_body": (_car_body_model(complete="car_body" in complete), None),
            "speed": (_speed(), ...),
            "curve": (_curve_model(), None),
            "conditions": (_leaf(as_conditions, {"description": "Conditions under which everything must hold."}), None),
            "cases": (_leaf(as_cases, {"description": "Faults that must be survived, by name."}), None),
            "requirements": (_leaf(as_requirements, {"description": "What must be reached."}), None),
            "design": (_design_model(kind), None),
            "uncertainty": (_leaf(as_distributions, {"description": "Distributions of parameters."}), None),
        },
    )


def parts_of(model: BaseModel) -> dict[str, Any]:
    """Return the parts of the problem that a validated model describes, as its constructor takes them."""
    data = given(model)
    speed = data["speed"]
    return {
        "title": data.get("title", ""),
        "equations": data.get("equations", "reciprocal"),
        "bogie": Bogie(**_values(data["bogie"]), **_made(data["bogie"])),
        "car_body": CarBody(**_values(data["car_body"])) if "car_body" in data else None,
        "speed": SpeedRange(**speed) if isinstance(speed, dict) else speed,
        "curve": Curve(**data["curve"]) if "curve" in data else None,
        "cases": data.get("cases", ()),
        "conditions": data.get("conditions", Conditions()),
        "requirements": data.get("requirements", ()),
        "uncertainty": data.get("uncertainty", ()),
        "design": _design(data.get("design", {})),
    }


def given(model: BaseModel) -> dict[str, Any]:
    """Return the values that were given, by key, nested models included."""
    values = {key: getattr(model, key) for key in type(model).model_fields if key in model.model_fields_set}
    return {key: given(value) if isinstance(value, BaseModel) else value for key, value in values.items()}


def _values(data: dict[str, Any]) -> dict[str, Any]:
    return {field_name(key): value for key, value in data.items() if key not in ("base", "creep")}


def _made(bogie: dict[str, Any]) -> dict[str, Any]:
    """Return the creep coefficients of a bogie that has them by the axle load."""
    found: dict[str, float] = {}
    if "creep" in bogie:
        with (mistakes := Mistakes()).under("bogie.creep"):
            found = creep_coefficients(bogie["W"], bogie["r"], **bogie["creep"])
        mistakes.report()
    return found


def _design(data: dict[str, Any]) -> Design:
    variables = {key: Variable(**bounds) for key, bounds in data.get("variables", {}).items()}
    catalogue = data.get("catalogue", ())
    return Design(objective=data.get("objective", "decay_rate"), variables=variables, catalogue=catalogue)
