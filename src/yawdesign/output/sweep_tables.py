"""Sweeps as tables for a terminal; nothing is computed here."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table

from yawdesign.output.sweep_style import shown_unit
from yawdesign.output.tables import facts, verified
from yawdesign.problem import format_quantity
from yawdesign.study.axes import ROWS, Axis
from yawdesign.study.result import Sweep

ROWS_SHOWN = 12

GOOD = {
    "critical": "stable for some C_s",
    "C_sl": "stable for some C_s",
    "design": "with a design",
    "critical_speed": "stable at some speed",
}


def sweep_tables(sweep: Sweep) -> RenderableType:
    """Return the tables of a `Sweep`."""
    return Group(facts(f"Sweep of {sweep.of}", _facts(sweep)), *([_curve(sweep)] if len(sweep.axes) == 1 else []))


def _facts(sweep: Sweep) -> Iterator[tuple[str, str]]:
    for axis in sweep.axes:
        low, high = (_text(axis.name, axis.values[k]) for k in (0, -1))
        yield f"over {axis.name}", f"{low} ... {high}, {axis.values.size} values" if axis.values.size > 1 else low
    if sweep.conditions:
        yield "under every combination of", sweep.conditions
    points = sweep.finished.size
    yield "points", f"{points}"
    yield GOOD.get(sweep.quantity, "stable"), _share(sweep.good.sum(), points)
    yield from _extremes(sweep)
    if "count" in sweep.columns:
        yield "with several values", _share((sweep.columns["count"] > 1).sum(), points)
    if "status" in sweep.columns:
        yield from ((f"status: {text}", _share(n, points)) for text, n in _counted(sweep.columns["status"]))
    yield "computed again the thorough way", _share(sweep.recomputed.sum(), points)
    wrong = int(sweep.unverified.sum())
    yield "checked", f"NO at {wrong} points: two ways differ there" if wrong else verified(True)
    yield "time", f"{sweep.provenance['seconds']:.3g} s"


def _counted(texts: Any) -> Iterator[tuple[str, int]]:
    yield from zip(*(x.tolist() for x in np.unique(texts, return_counts=True)), strict=True)


def _share(number: int, points: int) -> str:
    return f"{number} ({100 * number / points:.4g} %)"


def _text(name: str, value: float) -> str:
    return format_quantity(float(value), ROWS[name].unit)


def _value(sweep: Sweep, value: float) -> str:
    return format_quantity(float(value), shown_unit(sweep))


def _extremes(sweep: Sweep) -> Iterator[tuple[str, str]]:
    values = sweep.main
    if values.dtype.kind != "f" or not np.isfinite(values).any():
        return
    for name, find in (("least", np.nanargmin), ("most", np.nanargmax)):
        place = np.unravel_index(find(values), values.shape)
        where = ", ".join(f"{x.name} = {_text(x.name, x.values[k])}" for x, k in zip(sweep.axes, place, strict=False))
        yield name, f"{_value(sweep, values[place])} at {where}"


def _curve(sweep: Sweep) -> Table:
    (axis,) = sweep.axes
    table = Table(title=_title(axis), title_justify="left", title_style="bold")
    table.add_column(axis.name, justify="right")
    table.add_column(sweep.of, justify="right")
    for k in np.unique(np.linspace(0, axis.values.size - 1, ROWS_SHOWN).round().astype(int)):
        table.add_row(_text(axis.name, axis.values[k]), _cell(sweep, int(k)))
    return table


def _title(axis: Axis) -> str:
    return "Values" if axis.values.size <= ROWS_SHOWN else f"Some of the {axis.values.size} values"


def _cell(sweep: Sweep, k: int) -> str:
    value = sweep.values[k]
    if not sweep.known[k]:
        return "NOT VERIFIED"
    if isinstance(value, tuple):
        return ", ".join(_value(sweep, x) for x in value) or "none"
    if sweep.quantity == "stable":
        return "yes" if value else "no"
    return _value(sweep, value) if np.isfinite(value) else "none"
