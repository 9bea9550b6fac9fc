"""How problems and results look in a notebook: as HTML, which the package's edge knows how to make."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar


class NotebookView:
    """What a notebook shows as tables, wherever somebody has said how they are made."""

    made_by: ClassVar[Callable[[Any], str] | None] = None

    def _repr_html_(self) -> str | None:
        """Return its tables as HTML; None lets a notebook show the plain text."""
        make = NotebookView.made_by
        return None if make is None else make(self)
