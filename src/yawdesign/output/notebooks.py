"""Problems and results as a notebook shows them."""

from typing import Any

from yawdesign.output.markup import tables
from yawdesign.output.tables_by_result import tables_of

STYLE = (
    ".yawdesign table{border-collapse:collapse;margin:.5em 0 1em}"
    ".yawdesign caption{text-align:left;font-weight:bold;padding:.2em 0;color:inherit}"
    ".yawdesign th,.yawdesign td{text-align:left;padding:.15em .8em .15em 0;white-space:pre-line;max-width:40em}"
    ".yawdesign tbody th{font-weight:normal}"
    ".yawdesign .number{text-align:right;font-variant-numeric:tabular-nums}"
)


def html(result: Any) -> str:
    """Return the tables of a problem or of a result, with the little style that they need."""
    return f'<div class="yawdesign"><style>{STYLE}</style>\n{tables(tables_of(result))}\n</div>'
