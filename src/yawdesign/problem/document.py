"""YAML 1.2 texts as a tree in which every node knows where it stands.

The tree is built from the parser's events, so that size, depth and the expansion of aliases are bounded before
anything is built, and scalars stay texts: 626.48 never becomes a double on the way.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)
from ruamel.yaml.reader import ReaderError

from .characters import is_refused, joined, refusal
from .diagnostics import Diagnostic, ProblemError
from .syntax import explained, parser, unified

MOST_BYTES = 256 * 1024
MOST_NODES = 5_000
MOST_DEPTH = 20

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Node:
    """A piece of the text from character `start` to `end`.

    `size` counts the nodes in it and `depth` the levels of lists and mappings, aliases expanded.
    """

    start: int
    end: int
    size: int = 1
    depth: int = 0


@dataclass(frozen=True)
class Scalar(Node):
    """A single value."""

    text: str = ""
    plain: bool = True


@dataclass(frozen=True)
class Sequence(Node):
    """A list of values."""

    items: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Mapping(Node):
    """Values by key, with the nodes of the keys."""

    keys: dict[str, Node] = field(default_factory=dict)
    values: dict[str, Node] = field(default_factory=dict)


@dataclass
class Document:
    """A text, its tree, and the mistakes found in it so far."""

    text: str
    path: str
    root: Node = Node(0, 0)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def note(
        self,
        node: Node,
        message: str,
        key: str = "",
        severity: Literal["error", "warning"] = "error",
    ) -> Diagnostic:
        """Add a diagnostic about a piece of the text."""
        found = self._at(node, message, key, severity)
        self.diagnostics.append(found)
        return found

    def fail(self, node: Node, message: str) -> ProblemError:
        """Return the error that ends the reading here."""
        self.note(node, message)
        return ProblemError(self.diagnostics)

    def _at(self, node: Node, message: str, key: str, severity: Literal["error", "warning"]) -> Diagnostic:
        start = min(node.start, len(self.text))
        first = self.text.rfind("\n", 0, start) + 1
        last = self.text.find("\n", start)
        last = len(self.text) if last < 0 else last
        return Diagnostic(
            message=message,
            key=key,
            severity=severity,
            path=self.path,
            line=self.text.count("\n", 0, start) + 1,
            column=start - first + 1,
            source_line=self.text[first:last],
            length=max(1, min(node.end, last) - start),
        )

    def find(self, path: Path, *, key: bool = False) -> Node:
        """Return the node at a path, or the innermost around it; the key's with `key` or where there is no value."""
        node, name = self.root, Node(self.root.start, self.root.start + 1)
        for part in map(str, path):
            if isinstance(node, Mapping) and part in node.values:
                name, node = node.keys[part], node.values[part]
            elif isinstance(node, Sequence) and part.isdecimal() and int(part) < len(node.items):
                name = node = node.items[int(part)]
            else:
                return name
        nothing = isinstance(node, Scalar) and node.start == node.end
        return name if key or (nothing and path) else node


def compose(text: str, path: str) -> Document:
    """Parse a text.

    Raises
    ------
    ProblemError
        If it is no YAML, or too large; lesser mistakes are noted in the document.
    """
    document = Document(unified(text), path)
    if len(document.text) > MOST_BYTES:
        raise document.fail(Node(0, 0), f"the text is longer than {MOST_BYTES // 1024} KiB: this is no problem file")
    builder = _Builder(document)
    try:
        for event in parser().parse(document.text):
            builder.take(event)
    except ProblemError:
        raise
    except ReaderError as error:
        where = Node(int(error.position), int(error.position) + 1)
        raise document.fail(where, "holds a character that a text must not hold; is this a text file?") from None
    except MarkedYAMLError as error:
        index, message = explained(error, document.text)
        raise document.fail(Node(index, index + 1), message) from None
    except (YAMLError, ValueError, RecursionError) as error:
        raise document.fail(Node(0, 0), f"is not YAML: {type(error).__name__}") from None
    document.root = builder.root()
    return document


@dataclass
class _Open:
    """A sequence or mapping whose end has not come yet."""

    event: Any
    children: list[Node] = field(default_factory=list)


