"""Characters that no text of a problem may hold, and how they are shown in messages."""

from __future__ import annotations

import unicodedata

_TURNS = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"  # the direction of what follows
_FORMULA = ("=", "+", "-", "@")  # with which a spreadsheet takes a text for a formula
_LINE_ENDS = "\n\r\x0b\x0c\x85\u2028\u2029"


def refusal(text: str) -> str | None:
    r"""Return why a text of one line is refused, or None.

    Line ends, control characters and what is no character at all are refused: files, tables and pictures are made
    from texts, and not all of them can hold these.

    Examples
    --------
    >>> refusal("bogie 1"), refusal("a\x07")
    (None, 'holds the control character U+0007')
    """
    wrong = next((char for char in text if is_refused(char)), None)
    if wrong is None:
        return None
    point = f"U+{ord(wrong):04X}"
    if wrong in _LINE_ENDS:
        return f"holds a line end, {point}: write it in one line"
    if unicodedata.category(wrong) == "Cc":
        return f"holds the control character {point}"
    return f"holds {point}, which is no character"


def is_refused(char: str) -> bool:
    """Return whether a character is a line end, a control character or none at all."""
    no_character = ord(char) & 0xFFFE == 0xFFFE or 0xFDD0 <= ord(char) <= 0xFDEF
    return no_character or unicodedata.category(char) in ("Cc", "Cs", "Zl", "Zp")


def joined(text: str) -> str:
    r"""Return a text in which both halves of a character, as JSON escapes write it, are that character.

    Examples
    --------
    >>> joined("\ud83d\ude84") == "\U0001f684"
    True
    """
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "surrogatepass")


def visible(text: str) -> str:
    r"""Return a text with every refused character as its escape sequence, so that a terminal shows it.

    Examples
    --------
    >>> visible("a\x07")
    'a\\x07'
    """
    return "".join(char.encode("unicode_escape").decode() if is_refused(char) else char for char in text)


def in_order(text: str) -> str:
    r"""Return a text that a terminal shows in the order of its letters, whatever it holds.

    What is refused, line ends apart, and what turns the direction of all that follows are shown as a sign of their own.

    Examples
    --------
    >>> in_order("a\u202eb") == "a\ufffdb"
    True
    """
    return "".join("\ufffd" if char in _TURNS or (char not in "\n\t" and is_refused(char)) else char for char in text)


def no_formula(text: str) -> str:
    """Return a text as a cell of a table that a spreadsheet shows, whatever it begins with, and does not compute.

    Examples
    --------
    >>> no_formula("laden"), no_formula("=1+1")
    ('laden', "'=1+1")
    """
    return f"'{text}" if text.startswith(_FORMULA) else text


def printable(text: str) -> str:
    r"""Return a text on one line, with a blank for each character that cannot be printed.

    Examples
    --------
    >>> printable("a\tbogie\x07, µ = 0.3")
    'a bogie , µ = 0.3'
    """
    return "".join(char if char.isprintable() else " " for char in text)
