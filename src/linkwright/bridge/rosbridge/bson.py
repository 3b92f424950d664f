"""Write and read BSON (bsonspec.org), in which rosbridge sends all messages with ``bson_only_mode``.

As in rosbridge_library, ``uint8[]`` is binary, and NaN and infinite numbers stay as they are.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from typing import Any

from linkwright.bridge.rosbridge.values import is_base64
from linkwright.messages import definition_of
from linkwright.messages.definitions.interfaces import Container, FieldType
from linkwright.messages.message import Message

_DOUBLE, _TEXT, _DOCUMENT, _ARRAY, _BINARY = 1, 2, 3, 4, 5
_BOOL, _TIME, _NULL, _INT32, _INT64 = 8, 9, 10, 16, 18
_END = b"\0"
_LENGTH = struct.Struct("<i")
_MAX_DEPTH = 100


def encode(document: dict[str, Any]) -> bytes:
    """Return numbers, bools, texts, bytes, lists, dictionaries and messages as a BSON document.

    Raises:
        TypeError: a value has another type, or a number has more than 64 bits.
    """
    return _write_document(document.items())


def decode(content: bytes) -> dict[str, Any]:
    """Return the dictionary that a BSON document contains; binary values are bytes, and times are milliseconds.

    Raises:
        ValueError: the content is not BSON, or has a value of another type.
    """
    try:
        values, end = _read_document(content, 0, 0)
    except (struct.error, IndexError) as error:
        raise ValueError("the document ends too early") from error
    if end != len(content):
        raise ValueError("bytes follow the document")
    return dict(values)


# --- writing -----------------------------------------------------------------------------------------------------


def _write_document(items: Iterable[tuple[str, Any]]) -> bytes:
    parts: list[bytes] = []
    for name, value in items:
        kind, content = _write(value)
        key = name.encode(errors="replace")
        if _END in key:
            raise TypeError("a name with a null character cannot be written as BSON")
        parts += (bytes([kind]), key, _END, content)
    content = b"".join(parts)
    return _LENGTH.pack(len(content) + _LENGTH.size + 1) + content + _END


def _write(value: Any) -> tuple[int, bytes]:
    """Return the type of a value, and its bytes."""
    if isinstance(value, Message):
        fields = definition_of(type(value)).fields
        return _DOCUMENT, _write_document(
            (field.name, _prepare(field.type, getattr(value, field.name))) for field in fields
        )
    if isinstance(value, str):
        text = value.encode(errors="replace") + _END
        return _TEXT, _LENGTH.pack(len(text)) + text
    if value is None:
        return _NULL, b""
    if isinstance(value, bool):
        return _BOOL, bytes([value])
    if isinstance(value, int):
        if -(1 << 31) <= value < 1 << 31:
            return _INT32, struct.pack("<i", value)
        if -(1 << 63) <= value < 1 << 63:
            return _INT64, struct.pack("<q", value)
        raise TypeError("a number of more than 64 bits cannot be written as BSON")
    if isinstance(value, float):
        return _DOUBLE, struct.pack("<d", value)
    if isinstance(value, bytes):
        return _BINARY, _LENGTH.pack(len(value)) + b"\0" + value
    if isinstance(value, dict):
        return _DOCUMENT, _write_document(value.items())
    if isinstance(value, list):
        return _ARRAY, _write_document((str(index), item) for index, item in enumerate(value))
    raise TypeError(f"{type(value).__name__} cannot be written as BSON")


def _prepare(kind: FieldType, value: Any) -> Any:
    """Return the value of a message's field as a value that `_write` knows."""
    primitive = kind.primitive
    if kind.container is not Container.ONE:
        if is_base64(kind):
            return bytes(value)
        items = value.tolist() if hasattr(value, "tolist") else list(value)
        return [item[0] for item in items] if primitive is not None and primitive.python is bytes else items
    if primitive is None:
        return value
    return value[0] if primitive.python is bytes else primitive.python(value)


# --- reading -----------------------------------------------------------------------------------------------------


def _read_document(content: bytes, start: int, depth: int) -> tuple[list[tuple[str, Any]], int]:
    """Return the names and values of a document, and the position after it."""
    if depth > _MAX_DEPTH:
        raise ValueError(f"documents are nested more than {_MAX_DEPTH} deep")
    end = start + _LENGTH.unpack_from(content, start)[0]
    if not start + _LENGTH.size < end <= len(content) or content[end - 1] != 0:
        raise ValueError("the length of a document is wrong")
    position = start + _LENGTH.size
    values = []
    while position < end - 1:
        kind = content[position]
        name_end = content.index(_END, position + 1, end)
        name = content[position + 1 : name_end].decode()
        value, position = _read(kind, content, name_end + 1, depth)
        values.append((name, value))
    if position != end - 1:
        raise ValueError("a value extends beyond its document")
    return values, end


def _read(kind: int, content: bytes, start: int, depth: int) -> tuple[Any, int]:
    """Return a value, and the position after it."""
    if kind == _TEXT:
        end = start + _LENGTH.size + _read_length(content, start, minimum=1)
        return content[start + _LENGTH.size : end - 1].decode(), end
    if kind in (_DOCUMENT, _ARRAY):
        values, end = _read_document(content, start, depth + 1)
        return dict(values) if kind == _DOCUMENT else [value for _, value in values], end
    if kind == _BINARY:
        first = start + _LENGTH.size + 1
        end = first + _read_length(content, start, minimum=0)
        return content[first:end], end
    if kind == _NULL:
        return None, start
    if kind not in _READERS:
        raise ValueError(f"values of the type {kind:#04x} are not supported")
    form, convert = _READERS[kind]
    return convert(form.unpack_from(content, start)[0]), start + form.size


def _read_length(content: bytes, start: int, minimum: int) -> int:
    length: int = _LENGTH.unpack_from(content, start)[0]
    if not minimum <= length <= len(content) - start:
        raise ValueError("the length of a value is wrong")
    return length


_READERS: dict[int, tuple[struct.Struct, Callable[[Any], Any]]] = {
    _DOUBLE: (struct.Struct("<d"), float),
    _BOOL: (struct.Struct("<B"), bool),
    _TIME: (struct.Struct("<q"), int),
    _INT32: (struct.Struct("<i"), int),
    _INT64: (struct.Struct("<q"), int),
}
