"""Converts messages to plain data and to comma-separated values, as rosidl_runtime_py does."""

from __future__ import annotations

from array import array
from collections import OrderedDict
from typing import Any, NamedTuple

from linkwright.messages.checks import is_array, is_scalar
from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, FieldType
from linkwright.messages.message import Message, definition_of

CUT = "..."
"""The end of texts and lists that are cut."""


class Abridgement(NamedTuple):
    """How values of messages are shortened for display.

    Attributes:
        truncate_length: longer strings and lists are cut to this length and end with ``...``; None for no limit.
        no_arr: whether arrays and sequences are replaced by their type and length.
        no_str: whether strings are replaced by their length.
    """

    truncate_length: int | None = None
    no_arr: bool = False
    no_str: bool = False

    def text(self, text: str) -> str:
        """Return a string in the form in which it is displayed."""
        return f"<string length: <{len(text)}>>" if self.no_str else self.cut(text)

    def cut(self, text: str) -> str:
        """Return a string, truncated if it is too long."""
        length = self.truncate_length
        return text[:length] + CUT if length is not None and len(text) > length else text


def to_dict(
    message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return the fields of a message as plain values, by name.

    The values are numbers, bools, strings, lists, and dictionaries for nested messages. As in rosidl_runtime_py, bytes
    become strings of the characters with the same codes.

    Args:
        message: any message.
        truncate_length: longer strings and lists are cut to this length and end with ``...``; None for no limit.
        no_arr: whether arrays and sequences are replaced by their type and length.
        no_str: whether strings are replaced by their length.
    """
    return _dict(message, Abridgement(truncate_length, no_arr, no_str))


def _dict(message: Message, shown: Abridgement) -> OrderedDict[str, Any]:
    plain: OrderedDict[str, Any] = OrderedDict()
    for field in definition_of(type(message)).fields:
        kind = field.type
        value = getattr(message, field.name)
        if kind.container is Container.ONE:
            plain[field.name] = _plain(value, shown)
        elif shown.no_arr:
            plain[field.name] = abbreviated(kind, value)
        else:
            plain[field.name] = _plain_list(value, shown)
    return plain


def to_csv(message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return the values of a message, including those of nested messages, separated by commas.

    Args:
        message: any message.
        truncate_length: as in `to_dict`.
        no_arr: as in `to_dict`.
        no_str: as in `to_dict`.
    """
    return _line(message, Abridgement(truncate_length, no_arr, no_str))


def _line(message: Message, shown: Abridgement) -> str:
    words: list[str] = []
    for field in definition_of(type(message)).fields:
        value = getattr(message, field.name)
        if shown.no_arr and field.type.container is not Container.ONE:
            words.append(abbreviated(field.type, value))
        else:
            words.append(_csv(value, shown))
    # A field without values contributes nothing, not even a comma at the beginning of the line.
    text = ""
    for word in words:
        text = f"{text},{word}" if text else word
    return text


def abbreviated(kind: FieldType, value: Any) -> str:
    """Return a text with the type and length of an array or sequence.

    An example is ``<sequence type: double, length: 12>``.
    """
    primitive = PRIMITIVES.get(kind.base)
    name = kind.base if primitive is None else primitive.idl_name
    if kind.container is Container.ARRAY:
        return f"<array type: {name}[{kind.size}]>"
    bound = "" if kind.size is None else f"[{kind.size}]"
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def _plain(value: Any, shown: Abridgement) -> Any:
    if isinstance(value, bytes):
        return shown.cut(value.decode("latin-1"))
    if isinstance(value, str):
        return shown.text(value)
    if isinstance(value, Message):
        return _dict(value, shown)
    return value.item() if is_scalar(value) else value


def _plain_list(values: Any, shown: Abridgement) -> list[Any]:
    length = shown.truncate_length
    cut = length is not None and len(values) > length
    if isinstance(values, array) or is_array(values):
        numbers: list[Any] = (values.ravel() if is_array(values) else values)[:length].tolist()
        return [*numbers, CUT] if cut else numbers
    plain = [_plain(value, shown) for value in list(values)[:length]]
    return [*plain, CUT] if cut else plain


def _csv(value: Any, shown: Abridgement) -> str:
    if isinstance(value, Message):
        return _line(value, shown)
    if isinstance(value, str):
        return shown.text(value)
    if isinstance(value, bytes):
        return str(value)
    if isinstance(value, (list, tuple, array)) or is_array(value):
        length = shown.truncate_length
        words = [_csv(item, shown) for item in list(value)[:length]]
        if length is not None and len(value) > length:
            words.append(CUT)
        return ",".join(words)
    return str(value)
