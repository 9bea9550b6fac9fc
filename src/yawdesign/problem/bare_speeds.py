"""Speeds without a unit in data: m/s, and whoever may have meant km/h is told so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from numbers import Real
from typing import Any

from .diagnostics import ProblemError
from .requirements import MEASURES
from .running import CURVE, SPEED, is_fast_for
from .table import Parameter, as_several


def warn_of_bare_speeds(data: Mapping[str, Any], *, whole: bool) -> None:
    """Warn of speeds in right data of a problem that may have been meant in km/h; of a single `whole` number too."""
    speed = data["speed"]
    if (
        whole and isinstance(speed, Real) and SPEED.check(speed).exact.denominator == 1
    ):  # a computed speed is hardly whole
        SPEED.accept(speed, doubtful=True)
        data = {key: value for key, value in data.items() if key != "speed"}
    for row, value, doubtful in _speeds(data):
        with suppress(ProblemError):
            row.accept(value, doubtful=doubtful)


def _speeds(data: Mapping[str, Any]) -> Iterator[tuple[Parameter, Any, bool]]:
    speed = data.get("speed", ())
    ends = (speed[key] for key in ("min", "max")) if isinstance(speed, Mapping) else as_several(speed)
    yield from ((SPEED, value, False) for value in ends)
    curve = data.get("curve")
    if curve:
        yield CURVE["V_r"], curve["V_r"], is_fast_for(curve["V_r"], curve["R"])
    wanted = data.get("requirements") or {}
    for values in (wanted, wanted.get("cases", {})) if isinstance(wanted, Mapping) else ():
        if "critical_speed" in values:
            yield MEASURES["critical_speed"], values["critical_speed"], False
