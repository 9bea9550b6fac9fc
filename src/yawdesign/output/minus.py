"""The minus sign of numbers that are read: in pictures and on pages, and never in files that programs read."""

import re

MINUS = "\u2212"
# Before a whole number, and not inside of a name, a power of ten, or a text that goes on as a formula.
_HYPHEN = re.compile(r"(?<![\w)\]}.,\u2212-])-(?=\.?\d[\d.,\s]*(?:e[+-]?\d+)?(?![\w+*/@=-]))")


def with_minus(text: str) -> str:
    r"""Return a text whose negative numbers have the minus sign of print in place of a hyphen.

    Examples
    --------
    >>> with_minus("Y-150 at -5.2 1/s, 1e-05") == f"Y-150 at {MINUS}5.2 1/s, 1e-05"
    True
    >>> with_minus("-2+3, -5.2e-05")
    '-2+3, −5.2e-05'
    """
    return _HYPHEN.sub(MINUS, text)
