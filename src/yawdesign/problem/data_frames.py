"""Results as tables of pandas: a row for each entry, a column for each number, SI units beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, get_args, get_origin

from .diagnostics import ProblemError, unknown_key
from .parameters import PARAMETERS
from .running import CURVE

if TYPE_CHECKING:
    import pandas

# SI units of what is called the same in all results.
UNITS = {
    **{key: row.si for key, row in {**PARAMETERS, **CURVE}.items()},
    **dict.fromkeys(("decay_rate", "decay_rate_rigid", "eigenvalue", "fitted_rate", "spectral_abscissa"), "1/s"),
    **dict.fromkeys(("frequency", "corner_frequency", "hunting_frequency"), "Hz"),
    **dict.fromkeys(("speed", "v"), "m/s"),
    **dict.fromkeys(("C_sl", "C_su", "C_each", "damping", "damping_after"), "N·s/m"),
    **dict.fromkeys(("duration", "step", "time"), "s"),
    **dict.fromkeys(("wavelength", "distance"), "m"),
    **dict.fromkeys(("blow_off", "force_rms", "force_peak"), "N"),
    **{"omega": "rad/s", "stiffness": "N/m", "phase": "rad", "wavenumber": "rad/m"},
    **dict.fromkeys(("damping_ratio", "rotational_resistance", "loss_factor", "creep_factor", "certainty"), "-"),
}


def data_frame(columns: Mapping[str, Any], units: Mapping[str, str] | None = None) -> pandas.DataFrame:
    """Return a table of pandas; ``attrs["units"]`` has the SI unit of each column that has one.

    Raises
    ------
    ProblemError
        If pandas is not installed.
    """
    try:
        library = import_module("pandas")
    except ImportError:
        raise ProblemError("pandas is not installed: pip install 'yawdesign[pandas]'") from None
    frame: pandas.DataFrame = library.DataFrame(dict(columns))
    known = {name: UNITS[name.rpartition(".")[2]] for name in columns if name.rpartition(".")[2] in UNITS}
    frame.attrs["units"] = {name: unit for name, unit in {**known, **(units or {})}.items() if name in columns}
    return frame


def tables_in(result: Any) -> dict[str, dict[str, list[Any]]]:
    """Return the columns of every field of a result that has rows: a tuple of records, or records by name."""
    found = {}
    for field in fields(result):
        value, origin, inside = getattr(result, field.name), get_origin(field.type), get_args(field.type)
        if origin is tuple and _is_record(inside[0]):
            found[field.name] = _columns([dict(_cells(entry)) for entry in value], inside[0])
        elif origin is Mapping and is_dataclass(inside[1]):
            rows = [{"name": name, **dict(_cells(entry))} for name, entry in value.items()]
            found[field.name] = _columns(rows, inside[1])
    return found


def only_row(result: Any) -> dict[str, list[Any]]:
    """Return what a result without rows has to say: one row."""
    return {name: [value] for name, value in _cells(result)}


def chosen_table(result: Any, tables: Mapping[str, Any], of: str | None) -> str:
    """Return the name of a table of a result: the first if none is asked for."""
    if of is None:
        return next(iter(tables))
    if of not in tables:
        known = ", ".join(tables)
        raise ProblemError(f"of: {of} {unknown_key(of, tables)}; the tables of {type(result).__name__}: {known}")
    return of


def _columns(rows: list[dict[str, Any]], kind: Any) -> dict[str, list[Any]]:
    """Return the columns of rows, None where a row has no such entry; of no rows those that they would have."""
    there = [] if get_origin(kind) or rows else [field.name for field in fields(kind)]
    names = dict.fromkeys(name for row in rows for name in row) or dict.fromkeys(there)
    return {name: [row.get(name) for row in rows] for name in names}


def _is_record(kind: Any) -> bool:
    """Return whether a type, or a value, is one of records: a dataclass or a mapping."""
    return is_dataclass(kind) or get_origin(kind) is Mapping or isinstance(kind, Mapping)


def _cells(record: Any, before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the entries of a record; those of one in it are called ``worst_condition.speed``, lists are left out."""
    names = record if isinstance(record, Mapping) else [field.name for field in fields(record)]
    for name in names:
        value = record[name] if isinstance(record, Mapping) else getattr(record, name)
        if _is_record(value):
            yield from _cells(value, f"{before}{name}.")
        elif not isinstance(value, (tuple, list)) and not hasattr(value, "tolist"):
            yield f"{before}{name}", value
