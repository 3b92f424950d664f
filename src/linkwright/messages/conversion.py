"""Converting messages to plain data and to comma-separated values, as rosidl_runtime_py does."""

from __future__ import annotations

from array import array
from collections import OrderedDict
from typing import Any

from linkwright.messages.checks import is_array, is_scalar
from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, FieldType
from linkwright.messages.message import Message, definition_of

_CUT = "..."


def to_dict(
    message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """The fields of a message as plain values: numbers, bools, texts, lists, and dictionaries for nested messages.

    Args:
        message: any message.
        truncate_length: longer texts and lists are cut to this length and end with ``...``.
        no_arr: say only of what kind and how long arrays and sequences are.
        no_str: say only how long texts are.

    Bytes are texts of the characters of the same numbers (rosidl_runtime_py).
    """
    plain: OrderedDict[str, Any] = OrderedDict()
    for field in definition_of(type(message)).fields:
        kind = field.type
        value = getattr(message, field.name)
        if kind.container is Container.ONE:
            plain[field.name] = _plain(value, truncate_length, no_arr, no_str)
        elif no_arr:
            plain[field.name] = abbreviated(kind, value)
        else:
            plain[field.name] = _plain_list(value, truncate_length, no_arr, no_str)
    return plain


def to_csv(message: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """The values of a message, those of nested messages in their place, with commas between them.

    Args:
        message: any message.
        truncate_length: as in `to_dict`.
        no_arr: as in `to_dict`.
        no_str: as in `to_dict`.
    """
    words: list[str] = []
    for field in definition_of(type(message)).fields:
        value = getattr(message, field.name)
        if no_arr and field.type.container is not Container.ONE:
            words.append(abbreviated(field.type, value))
        else:
            words.append(_csv(value, truncate_length, no_arr, no_str))
    # A field of no values leaves nothing, not even a comma at the beginning of the line.
    text = ""
    for word in words:
        text = f"{text},{word}" if text else word
    return text


def abbreviated(kind: FieldType, value: Any) -> str:
    """The type and length of an array or sequence, in place of its values: ``<sequence type: double, length: 12>``."""
    primitive = PRIMITIVES.get(kind.base)
    name = kind.base if primitive is None else primitive.idl_name
    if kind.container is Container.ARRAY:
        return f"<array type: {name}[{kind.size}]>"
    bound = "" if kind.size is None else f"[{kind.size}]"
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def abbreviated_text(text: str) -> str:
    """The length of a text, in place of it."""
    return f"<string length: <{len(text)}>>"


def _plain(value: Any, truncate_length: int | None, no_arr: bool, no_str: bool) -> Any:
    if isinstance(value, bytes):
        return _cut(value.decode("latin-1"), truncate_length)
    if isinstance(value, str):
        return abbreviated_text(value) if no_str else _cut(value, truncate_length)
    if isinstance(value, Message):
        return to_dict(value, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return value.item() if is_scalar(value) else value


def _plain_list(values: Any, truncate_length: int | None, no_arr: bool, no_str: bool) -> list[Any]:
    cut = truncate_length is not None and len(values) > truncate_length
    if isinstance(values, array) or is_array(values):
        numbers: list[Any] = (values.ravel() if is_array(values) else values)[:truncate_length].tolist()
        return [*numbers, _CUT] if cut else numbers
    plain = [_plain(each, truncate_length, no_arr, no_str) for each in list(values)[:truncate_length]]
    return [*plain, _CUT] if cut else plain


def _cut(text: str, length: int | None) -> str:
    return text[:length] + _CUT if length is not None and len(text) > length else text


def _csv(value: Any, truncate_length: int | None, no_arr: bool, no_str: bool) -> str:
    if isinstance(value, Message):
        return to_csv(value, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    if isinstance(value, str):
        return abbreviated_text(value) if no_str else _cut(value, truncate_length)
    if isinstance(value, bytes):
        return str(value)
    if isinstance(value, (list, tuple, array)) or is_array(value):
        words = [_csv(each, truncate_length, no_arr, no_str) for each in list(value)[:truncate_length]]
        if truncate_length is not None and len(value) > truncate_length:
            words.append(_CUT)
        return ",".join(words)
    return str(value)
