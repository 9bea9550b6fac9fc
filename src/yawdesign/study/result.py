"""What a sweep returns: values with their axes, units and origin."""

import platform
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from yawdesign import __version__
from yawdesign.hunting.arrays import Array, Bools
from yawdesign.problem import ProblemError
from yawdesign.problem.condition_texts import SHOWN, change_text, range_text
from yawdesign.problem.diagnostics import unknown_key
from yawdesign.problem.result import plain
from yawdesign.problem.table import field_name
from yawdesign.study.axes import shape
from yawdesign.study.chart import Chart, charted
from yawdesign.study.kept_file import KeptFile
from yawdesign.study.labelled_data import MAIN, LabelledData
from yawdesign.study.request import QUANTITIES, UNITS, Request
from yawdesign.study.store import MASKS, Store


@dataclass(frozen=True, repr=False, eq=False)
class Sweep(LabelledData):
    """Answers on a grid: data with labels, and the request that they answer.

    Parameters
    ----------
    boundary : Sweep or None
        All critical values over the other axis of a map over C_s, and over the axis of ``C_sl`` and ``design``.
    chart : Chart or None
        What a picture shows beside the values: where the verdict changes between the points, the curve's limit, what
        the problem itself has.
    request : Request
        What was asked for, with the problem.
    """

    boundary: "Sweep | None"
    chart: Chart | None
    request: Request

    @property
    def values(self) -> Array:
        """The answers [`unit`], one dimension for each axis; of several values at a point a tuple."""
        several = self.main.ndim > len(self.axes)
        return _tuples(self.main) if several else self.main

    @property
    def conditions(self) -> str:
        """Under which conditions an answer holds, beside what the axes vary; of a range those that were looked at."""
        told = [each.described for each in self.request.task.question.conditions]
        names = dict.fromkeys(name for each in told for name in each)
        values = {name: dict.fromkeys(each[name] for each in told if name in each) for name in names}
        return ", ".join(_values_told(name, *values[name]) for name in names)

    @property
    def good(self) -> Bools:
        """Points that are stable; where no C_s is given, points that some C_s makes stable (`design`: has a design)."""
        if "unstable_roots" in self.columns:
            good: Bools = np.any(self.columns["unstable_roots"] == 0, axis=-1)
        elif self.quantity in ("C_sl", "design"):
            good = np.isfinite(self.main)
        else:
            good = np.asarray(self.main > 0)
        return self.known & good

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, nested by axis in the order given; None where is no answer."""
        columns = {name: self._nested(x) for name, x in self.columns.items() if x is not self.main}
        return {
            **{"of": self.of, "quantity": self.quantity, "unit": self.unit, "axes": plain(self.axes)},
            **{"values": self._nested(self.main), "columns": {**columns, "checked": self.known.tolist()}},
            "units": {name: UNITS[name] for name in self.columns},
            "boundary": self.boundary.to_dict() if self.boundary else None,
            "conditions": self.conditions,
            "provenance": plain(self.provenance),
        }

    def _nested(self, column: Array) -> Any:
        several = column.ndim > len(self.axes)
        flat = column.reshape(self.known.size, *column.shape[len(self.axes) :])
        rows = [_row(x) for x in flat] if several else plain(flat)
        out = np.empty(self.known.size, dtype=object)
        for k, known in enumerate(self.known.ravel()):
            out[k] = rows[k] if known else None
        return out.reshape(self.known.shape).tolist()

    def at(self, **place: float) -> "Sweep":
        """Return the sweep with one axis less, at the value nearest to the one given.

        Parameters
        ----------
        **place
            Name of an axis and a value in SI.
        """
        ((name, value),) = place.items()
        names = [field_name(axis.name) for axis in self.axes]
        if name not in names:
            raise ProblemError(f"{name} {unknown_key(name, names)}; the axes are {', '.join(names)}")
        k = names.index(name)
        nearest = int(np.argmin(np.abs(self.axes[k].values - value)))
        masks = {n: np.take(x, nearest, axis=k) for n, x in self._masks().items()}
        columns = {n: np.take(x, nearest, axis=k) for n, x in self.columns.items()}
        axes = (*self.axes[:k], *self.axes[k + 1 :])
        at = {**self.provenance.get("at", {}), self.axes[k].name: float(self.axes[k].values[nearest])}
        plane = replace(
            self,
            axes=axes,
            columns=columns,
            **masks,
            boundary=None,
            chart=None,
            provenance={**self.provenance, "at": at},
        )
        if self.chart is not None and self.axes[k].values.size == 1:
            return replace(plane, chart=self.chart.without(k))
        return replace(plane, chart=charted(self.request, axes, columns, plane.known, at))

    def keep(self, path: str | PathLike[str]) -> None:
        """Write what is finished, of an interrupted sweep say, for ``resume=path``.

        Parameters
        ----------
        path : path
            Name of the file. What it keeps of the same sweep stays in it.

        Raises
        ------
        ProblemError
            If there is a file that does not belong to this sweep, or this is a part of one.
        OSError
            If it cannot be written.
        """
        if self.finished.size != self.request.size:
            raise ProblemError("this is a part of a sweep: keep the whole one")
        store = Store(self.request.size)
        for name in MASKS:
            setattr(store, name, getattr(self, name).ravel().copy())
        several = len(self.axes)
        if store.finished.any():
            store.columns = {n: x.reshape(store.size, *x.shape[several:]).copy() for n, x in self.columns.items()}
        KeptFile(Path(path), self.request).write(store)

    def __repr__(self) -> str:
        grid = " x ".join(f"{axis.name} ({axis.values.size})" for axis in self.axes)
        counts = {name: int(getattr(self, name).sum()) for name in ("good", "recomputed", "unverified")}
        unfinished = self.finished.size - int(self.finished.sum())
        rows = {"points": self.finished.size, **counts} | ({"unfinished": unfinished} if unfinished else {})
        lines = [f"  {name:<10}  {value}" for name, value in rows.items()]
        return "\n".join([f"Sweep of {self.of} [{self.unit}] over {grid}", *lines])


def _values_told(name: str, *values: Any) -> str:
    if len(values) <= SHOWN or name == "load":
        return change_text(name, *values)
    return f"{range_text(name, (min(values), max(values)))} ({len(values)} values)"


def _row(values: Array) -> list[Any]:
    return plain(values[~np.isnan(values)]) if values.dtype.kind == "f" else plain(values)  # type: ignore[no-any-return]


def _tuples(column: Array) -> Array:
    out = np.empty(column.shape[:-1], dtype=object)
    for place in np.ndindex(out.shape):
        row = column[place]
        out[place] = tuple(row[~np.isnan(row)].tolist())
    return out


def gathered(asked: Request, store: Store, seconds: float, boundary: Sweep | None = None) -> Sweep:
    """Return the result of a sweep from what was stored."""
    grid = shape(asked.axes)
    quantity = asked.task.question.of
    columns = {name: x.reshape(*grid, *x.shape[1:]) for name, x in store.columns.items()}
    columns.setdefault(MAIN.get(quantity, quantity), np.full(grid, np.nan))
    return Sweep(
        of=asked.of,
        quantity=quantity,
        unit=QUANTITIES[quantity],
        axes=asked.axes,
        columns=columns,
        finished=store.finished.reshape(grid),
        recomputed=store.recomputed.reshape(grid),
        unverified=store.unverified.reshape(grid),
        provenance=_provenance(asked, store, seconds),
        boundary=boundary,
        chart=None,
        request=asked,
    )


def _provenance(asked: Request, store: Store, seconds: float) -> dict[str, Any]:
    versions = {"yawdesign": __version__, "python": platform.python_version()}
    return {
        "problem": asked.problem.to_dict(),
        "hold": asked.task.hold,
        "versions": versions | {name: import_module(name).__version__ for name in ("numpy", "casadi")},
        "points": store.size,
        **{name: int(getattr(store, name).sum()) for name in MASKS},
        "seconds": round(seconds, 3),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
