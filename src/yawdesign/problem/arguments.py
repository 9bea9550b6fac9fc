"""What a function was called with, checked before it begins: names against its signature, values against its hints.

The package's edge puts `checked` around every public function, so that a wrong argument is named in one way
everywhere: what was expected, and what came. `named` does the same for the names of a class's fields; their values the
class checks itself.
"""

import reprlib
from collections.abc import Callable, Collection, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import suppress
from functools import cache, wraps
from inspect import Parameter, Signature, signature
from numbers import Integral, Real
from os import PathLike
from types import NoneType, SimpleNamespace, UnionType
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from .diagnostics import Diagnostic, ProblemError, unknown_key

F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")
Progress = Callable[[str, float], Any]  # what is told of long work: a text, and the share that is done, 0 ... 1

_WORDS: Mapping[Any, str] = {
    str: "a text",
    bool: "True or False",
    int: "a whole number",
    float: "a number",
    NoneType: "None",
    PathLike: "a path",
    Callable: "a function",
    Mapping: "a mapping",
}
_SOURCES = {"Problem": " (yawdesign.load reads one from a file, yawdesign.loads from a text)"}


class ArgumentError(ProblemError, TypeError):
    """A function was called with a name it does not know, without a value it needs, or with one of a wrong type."""


def refused(name: str, expected: str, value: object) -> ArgumentError:
    """Return the error for an argument of a wrong type: what was expected, and what came."""
    return ArgumentError([_unfit(name, expected, value)])


def _unfit(name: str, expected: str, value: object) -> Diagnostic:
    shown = " ".join(reprlib.repr(value).split())
    return Diagnostic(key=name, message=f"expected {expected}, got {shown} ({type(value).__name__})")


def checked(function: F) -> F:
    """Return a function that refuses wrong arguments before it begins.

    Parameters
    ----------
    function : callable
        Its signature says which names there are, and its type hints which values; where a hint is `Any`, the function
        looks at the value itself. Of a class the constructor is checked.

    Raises
    ------
    ArgumentError
        With all that is wrong with a call.

    Examples
    --------
    >>> def double(length: float) -> float:
    ...     return 2 * length
    >>> checked(double)(lenght=1.0)
    Traceback (most recent call last):
    yawdesign.problem.arguments.ArgumentError: error: lenght: is not known here; did you mean length?
    >>> checked(double)("1 m")
    Traceback (most recent call last):
    yawdesign.problem.arguments.ArgumentError: error: length: expected a number, got '1 m' (str)
    """
    if isinstance(function, type):
        function.__init__ = checked(function.__init__)  # type: ignore[misc]
        return function

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        given = _bound(signature(function), args, kwargs)
        hints = _hints(function)
        wrong = [
            _unfit(name, expected(hints[name]), value)
            for name, value in given.items()
            if name in hints and not fits(value, hints[name])
        ]
        if wrong:
            raise ArgumentError(wrong)
        return function(*args, **kwargs)

    return cast(F, call)


def named(cls: type[T]) -> type[T]:
    """Return a class whose constructor names the nearest field where a name is not known."""
    init = cls.__init__

    @wraps(init)
    def call(self: T, *args: Any, **kwargs: Any) -> None:
        _bound(signature(init), (self, *args), kwargs)
        init(self, *args, **kwargs)

    cls.__init__ = call  # type: ignore[method-assign, assignment]
    return cls


def _bound(known: Signature, args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> dict[str, Any]:
    """Return what was given by name, but for what is caught by ``*args`` and ``**kwargs``."""
    kinds = {name: parameter.kind for name, parameter in known.parameters.items()}
    names = [name for name, kind in kinds.items() if kind in (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)]
    if Parameter.VAR_KEYWORD not in kinds.values():
        unknown = [Diagnostic(key=x, message=unknown_key(x, names)) for x in kwargs if x not in names]
        if unknown:
            raise ArgumentError(unknown)
    try:
        given = known.bind(*args, **kwargs).arguments
    except TypeError as error:
        raise ArgumentError(f"{error}; the arguments are {', '.join(n for n in names if n != 'self')}") from None
    return {name: value for name, value in given.items() if name in names}


@cache
def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    hints: dict[str, Any] = {}
    for name, hint in function.__annotations__.items():
        with suppress(NameError):  # a name that only type checkers import
            hints |= get_type_hints(SimpleNamespace(__annotations__={name: hint}), function.__globals__)
    return hints


def fits(value: object, hint: Any) -> bool:
    """Return whether a value is what a type hint says; a bool is no number, elements of collections are looked at."""
    kind, inner = get_origin(hint) or hint, get_args(hint)
    if kind in (Union, UnionType):
        return any(fits(value, each) for each in inner)
    if kind is Literal:
        return isinstance(value, str) and value in inner
    if kind in (float, int):
        return isinstance(value, Real if kind is float else Integral) and not isinstance(value, bool)
    if kind is Callable:
        return callable(value) and _takes(value, len(inner[0]) if inner and isinstance(inner[0], list) else None)
    if kind is Any or not isinstance(kind, type):
        return True
    return isinstance(value, kind) and _elements_fit(value, kind, inner)


def _takes(function: Callable[..., Any], count: int | None) -> bool:
    """Return whether a function can be called with so many arguments, as far as it tells."""
    try:
        if count is not None:
            signature(function).bind(*range(count))
    except TypeError:
        return False
    except ValueError:  # some that are built in have no signature
        return True
    return True


def _elements_fit(value: Any, kind: type, inner: tuple[Any, ...]) -> bool:
    if issubclass(kind, Mapping) and inner:
        return all(fits(key, inner[0]) and fits(each, inner[1]) for key, each in value.items())
    if kind in _COLLECTIONS and inner and not isinstance(value, str):
        return all(fits(each, inner[0]) for each in value)
    return True


_COLLECTIONS = (Collection, list, tuple)


def expected(hint: Any) -> str:
    """Return a type hint in words."""
    words = list(dict.fromkeys(_words(hint)))
    return " or ".join([*filter(None, [", ".join(words[:-1])]), words[-1]])


def _words(hint: Any) -> Iterator[str]:
    kind, inner = get_origin(hint) or hint, get_args(hint)
    if kind in (Union, UnionType):
        for each in inner:
            yield from _words(each)
    elif kind is Literal:
        yield from map(repr, inner)
    elif kind is Callable and inner and isinstance(inner[0], list):
        yield f"a function of {len(inner[0])} argument{'s' * (len(inner[0]) != 1)}"
    elif kind is Collection and inner:
        yield f"a collection, each entry {expected(inner[0])}"
    else:
        name = getattr(kind, "__name__", str(kind))
        yield _WORDS.get(kind, f"a {name}{_SOURCES.get(name, '')}")


def as_executor(executor: Any) -> Executor:
    """Return an executor: itself, or that of a dask client."""
    if hasattr(executor, "get_executor"):
        found: Executor = executor.get_executor(pure=False)
        return found
    if not hasattr(executor, "submit"):
        raise ProblemError(f"executor: {executor!r} is neither a concurrent.futures.Executor nor a dask Client")
    return executor  # type: ignore[no-any-return]