class _Builder:
    """Builds the tree from events, without recursion."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.open: list[_Open] = [_Open(None)]
        self.anchors: dict[str, Node] = {}
        self.size = 0

    def root(self) -> Node:
        """Return the finished tree."""
        found = self.open[0].children
        return found[0] if found else Scalar(0, 0)

    def take(self, event: Any) -> None:
        """Add what one event says."""
        if isinstance(event, DocumentStartEvent):
            self._one_document(event)
        elif isinstance(event, AliasEvent):
            self._add_alias(event)
        elif isinstance(event, ScalarEvent):
            self._add(event, Scalar(*_span(event), text=self._checked(event), plain=event.style is None))
        elif isinstance(event, (SequenceStartEvent, MappingStartEvent)):
            self._go_in(event)
        elif isinstance(event, (SequenceEndEvent, MappingEndEvent)):
            self._come_out(event)

    def _one_document(self, event: Any) -> None:
        if self.open[0].children:
            raise self.document.fail(Node(*_span(event)), "a file holds one problem: a second document starts here")

    def _checked(self, event: Any) -> str:
        """Return the text of a scalar; note characters that it must not hold, and leave them out."""
        value = joined(event.value)
        lines = value.replace("\n", " ")  # what is of one line is for those to say who use it
        why = refusal(lines)
        if why is None:
            return value
        self.document.note(Node(*_span(event)), why, ".".join(self._around()))
        return "".join(char for char in value if char == "\n" or not is_refused(char))

    def _go_in(self, event: Any) -> None:
        self.open.append(_Open(event))
        self._bound_depth(Node(*_span(event)))

    def _bound_depth(self, node: Node) -> None:
        if len(self.open) + node.depth > MOST_DEPTH:
            raise self.document.fail(node, f"is nested deeper than {MOST_DEPTH} levels")

    def _come_out(self, end: Any) -> None:
        inner = self.open.pop()
        size = 1 + sum(child.size for child in inner.children)
        depth = 1 + max((child.depth for child in inner.children), default=0)
        place = inner.event.start_mark.index, end.end_mark.index, size, depth
        if isinstance(end, SequenceEndEvent):
            self._add(inner.event, Sequence(*place, tuple(inner.children)))
        else:
            self._add(inner.event, self._mapping(Mapping(*place), inner.children))

    def _mapping(self, mapping: Mapping, children: list[Node]) -> Mapping:
        for key, value in zip(children[::2], children[1::2], strict=True):
            if not isinstance(key, Scalar):
                self.document.note(key, "is not a key: a key is a single word")
            elif key.text == "<<" and key.plain:
                self.document.note(key, "merge keys are not part of YAML 1.2: write the values out, or use base")
            elif key.text in mapping.keys:
                self.document.note(
                    key, f"stands twice, first {self._line_of(mapping.keys[key.text])}", self._dotted(key)
                )
            else:
                mapping.keys[key.text], mapping.values[key.text] = key, value
        return mapping

    def _line_of(self, node: Node) -> str:
        return f"on line {self.document.text.count(chr(10), 0, node.start) + 1}"

    def _dotted(self, key: Scalar) -> str:
        """Return the dotted name of a key of the mapping that has just ended."""
        return ".".join((*self._around(), key.text[:60]))

    def _around(self) -> list[str]:
        """Return the keys whose values are being read."""
        keys = [
            each.children[-1]
            for each in self.open
            if isinstance(each.event, MappingStartEvent) and len(each.children) % 2
        ]
        return [node.text[:60] for node in keys if isinstance(node, Scalar)]

    def _add(self, event: Any, node: Node) -> None:
        self._count(node, 1)
        if event.tag is not None:
            self.document.note(Node(*_span(event)), f"tags such as {str(event.tag)[:40]} have no meaning here")
        if event.anchor is not None:
            self.anchors[event.anchor] = node
        self.open[-1].children.append(node)

    def _add_alias(self, event: Any) -> None:
        place = Node(*_span(event))
        if event.anchor not in self.anchors:
            raise self.document.fail(place, f"*{event.anchor[:40]} names nothing that is complete by here")
        node = replace(self.anchors[event.anchor], start=place.start, end=place.end)
        self._count(node, node.size)
        self._bound_depth(node)
        self.open[-1].children.append(node)

    def _count(self, node: Node, more: int) -> None:
        self.size += more
        if self.size > MOST_NODES:
            raise self.document.fail(node, f"more than {MOST_NODES} values: this is no problem file")


def _span(event: Any) -> tuple[int, int]:
    return event.start_mark.index, event.end_mark.index


_NULL = re.compile(r"~|null|Null|NULL|")
_BOOLEANS = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")


def plain_data(node: Node) -> Any:
    """Return a tree as dicts, lists and scalars; numbers stay texts, so that their decimals are kept."""
    if isinstance(node, Mapping):
        return {key: plain_data(value) for key, value in node.values.items()}
    if isinstance(node, Sequence):
        return [plain_data(item) for item in node.items]
    return _scalar(node) if isinstance(node, Scalar) else None


def _scalar(node: Scalar) -> str | bool | float | None:
    if not node.plain:
        return node.text
    if _NULL.fullmatch(node.text):
        return None
    if _NOT_FINITE.fullmatch(node.text):
        return float(node.text.replace(".", "", 1))
    return _BOOLEANS.get(node.text, node.text)
