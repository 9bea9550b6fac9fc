"""Polynomials with coefficients of any number type: floats, NumPy arrays, CasADi SX, rationals, complex numbers.

A polynomial is a tuple of coefficients, lowest power first. The Python integer 0 is a *structural* zero: it is known
not to be there, and no operation is spent on it. So a sparse model stays sparse whatever its numbers are.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import reduce
from typing import Any

Number = Any  # float, ndarray, SX, Fraction, fmpq, complex: whatever adds, subtracts and multiplies
Polynomial = tuple[Number, ...]
Node = Hashable
Matrix = Mapping[tuple[Any, Any], Polynomial]

ZERO: Polynomial = ()
ONE: Polynomial = (1,)


def _is_int(x: Number, value: int) -> bool:
    return type(x) is int and x == value


def plus(x: Number, y: Number) -> Number:
    """Return x + y without an operation where one of them is structurally zero."""
    if _is_int(x, 0):
        return y
    return x if _is_int(y, 0) else x + y


def times(x: Number, y: Number) -> Number:
    """Return x * y without an operation where one of them is structurally zero or one."""
    if _is_int(x, 0) or _is_int(y, 0):
        return 0
    if _is_int(x, 1):
        return y
    return x if _is_int(y, 1) else x * y


def add(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p + q."""
    if len(p) < len(q):
        p, q = q, p
    return tuple(plus(a, b) for a, b in zip(p, q, strict=False)) + p[len(q) :]


def scale(p: Polynomial, factor: Number) -> Polynomial:
    """Return factor * p."""
    return tuple(times(a, factor) for a in p)


def multiply(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p * q."""
    if not p or not q:
        return ZERO
    out: list[Number] = [0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] = plus(out[i + j], times(a, b))
    return tuple(out)


def product(factors: Iterable[Polynomial]) -> Polynomial:
    """Return the product of polynomials, shortest first (fewest operations)."""
    return reduce(multiply, sorted(factors, key=len), ONE)


def evaluate(p: Polynomial, s: Number) -> Number:
    """Return p(s) by Horner's rule."""
    return reduce(lambda value, a: plus(times(value, s), a), reversed(p), 0)


def trim(p: Polynomial, is_zero: Callable[[Number], bool] = lambda a: bool(a == 0)) -> Polynomial:
    """Return p without leading coefficients that are zero (a damper with no damping lowers the degree)."""
    end = len(p)
    while end and is_zero(p[end - 1]):
        end -= 1
    return p[:end]


def even_odd(p: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Return the even part E(x) and the odd part O(x) of p(j w) = E(x) + j w O(x), x = w^2."""
    even, odd = (tuple(times((-1) ** k, a) for k, a in enumerate(half)) for half in (p[::2], p[1::2]))
    return even, odd


def derivative(p: Polynomial) -> Polynomial:
    """Return dp/ds."""
    return tuple(times(k, a) for k, a in enumerate(p))[1:]


def scale_variable(p: Polynomial, unit: Number) -> Polynomial:
    """Return p(unit * s): with unit = 100 rad/s the coefficients of a bogie span 1e10 instead of 1e46."""
    out, power = [], 1
    for a in p:
        out.append(times(a, power))
        power = power * unit
    return tuple(out)


def shift(p: Polynomial, sigma: Number) -> Polynomial:
    """Return p(s + sigma) by repeated synthetic division."""
    out = list(p)
    for start in range(len(out) - 1):
        for k in range(len(out) - 2, start - 1, -1):
            out[k] = plus(out[k], times(sigma, out[k + 1]))
    return tuple(out)


def _neighbours(edges: Iterable[tuple[Node, Node]]) -> dict[Node, list[Node]]:
    rows: dict[Node, list[Node]] = {}
    for i, j in edges:
        rows.setdefault(i, [])
        rows.setdefault(j, [])
        if i != j and j not in rows[i]:
            rows[i].append(j)
    return rows


def _reachable(start: Node, rows: Mapping[Node, Sequence[Node]], nodes: frozenset[Node]) -> frozenset[Node]:
    found, queue = {start}, [start]
    while queue:
        new = [j for j in rows[queue.pop()] if j in nodes and j not in found]
        found.update(new)
        queue.extend(new)
    return frozenset(found)


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
        return self._pieces(nodes, self._rows, self._columns)

    def of(self, nodes: frozenset[Node]) -> Polynomial:
        """Return the principal minor over the given nodes."""
        if nodes not in self._known:
            pieces = self.factors(nodes)
            one = len(pieces) == 1
            self._known[nodes] = self._expand(nodes) if one else product(self.of(piece) for piece in pieces)
        return self._known[nodes]

    def _pieces(self, nodes: frozenset[Node], *ways: Mapping[Node, Sequence[Node]]) -> list[frozenset[Node]]:
        pieces, rest = [], [i for i in self._rows if i in nodes]
        while rest:
            piece = frozenset.intersection(*(_reachable(rest[0], rows, nodes) for rows in ways))
            pieces.append(piece)
            rest = [i for i in rest if i not in piece]
        return sorted(pieces, key=len)

    def _expand(self, nodes: frozenset[Node]) -> Polynomial:
        root = max((i for i in self._rows if i in nodes), key=lambda i: sum(j in nodes for j in self._rows[i]))
        return self.rooted(root, nodes, self.entries.get((root, root), ZERO))

    def rooted(self, root: Node, nodes: frozenset[Node], diagonal: Polynomial) -> Polynomial:
        """Return the minor over the given nodes, with another diagonal entry at root."""
        value, rest = diagonal, ONE
        for piece in self._pieces(nodes - {root}, self._both):
            alone = self.of(piece)
            value = add(multiply(value, alone), multiply(self._through(root, piece), rest))
            rest = multiply(rest, alone)
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
