"""The data of a problem file, with presets filled in and checked, as the parts of a problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from .diagnostics import ProblemError
from .faults import Fault, disagreements, faults, placed
from .file_shape import parts_of, problem_model
from .presets import kind_of_bogie, with_presets


@dataclass(frozen=True)
class FileData:
    """What data say of a problem.

    Parameters
    ----------
    filled : dict
        The data with the values of presets.
    parts : dict
        What the constructor of a problem takes; nothing if there are mistakes.
    faults : list of Fault
        The mistakes.
    """

    filled: dict[str, Any]
    parts: dict[str, Any] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)


def checked_data(data: Mapping[str, Any]) -> FileData:
    """Return what data with the keys of a problem file say of a problem."""
    filled, complete = with_presets(data)
    kind = kind_of_bogie(data)
    by_creep = isinstance(filled.get("bogie"), dict) and "creep" in filled["bogie"]
    try:
        return FileData(filled, parts_of(problem_model(kind, complete, by_creep=by_creep).model_validate(filled)))
    except ValidationError as error:
        return FileData(filled, faults=[*faults(error, kind), *disagreements(filled, kind)])
    except ProblemError as error:
        return FileData(filled, faults=placed(filled, error.diagnostics))
