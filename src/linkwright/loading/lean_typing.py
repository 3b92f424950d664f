"""A faster replacement for `typing`, with the names that annotations use.

Importing `typing` took a seventh of the time of ``linkwright xacro`` for a small file. Annotations are never evaluated
(``from __future__ import annotations``), so almost all of `typing` is needed only by type checkers, for which this
module imports the names of `typing`. At run time, the names are classes that can be subscripted, joined by ``|`` and
subclassed. Code that evaluates annotations, as ``typing.get_type_hints`` does, needs `typing` itself.
"""

from __future__ import annotations

from types import GenericAlias

__all__ = [
    "IO",
    "TYPE_CHECKING",
    "Any",
    "ClassVar",
    "Final",
    "Generic",
    "Literal",
    "NoReturn",
    "Protocol",
    "SupportsIndex",
    "TypeAlias",
    "TypeVar",
    "Union",
    "cast",
    "get_args",
]

TYPE_CHECKING = False


class _Generic:
    __slots__ = ()
    __class_getitem__ = classmethod(GenericAlias)  # type: ignore[var-annotated]


class _Protocol:
    __slots__ = ()
    __class_getitem__ = classmethod(GenericAlias)  # type: ignore[var-annotated]


class _TypeVar:
    def __init__(self, name: str, *_constraints: object, **_options: object) -> None:
        self.__name__ = name


def _cast(_: object, value: object) -> object:
    return value


def _get_args(alias: GenericAlias) -> tuple[object, ...]:
    return alias.__args__


if TYPE_CHECKING:
    from typing import (
        IO,
        Any,
        ClassVar,
        Final,
        Generic,
        Literal,
        NoReturn,
        Protocol,
        SupportsIndex,
        TypeAlias,
        TypeVar,
        Union,
        cast,
        get_args,
    )
else:
    Generic, Protocol, TypeVar, cast, get_args = _Generic, _Protocol, _TypeVar, _cast, _get_args
    Any = ClassVar = Final = IO = Literal = NoReturn = SupportsIndex = TypeAlias = Union = _Generic
