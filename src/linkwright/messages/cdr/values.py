"""The functions that generated CDR code calls for strings, lists of strings and bad data.

Publishers send the same names repeatedly. Therefore, the bytes of short strings and of lists of strings are cached when
they are written, and lists of strings are cached by their bytes when they are read. With this cache, reading the names
of twelve joints takes one comparison.
"""

from __future__ import annotations

import struct
from array import array
from typing import Any

from linkwright.diagnostics import phrase

_LENGTH = struct.Struct("<I")
_MAX_CACHED_TEXT = 128
_MAX_CACHED_TEXTS = 4096
_MAX_CACHED_BLOCK_SIZE = 8192
_MAX_CACHED_BLOCKS = 64
_KEY_SIZE = 28
_MAX_DIRECT_COPY = 4096
_MAX_UTF16_UNIT = 0xFFFF


READ_FAULTS = (struct.error, IndexError, ValueError)
"""All errors that a reader raises for bad data. UnicodeDecodeError and DataFaultError are ValueErrors."""


class DataFaultError(ValueError):
    """Raised inside this package when bytes are not a valid message.

    The text of the error is the reason.

    The package's public functions convert it to a `MessageDataError`.
    """


class Texts(dict[str, bytes]):
    """A cache of encoded strings: length, UTF-8, NUL, and zeros up to a multiple of `alignment`."""

    def __init__(self, alignment: int) -> None:
        super().__init__()
        self._alignment = alignment

    def __missing__(self, text: str) -> bytes:
        encoded = text.encode()
        serialized = _LENGTH.pack(len(encoded) + 1) + encoded + b"\0"
        serialized += bytes(-len(serialized) % self._alignment)
        if len(encoded) <= _MAX_CACHED_TEXT:
            if len(self) >= _MAX_CACHED_TEXTS:
                self.clear()
            self[text] = serialized
        return serialized


class TextLists(dict[tuple[str, ...], bytes]):
    """A cache of encoded lists of strings: their number, then each string as in `Texts`.

    Only the last string is padded to `alignment`.
    """

    def __init__(self, alignment: int) -> None:
        super().__init__()
        self._last_texts = TEXT1 if alignment == 1 else TEXT4

    def __missing__(self, texts: tuple[str, ...]) -> bytes:
        serialized = _LENGTH.pack(len(texts)) + b"".join([TEXT4[text] for text in texts[:-1]])
        if texts:
            serialized += self._last_texts[texts[-1]]
        if len(serialized) <= _MAX_CACHED_BLOCK_SIZE:
            if len(self) >= _MAX_CACHED_BLOCKS:
                self.clear()
            self[texts] = serialized
        return serialized


TEXT1 = Texts(1)
TEXT4 = Texts(4)
TEXT_LIST1 = TextLists(1)
TEXT_LIST4 = TextLists(4)

_blocks: dict[bytes, tuple[bytes, list[str], int]] = {}
"""Cached lists of strings by their first bytes.

Each entry has all bytes of the list, the strings, and the number of bytes.
"""


def read_texts(data: bytes, at: int, count: int) -> tuple[list[str], int]:
    """Read a list of strings from a message.

    Args:
        data: the bytes of the message.
        at: the offset of the first string's length, a multiple of four.
        count: the number of strings.

    Returns:
        The strings, and the offset of the end of the last one.
    """
    key = data[at - 4 : at + _KEY_SIZE]
    cached_block = _blocks.get(key)
    if cached_block is not None and data.startswith(cached_block[0], at):
        return cached_block[1].copy(), at + cached_block[2]
    start, end = at, len(data)
    if count * 4 > end - at:
        raise_truncated()
    texts = []
    unpack_length = _LENGTH.unpack_from
    for _ in range(count):
        at = (at + 3) & ~3
        (length,) = unpack_length(data, at)
        at += 4
        if length:
            terminator = at + length - 1
            if data[terminator]:
                raise_unterminated()
            texts.append(str(data[at:terminator], "utf-8"))
            at = terminator + 1
        else:
            texts.append("")
    if count and at - start <= _MAX_CACHED_BLOCK_SIZE:
        if len(_blocks) >= _MAX_CACHED_BLOCKS:
            _blocks.clear()
        _blocks[key] = (data[start:at], texts.copy(), at - start)
    return texts, at


def read_numbers(code: str, data: bytes, start: int, end: int) -> array[Any]:
    """Return the numbers in a byte range of a message.

    Raises:
        DataFaultError: the message is too short.
    """
    if end > len(data):
        raise_truncated()
    if end - start <= _MAX_DIRECT_COPY:
        return array(code, data[start:end])
    numbers = array(code)
    numbers.frombytes(memoryview(data)[start:end])
    return numbers


def read_bools(data: bytes, start: int, end: int) -> list[bool]:
    """Return the bools in a byte range of a message.

    Raises:
        DataFaultError: the message is too short, or a value is neither 0 nor 1.
    """
    values = data[start:end]
    if len(values) < end - start:
        raise_truncated()
    if values.translate(None, b"\0\1"):
        raise_bad_bool(max(values))
    return list(map(bool, values))


def read_bytes(data: bytes, start: int, end: int) -> list[bytes]:
    """Return the bytes in a range of a message, each as an object of length 1.

    Raises:
        DataFaultError: the message is too short.
    """
    if end > len(data):
        raise_truncated()
    return [data[at : at + 1] for at in range(start, end)]


def read_wide_text(data: bytes, at: int, count: int, order: str) -> tuple[str, int]:
    """Read a wide string of UTF-16 units, each in four bytes and without a terminator.

    This is the format of rosidl_typesupport_fastrtps, for Fast DDS and Zenoh, up to Kilted. rmw_cyclonedds_cpp has
    adopted it.

    Args:
        data: the message.
        at: the offset of the first unit.
        count: the number of units.
        order: the byte order, ``<`` or ``>``.

    Returns:
        The string, and the offset of its end.
    """
    end = at + count * 4
    if end > len(data):
        raise_truncated()
    units = array("I", data[at:end])
    if order == ">":
        units.byteswap()
    largest_unit = max(units, default=0)
    if largest_unit > _MAX_UTF16_UNIT:
        raise DataFaultError(
            phrase("a wide string contains the UTF-16 unit {value}, but units are at most 65535", value=largest_unit)
        )
    return str(array("H", units).tobytes(), "utf-16-le"), end


def write_wide_text(text: str) -> bytes:
    """Encode a wide string: the number of UTF-16 units, then each unit in four bytes."""
    units = array("I", array("H", text.encode("utf-16-le")))
    return _LENGTH.pack(len(units)) + units.tobytes()


def raise_truncated() -> None:
    """Raise a DataFaultError for truncated data, or for an impossible length in the data."""
    raise DataFaultError(phrase("the data ends in the middle of the message, or contains a wrong length"))


def raise_unterminated() -> None:
    """Raise a DataFaultError for a string that does not end with NUL."""
    raise DataFaultError(phrase("the end of a string does not match its length"))


def raise_bad_bool(value: int) -> None:
    """Raise a DataFaultError for a bool that is neither 0 nor 1."""
    raise DataFaultError(phrase("a bool has the invalid value {value}", value=value))


def raise_too_long(name: str, bound: int) -> None:
    """Raise a DataFaultError for a field with more values or characters than its bound allows."""
    raise DataFaultError(phrase("'{name}' is longer than its maximum length of {bound}", name=name, bound=bound))


def check_bounds(name: str, texts: list[str], bound: int) -> None:
    """Raise a DataFaultError if a string is longer than a bound."""
    if any(len(text) > bound for text in texts):
        raise_too_long(name, bound)
