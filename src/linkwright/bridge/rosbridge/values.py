"""Messages as the JSON values of the rosbridge protocol, and back.

As in rosbridge_library, ``uint8[]`` is base64, and numbers that JSON does not have (NaN, infinity) are null. Unlike
there, they are null in arrays of fixed length as well, ``byte[]`` is a list of numbers, and null is accepted for a
float.
"""

from __future__ import annotations

import math
from array import array
from base64 import b64decode, standard_b64encode
from collections.abc import Callable, Mapping
from operator import itemgetter
from typing import Any

from linkwright.bridge.rosbridge.requests import RequestError
from linkwright.messages import definition_of, get_message
from linkwright.messages.definitions.interfaces import Container, FieldType
from linkwright.messages.message import Message

_HEADER = "std_msgs/msg/Header"
_TIME = "builtin_interfaces/msg/Time"
_STAMPS = (_TIME, "builtin_interfaces/msg/Duration")
_OLD_NAMES = {"secs": "sec", "nsecs": "nanosec"}
"""The names of the fields of a time in ROS 1, which clients still use."""

Convert = Callable[[Any], Any]
Now = Callable[[], Any]
"""A function that returns the time as a builtin_interfaces/msg/Time."""

_converters_by_class: dict[type, list[tuple[str, Convert]]] = {}
"""The names of the fields of a class, each with the function that converts its values."""


# --- from messages -----------------------------------------------------------------------------------------------


def to_json_values(message: Message) -> dict[str, Any]:
    """Return the fields of a message as values that `json` writes."""
    message_class = type(message)
    converters = _converters_by_class.get(message_class)
    if converters is None:
        fields = definition_of(message_class).fields
        converters = _converters_by_class[message_class] = [
            (field.name, _choose_converter(field.type)) for field in fields
        ]
    return {name: convert(getattr(message, name)) for name, convert in converters}


def _choose_converter(kind: FieldType) -> Convert:
    primitive = kind.primitive
    if kind.container is Container.ONE:
        if primitive is None:
            return to_json_values
        return _CONVERTERS.get(primitive.python, primitive.python)
    if is_base64(kind):
        return _to_base64
    if primitive is None:
        return _to_list_of_values
    return _LIST_CONVERTERS.get(primitive.python, list)


def is_base64(kind: FieldType) -> bool:
    """Return whether values of a type are base64: arrays of bytes, and sequences of bytes without a bound."""
    return kind.base in ("uint8", "char") and (kind.container is Container.ARRAY or kind.size is None)


def _to_number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _to_base64(values: Any) -> str:
    return standard_b64encode(bytes(values)).decode("ascii")


def _to_list(values: Any) -> list[Any]:
    return values.tolist() if hasattr(values, "tolist") else list(values)


def _to_list_of_floats(values: Any) -> list[float | None]:
    floats = _to_list(values)
    return floats if math.isfinite(sum(floats)) else [_to_number(value) for value in floats]


def _to_list_of_codes(values: Any) -> list[int]:
    return [value[0] for value in values]


def _to_list_of_values(values: Any) -> list[dict[str, Any]]:
    return [to_json_values(value) for value in values]


_CONVERTERS: Mapping[type, Convert] = {float: _to_number, bytes: itemgetter(0)}
_LIST_CONVERTERS: Mapping[type, Convert] = {int: _to_list, float: _to_list_of_floats, bytes: _to_list_of_codes}


# --- to messages -------------------------------------------------------------------------------------------------


def from_json_values(values: Any, message_class: type[Any], now: Now) -> Any:
    """Return the message that a client sends.

    Fields that it omits have their defaults. The stamp of a header that it sends without a stamp, or omits, is the
    current time.

    Args:
        values: the parsed JSON.
        message_class: the class of the message.
        now: returns the current time.

    Raises:
        RequestError: a field does not exist, or a value does not fit its field.
    """
    message = message_class()
    _Reader(message_class.TYPE_NAME, now).fill(message, values, "")
    for field in definition_of(message_class).fields:
        if field.type == FieldType(_HEADER) and field.name not in values:
            getattr(message, field.name).stamp = now()
    return message


def from_json_arguments(arguments: Any, message_class: type[Any], now: Now) -> Any:
    """Return the request or goal that a client sends, whose values may also be a list in the order of the fields.

    Raises:
        RequestError: a field does not exist, or a value does not fit its field.
    """
    if isinstance(arguments, list):
        names = [field.name for field in definition_of(message_class).fields]
        arguments = dict(zip(names, arguments, strict=False))
    return from_json_values(arguments if isinstance(arguments, dict) else {}, message_class, now)


class _Reader:
    """A reader of the values of one message.

    Args:
        type_name: the type of the message, for errors.
        now: returns the current time.
    """

    def __init__(self, type_name: str, now: Now) -> None:
        self._type_name = type_name
        self._now = now

    def fill(self, message: Any, values: Any, path: str) -> None:
        """Set the fields of a message or of a nested message, whose path is for errors."""
        if not isinstance(values, Mapping):
            raise self._make_error(path, "a JSON object", values)
        if message.TYPE_NAME == _HEADER:
            message.stamp = self._now()
        is_stamp = message.TYPE_NAME in _STAMPS
        types = {field.name: field.type for field in definition_of(type(message)).fields}
        for name, value in values.items():
            field_name = _OLD_NAMES.get(name, name) if is_stamp else name
            field_path = f"{path}.{name}" if path else str(name)
            if field_name not in types:
                raise RequestError(f"Message type {self._type_name} does not have a field {field_path[:200]}")
            try:
                setattr(message, field_name, self._convert(types[field_name], value, field_path))
            except (AssertionError, ValueError, OverflowError) as error:
                raise RequestError(f"{self._type_name} field {field_path[:200]}: {error}") from None

    def _convert(self, kind: FieldType, value: Any, path: str) -> Any:
        if kind.container is Container.ONE:
            return self._convert_one(kind, value, path)
        if kind.base in ("uint8", "char") and isinstance(value, bytes):  # of BSON
            return array("B", value)
        if kind.base in ("uint8", "char") and isinstance(value, str):
            return array("B", b64decode(value, validate=True))
        if not isinstance(value, list):
            raise self._make_error(path, "a list", value)
        item_type = FieldType(kind.base, kind.string_bound)
        return [self._convert_one(item_type, item, path) for item in value]

    def _convert_one(self, kind: FieldType, value: Any, path: str) -> Any:
        primitive = kind.primitive
        if primitive is None:
            if kind.base == _TIME and value == "now":
                return self._now()
            message = get_message(kind.base)()
            self.fill(message, value, path)
            return message
        python, is_number = primitive.python, isinstance(value, (int, float)) and not isinstance(value, bool)
        if python is float and (is_number or value is None):
            return math.nan if value is None else float(value)
        if python in (int, bytes) and is_number and value == int(value):
            return int(value) if python is int else bytes([int(value)])
        if python in (str, bool) and isinstance(value, python):
            return value
        raise self._make_error(path, primitive.idl_name, value)

    def _make_error(self, path: str, expected: str, value: Any) -> RequestError:
        subject = f"field {path[:200]} of {self._type_name}" if path else self._type_name
        return RequestError(f"{subject} requires {expected}, but got {str(value)[:60]!r} ({type(value).__name__})")
