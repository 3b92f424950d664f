"""Write CBOR (RFC 8949), which rosbridge uses for messages with large arrays.

Arrays of numbers are byte strings with the tags of RFC 8746, little-endian.
"""

from __future__ import annotations

import struct
import sys
from array import array
from typing import Any

from linkwright.messages import definition_of
from linkwright.messages.definitions.interfaces import Container, FieldType
from linkwright.messages.message import Message

_ARRAY_TAGS = {"b": 72, "H": 69, "h": 77, "I": 70, "i": 78, "Q": 71, "q": 79, "f": 85, "d": 86}
"""The tags of arrays by the codes of their numbers."""
_UNSIGNED, _NEGATIVE, _BYTES, _TEXT, _LIST, _MAP, _TAG = range(7)
_FALSE, _TRUE, _NULL = b"\xf4", b"\xf5", b"\xf6"


def encode(value: Any) -> bytes:
    """Return numbers, bools, texts, bytes, lists, dictionaries and messages as CBOR.

    Raises:
        TypeError: a value has another type.
    """
    parts: list[bytes] = []
    _write(value, parts)
    return b"".join(parts)


def _write(value: Any, parts: list[bytes]) -> None:
    if isinstance(value, Message):
        fields = definition_of(type(value)).fields
        parts.append(_head(_MAP, len(fields)))
        for field in fields:
            _write(field.name, parts)
            _write_field(field.type, getattr(value, field.name), parts)
    elif isinstance(value, str):
        encoded = value.encode(errors="replace")
        parts += (_head(_TEXT, len(encoded)), encoded)
    elif value is None or isinstance(value, bool):
        parts.append(_NULL if value is None else _TRUE if value else _FALSE)
    elif isinstance(value, int):
        parts.append(_head(_UNSIGNED, value) if value >= 0 else _head(_NEGATIVE, -1 - value))
    elif isinstance(value, float):
        parts.append(b"\xfb" + struct.pack(">d", value))
    elif isinstance(value, bytes):
        parts += (_head(_BYTES, len(value)), value)
    elif isinstance(value, dict):
        parts.append(_head(_MAP, len(value)))
        for key, item in value.items():
            _write(key, parts)
            _write(item, parts)
    elif isinstance(value, list):
        parts.append(_head(_LIST, len(value)))
        for item in value:
            _write(item, parts)
    else:
        raise TypeError(f"{type(value).__name__} cannot be written as CBOR")


def _write_field(kind: FieldType, value: Any, parts: list[bytes]) -> None:
    primitive = kind.primitive
    if primitive is None or primitive.python is str:
        _write(value if kind.container is Container.ONE else list(value), parts)
    elif kind.container is Container.ONE:
        _write(value[0] if primitive.python is bytes else primitive.python(value), parts)
    elif primitive.array_code is None:  # bools and bytes
        _write([item[0] if isinstance(item, bytes) else bool(item) for item in value], parts)
    elif primitive.array_code == "B":
        _write(bytes(value), parts)
    else:
        numbers = array(primitive.array_code, value.ravel().tolist() if hasattr(value, "ravel") else value)
        if sys.byteorder == "big":
            numbers.byteswap()
        parts.append(_head(_TAG, _ARRAY_TAGS[primitive.array_code]))
        _write(numbers.tobytes(), parts)


def _head(major_type: int, number: int) -> bytes:
    """Return the first bytes of an item: its type and its number or length.

    Raises:
        TypeError: the number needs more than 64 bits.
    """
    first = major_type << 5
    if number < 24:
        return bytes([first | number])
    for code, letter in ((24, "B"), (25, "H"), (26, "I"), (27, "Q")):
        if number < 1 << 8 * struct.calcsize(f">{letter}"):
            return bytes([first | code]) + struct.pack(f">{letter}", number)
    raise TypeError("a number of more than 64 bits cannot be written as CBOR")
