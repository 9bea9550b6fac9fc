"""Determinants of sparse polynomial matrices, and the independent parts that their graphs fall into."""

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from yawdesign.vehicle.polynomials import ONE, ZERO, Polynomial, add, multiply, product, scale

Node = Hashable
N = TypeVar("N", bound=Hashable)
Matrix = Mapping[tuple[Any, Any], Polynomial]


def _neighbours(edges: Iterable[tuple[N, N]]) -> dict[N, list[N]]:
    rows: dict[N, list[N]] = {}
    for i, j in edges:
        rows.setdefault(i, [])
        rows.setdefault(j, [])
        if i != j and j not in rows[i]:
            rows[i].append(j)
    return rows


def _reachable(start: N, rows: Mapping[N, Sequence[N]], nodes: frozenset[N]) -> frozenset[N]:
    found, queue = {start}, [start]
    while queue:
        new = [j for j in rows[queue.pop()] if j in nodes and j not in found]
        found.update(new)
        queue.extend(new)
    return frozenset(found)


def _pieces(nodes: Iterable[N], *ways: Mapping[N, Sequence[N]]) -> list[frozenset[N]]:
    """Return the parts of some nodes of a graph within which each node reaches each other on all of the ways."""
    pieces, rest = [], list(nodes)
    inside = frozenset(rest)
    while rest:
        piece = frozenset.intersection(*(_reachable(rest[0], rows, inside) for rows in ways))
        pieces.append(piece)
        rest = [i for i in rest if i not in piece]
    return sorted(pieces, key=len)


def reached_from(start: N, edges: Iterable[tuple[N, N]]) -> frozenset[N]:
    """Return a node of a graph and all that its edges lead to from there.

    Examples
    --------
    >>> sorted(reached_from(2, [(1, 2), (2, 1), (3, 2), (2, 4)]))
    [1, 2, 4]
    """
    rows = _neighbours(edges)
    return _reachable(start, rows, frozenset(rows))


def independent_parts(edges: Sequence[tuple[N, N]]) -> list[frozenset[N]]:
    """Return the strongly connected parts of a graph: in each of them everything acts on everything else, and back.

    Parameters
    ----------
    edges : sequence of (row, column)
        Where a matrix has entries; an entry on the diagonal makes a node that may stand alone.

    Examples
    --------
    >>> [sorted(part) for part in independent_parts([(1, 2), (2, 1), (2, 3), (3, 3)])]
    [[3], [1, 2]]
    """
    rows, columns = _neighbours(edges), _neighbours((j, i) for i, j in edges)
    return _pieces(rows, rows, columns)


class Determinant:
    """Determinants of a sparse polynomial matrix and of its principal minors, without any division.

    The determinant is the sum over all ways to cover the nodes of the matrix's graph by cycles. A node is taken out,
    the rest falls apart into pieces, and each piece contributes its own determinant or the cycles that lead through it
    and the node. For a tree this is the recursion from the leaves to the root: the work grows with the number of nodes,
    and with the signs that springs and dampers have, nothing cancels.

    Parameters
    ----------
    entries : mapping (row, column) -> polynomial
        The entries that are not structurally zero.
    """

    def __init__(self, entries: Matrix) -> None:
        self.entries = entries
        self._rows = _neighbours(entries)
        self._columns = _neighbours((j, i) for i, j in entries)
        self._both = _neighbours([*entries, *((j, i) for i, j in entries)])
        self._known: dict[frozenset[Node], Polynomial] = {}

    @property
    def nodes(self) -> frozenset[Node]:
        """All rows of the matrix."""
        return frozenset(self._rows)

    def factors(self, nodes: frozenset[Node]) -> list[frozenset[Node]]:
        """Return the strongly connected pieces of a set of nodes: the determinant is the product over them."""
        return _pieces(self._inside(nodes), self._rows, self._columns)

    def of(self, nodes: frozenset[Node]) -> Polynomial:
        """Return the principal minor over the given nodes."""
        if nodes not in self._known:
            pieces = self.factors(nodes)
            one = len(pieces) == 1
            self._known[nodes] = self._expand(nodes) if one else product(self.of(piece) for piece in pieces)
        return self._known[nodes]

    def _inside(self, nodes: frozenset[Node]) -> list[Node]:
        return [i for i in self._rows if i in nodes]

    def _expand(self, nodes: frozenset[Node]) -> Polynomial:
        root = max(self._inside(nodes), key=lambda i: sum(j in nodes for j in self._rows[i]))
        return self.rooted(root, nodes, self.entries.get((root, root), ZERO))

    def rooted(self, root: Node, nodes: frozenset[Node], diagonal: Polynomial) -> Polynomial:
        """Return the minor over the given nodes, with another diagonal entry at root."""
        value, rest, alone = diagonal, ONE, ONE
        for piece in _pieces(self._inside(nodes - {root}), self._both):
            rest = multiply(rest, alone)  # of the pieces before this one
            alone = self.of(piece)
            value = add(multiply(value, alone), multiply(self._through(root, piece), rest))
        return value

    def _through(self, root: Node, piece: frozenset[Node]) -> Polynomial:
        """Return the sum over all cycles of two or more nodes through root, the others in the piece."""
        total = ZERO
        for cycle in self._cycles(root, piece):
            total = add(total, multiply(self._weight(cycle), self.of(piece - set(cycle))))
        return total

    def _weight(self, cycle: Sequence[Node]) -> Polynomial:
        edges = zip(cycle, (*cycle[1:], cycle[0]), strict=True)
        weight = product(self.entries[edge] for edge in edges)
        return weight if len(cycle) % 2 else scale(weight, -1)

    def _cycles(self, root: Node, piece: frozenset[Node]) -> Iterator[tuple[Node, ...]]:
        stack: list[tuple[Node, ...]] = [(root,)]
        while stack:
            path = stack.pop()
            for j in self._rows[path[-1]]:
                if j == root and len(path) > 1:
                    yield path
                elif j in piece and j not in path:
                    stack.append((*path, j))
