"""Convert messages to plain data and to comma-separated values, as rosidl_runtime_py does."""

from __future__ import annotations

from array import array
from collections import OrderedDict
from typing import Any, NamedTuple

from linkwright.messages.checks import is_array, is_scalar
from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, FieldType
from linkwright.messages.message import Message, definition_of

ELLIPSIS = "..."
"""The marker at the end of shortened texts and lists."""


class Abridgement(NamedTuple):
    """Options for shortening the values of messages for display.

    Attributes:
        truncate_length: longer strings and lists are cut to this length and end with ``...``; None for no limit.
        no_arr: whether arrays and sequences are replaced by their type and length.
        no_str: whether strings are replaced by their length.
    """

    truncate_length: int | None = None
    no_arr: bool = False
    no_str: bool = False

    def text(self, text: str) -> str:
        """Return a string value for display: truncated, or replaced by its length."""
        return f"<string length: <{len(text)}>>" if self.no_str else self.cut(text)

    def cut(self, text: str) -> str:
        """Return a text, cut to `truncate_length` if it is longer."""
        length = self.truncate_length
        return text[:length] + ELLIPSIS if length is not None and len(text) > length else text


def to_dict(
    message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return the fields of a message as plain values, by name.

    The values are numbers, bools, strings, lists, and dictionaries for nested messages. As in rosidl_runtime_py, bytes
    become strings of the characters with the same codes.

    Args:
        message: the message to convert.
        truncate_length: longer strings and lists are cut to this length and end with ``...``; None for no limit.
        no_arr: whether arrays and sequences are replaced by their type and length.
        no_str: whether strings are replaced by their length.
    """
    return _fields_to_dict(message, Abridgement(truncate_length, no_arr, no_str))


def _fields_to_dict(message: Message, abridgement: Abridgement) -> OrderedDict[str, Any]:
    plain_values: OrderedDict[str, Any] = OrderedDict()
    for field in definition_of(type(message)).fields:
        kind = field.type
        value = getattr(message, field.name)
        if kind.container is Container.ONE:
            plain_values[field.name] = _to_plain_value(value, abridgement)
        elif abridgement.no_arr:
            plain_values[field.name] = abbreviate(kind, value)
        else:
            plain_values[field.name] = _to_plain_list(value, abridgement)
    return plain_values


def to_csv(message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return the values of a message and of its nested messages, separated by commas.

    Args:
        message: the message to convert.
        truncate_length: as in `to_dict`.
        no_arr: as in `to_dict`.
        no_str: as in `to_dict`.
    """
    return _to_csv_line(message, Abridgement(truncate_length, no_arr, no_str))


def _to_csv_line(message: Message, abridgement: Abridgement) -> str:
    items: list[str] = []
    for field in definition_of(type(message)).fields:
        value = getattr(message, field.name)
        if abridgement.no_arr and field.type.container is not Container.ONE:
            items.append(abbreviate(field.type, value))
        else:
            items.append(_to_csv_text(value, abridgement))
    # As in rosidl_runtime_py, empty fields at the beginning of the line do not contribute a comma.
    text = ""
    for item in items:
        text = f"{text},{item}" if text else item
    return text


def abbreviate(kind: FieldType, value: Any) -> str:
    """Return a text with the type and length of an array or sequence.

    An example is ``<sequence type: double, length: 12>``.
    """
    primitive = PRIMITIVES.get(kind.base)
    name = kind.base if primitive is None else primitive.idl_name
    if kind.container is Container.ARRAY:
        return f"<array type: {name}[{kind.size}]>"
    bound = "" if kind.size is None else f"[{kind.size}]"
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def _to_plain_value(value: Any, abridgement: Abridgement) -> Any:
    if isinstance(value, bytes):
        return abridgement.cut(value.decode("latin-1"))
    if isinstance(value, str):
        return abridgement.text(value)
    if isinstance(value, Message):
        return _fields_to_dict(value, abridgement)
    return value.item() if is_scalar(value) else value


def _to_plain_list(values: Any, abridgement: Abridgement) -> list[Any]:
    length = abridgement.truncate_length
    is_cut = length is not None and len(values) > length
    if isinstance(values, array) or is_array(values):
        numbers: list[Any] = (values.ravel() if is_array(values) else values)[:length].tolist()
        return [*numbers, ELLIPSIS] if is_cut else numbers
    plain_values = [_to_plain_value(value, abridgement) for value in list(values)[:length]]
    return [*plain_values, ELLIPSIS] if is_cut else plain_values


def _to_csv_text(value: Any, abridgement: Abridgement) -> str:
    if isinstance(value, Message):
        return _to_csv_line(value, abridgement)
    if isinstance(value, str):
        return abridgement.text(value)
    if isinstance(value, bytes):
        return str(value)
    if isinstance(value, (list, tuple, array)) or is_array(value):
        length = abridgement.truncate_length
        texts = [_to_csv_text(item, abridgement) for item in list(value)[:length]]
        if length is not None and len(value) > length:
            texts.append(ELLIPSIS)
        return ",".join(texts)
    return str(value)
