"""YAML 1.2 as the parser is told to read it, and what it says in our words."""

from __future__ import annotations

import re

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.scanner import Scanner


def unified(text: str) -> str:
    """Return the text without byte order mark, with one kind of line end and with blanks for tabs before it.

    So positions are those of an editor.
    """
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    return _WHITE_END.sub(lambda white: " " * len(white[0]), text)


_WHITE_END = re.compile(r"(?<![ \t])[ \t]+$", re.MULTILINE)


class _Scanner(Scanner):
    """Takes tabs for what they are in YAML 1.2: they separate as blanks do, but they do not indent."""

    def scan_to_next_token(self) -> None:
        """Go to the next token, over tabs too where something other than white space stands before them."""
        super().scan_to_next_token()
        while self.reader.peek() == "\t" and not self._indents():
            while self.reader.peek() in " \t":
                self.reader.forward()
            self.allow_simple_key = self.allow_simple_key and bool(self.flow_level)
            super().scan_to_next_token()

    def _indents(self) -> bool:
        """Return whether the white space before the next token begins the line of a block."""
        if self.flow_level:
            return False
        mark = self.reader.get_mark()
        line = mark.buffer.rfind("\n", 0, mark.pointer) + 1
        return not (mark.buffer[line : mark.pointer].strip() or _COMMENT.match(mark.buffer, mark.pointer))


_COMMENT = re.compile(r"[ \t]*#")


def parser() -> YAML:
    """Return a parser of YAML 1.2."""
    made = YAML(typ="safe", pure=True)
    made.Scanner = _Scanner
    return made


# What the parser says in its words, what that means, and whether the mistake is where the piece began.
_SYNTAX = (
    ("could not find expected ':'", "a key is followed by a colon and a blank", True),
    ("found unexpected end of stream", "the quote that opens here is not closed", True),
    ("expected ',' or", "the bracket that opens here is not closed, or a comma is missing in it", True),
    ("mapping values are not allowed", "no second ': ' may stand here: look at the indentation and at quotes", False),
    ("expected <block end>", "does not continue what stands above: look at the indentation", False),
    ("cannot start any token", "this character cannot begin a value: put the value in quotes", False),
)


def explained(error: MarkedYAMLError, text: str) -> tuple[int, str]:
    """Return where a text stops being YAML and why, in our words."""
    said = (error.problem or error.context or "cannot be read").strip().replace("\n", " ")
    known = (row[1:] for row in _SYNTAX if row[0] in said)
    meaning, from_start = next(known, (said[:120], False))
    mark = (error.context_mark if from_start else None) or error.problem_mark or error.context_mark
    index = min(int(mark.index), len(text)) if mark is not None else 0
    about_tab = _explained_tab(text, index)
    if about_tab:
        return index, about_tab
    if index >= len(text):
        index = max(0, len(text.rstrip()) - 1)  # show the last line that says something
    return index, f"is not YAML: {meaning}"


def _explained_tab(text: str, index: int) -> str | None:
    """Return what is wrong where a tab is why a text cannot be read."""
    before = text[text.rfind("\n", 0, index) + 1 : index]
    if text[index : index + 1] == "\t":
        return "put a blank in place of this tab" if before.strip() else "indent with blanks: YAML allows no tab here"
    if re.match(r" *[-?:][ \t]*\t", before):
        return "a tab does not indent what follows it: put blanks in its place"
    if before.endswith("\t"):
        return "no tab may stand inside a value: put a blank in its place"
    return None
