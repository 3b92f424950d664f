"""Protocol messages as text: written for pages, and read from pages with nothing taken on trust."""

from __future__ import annotations

import dataclasses
import json
import math
import types
import typing
from functools import cache
from typing import Any, Literal, Union

from linkwright.viewer.protocol import PageMessage, ServerMessage

_PLAIN_TYPES = frozenset((str, float, int, bool, type(None)))


class BadMessageError(ValueError):
    """What a page sent is no message of the protocol; the text says why."""


def encode(message: ServerMessage) -> str:
    """A message as JSON. Half characters, as names of files may have that are not in UTF-8, become question marks."""
    text = json.dumps(_plain(message), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text if _is_whole(text) else text.encode("utf-8", "replace").decode()


def redundancy_key(message: ServerMessage) -> str:
    """Messages with one key make those before them needless: of each class, or of each thing its `NEWEST_OF` names."""
    parts = (str(getattr(message, name)) for name in getattr(message, "NEWEST_OF", ()))
    return "\n".join((message.type, *parts))


def decode(text: str) -> PageMessage:
    """The message that a page sent.

    Raises:
        BadMessageError: it is not JSON, of no known type, or its fields are not exactly those of the type.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise BadMessageError("not JSON") from None
    if not isinstance(data, dict):
        raise BadMessageError("not an object")
    kind = data.get("type")
    if not isinstance(kind, str) or kind not in _page_messages():
        raise BadMessageError(f"no message has the type {str(kind)[:40]!r}")
    message: PageMessage = _read(_page_messages()[kind], data, kind)
    return message


@cache
def _page_messages() -> dict[str, Any]:
    return {typing.get_args(_hints(cls)["type"])[0]: cls for cls in typing.get_args(PageMessage)}


@cache
def _hints(cls: Any) -> dict[str, Any]:
    return typing.get_type_hints(cls)


@cache
def _fields(cls: Any) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(cls))


def _plain(value: Any) -> Any:
    """As JSON can have it. The rows of a large robot are a hundred thousand values: most take the shortest way."""
    kind: Any = type(value)
    if kind in _PLAIN_TYPES:
        return value
    if kind is list:
        return [item if type(item) in _PLAIN_TYPES else _plain(item) for item in value]
    if kind is dict:
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (str, int, float)):
        return value  # of classes derived from these
    return {
        name: item if type(item := getattr(value, name)) in _PLAIN_TYPES else _plain(item) for name in _fields(kind)
    }


def _read(expected: Any, value: Any, where: str) -> Any:
    """The value as the annotated type has it."""
    if dataclasses.is_dataclass(expected):
        return _read_object(expected, value, where)
    origin, arguments = typing.get_origin(expected), typing.get_args(expected)
    if origin is Literal:
        if value in arguments:
            return value
    elif origin is list:
        if isinstance(value, list):
            return [_read(arguments[0], item, f"{where}[]") for item in value]
    elif origin is dict:
        if isinstance(value, dict) and all(map(_is_whole, value)):
            return {key: _read(arguments[1], item, f"{where}[]") for key, item in value.items()}
    elif origin in (Union, types.UnionType):
        for argument in arguments:
            if dataclasses.is_dataclass(argument):
                if isinstance(value, dict):
                    return _read_object(argument, value, where)
            elif _is_plain(argument, value):
                return value
    elif _is_plain(expected, value):
        return float(value) if expected is float else value
    raise BadMessageError(f"'{where}' does not hold what it must")


def _read_object(cls: Any, value: Any, where: str) -> Any:
    hints = _hints(cls)
    if not isinstance(value, dict) or value.keys() != hints.keys():
        raise BadMessageError(f"'{where}' does not have the fields {', '.join(hints)}")
    return cls(**{name: _read(hint, value[name], f"{where}.{name}") for name, hint in hints.items()})


def _is_plain(expected: Any, value: Any) -> bool:
    if expected is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and _is_finite(value)
    if expected is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, expected) and (expected is not str or _is_whole(value))


def _is_whole(text: str) -> bool:
    """Whether a text can be in UTF-8: JSON may name halves of characters, which nothing else can hold."""
    if text.isascii():
        return True
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False
