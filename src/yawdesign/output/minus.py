"""The minus sign of numbers that are read: in pictures and on pages, and never in files that programs read."""

import re

MINUS = "\u2212"
_HYPHEN = re.compile(r"(?<![\w)\]}.,\u2212-])-(?=\.?\d)")  # before a number, and not inside of a name or a power of ten


def with_minus(text: str) -> str:
    """Return a text whose negative numbers have the minus sign of print in place of a hyphen.

    Examples
    --------
    >>> with_minus("Y-150 at -5.2 1/s, 1e-05") == f"Y-150 at {MINUS}5.2 1/s, 1e-05"
    True
    """
    return _HYPHEN.sub(MINUS, text)
