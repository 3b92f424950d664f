"""Run-time support for generated CDR code: strings, lists of strings, errors for bad data.

Publishers send the same names repeatedly. Therefore the bytes of short strings, and of lists of strings, are cached
when they are written, and lists of strings are cached by their bytes when they are read. This way, reading the names of
twelve joints costs one comparison.
"""

from __future__ import annotations

import struct
from array import array
from typing import Any

from linkwright.diagnostics import phrase

_LENGTH = struct.Struct("<I")
_LONGEST_KEPT = 128
_MOST_TEXTS = 4096
_LONGEST_BLOCK_KEPT = 8192
_MOST_BLOCKS = 64
_KEY = 28
_COPIED_AT_ONCE = 4096
_LAST_UNIT = 0xFFFF


READ_FAULTS = (struct.error, IndexError, ValueError)
"""The errors of a reader on bad data: UnicodeDecodeError and DataFaultError are ValueErrors."""


class DataFaultError(ValueError):
    """Raised inside this package when bytes are not a message; the error's text is the reason.

    Callers of the package receive another error instead.
    """


class Texts(dict[str, bytes]):
    """A cache of encoded strings: length, UTF-8, NUL, and zeros up to a multiple of `alignment`."""

    def __init__(self, alignment: int) -> None:
        super().__init__()
        self._alignment = alignment

    def __missing__(self, text: str) -> bytes:
        raw = text.encode()
        piece = _LENGTH.pack(len(raw) + 1) + raw + b"\0"
        piece += bytes(-len(piece) % self._alignment)
        if len(raw) <= _LONGEST_KEPT:
            if len(self) >= _MOST_TEXTS:
                self.clear()
            self[text] = piece
        return piece


class TextLists(dict[tuple[str, ...], bytes]):
    """A cache of encoded lists of strings: their number, then each string as in `Texts`.

    Only the last string is padded to `alignment`.
    """

    def __init__(self, alignment: int) -> None:
        super().__init__()
        self._last = TEXT1 if alignment == 1 else TEXT4

    def __missing__(self, texts: tuple[str, ...]) -> bytes:
        piece = _LENGTH.pack(len(texts)) + b"".join([TEXT4[text] for text in texts[:-1]])
        if texts:
            piece += self._last[texts[-1]]
        if len(piece) <= _LONGEST_BLOCK_KEPT:
            if len(self) >= _MOST_BLOCKS:
                self.clear()
            self[texts] = piece
        return piece


TEXT1 = Texts(1)
TEXT4 = Texts(4)
TEXT_LIST1 = TextLists(1)
TEXT_LIST4 = TextLists(4)

_blocks: dict[bytes, tuple[bytes, list[str], int]] = {}
"""Their beginning -> the bytes of a list of texts, the texts, and the length of the bytes."""


def read_texts(data: bytes, at: int, count: int) -> tuple[list[str], int]:
    """Read a list of strings from a message.

    Args:
        data: the message.
        at: the offset of the first string's length, a multiple of four.
        count: the number of strings.

    Returns:
        The strings, and the offset of the end of the last one.
    """
    key = data[at - 4 : at + _KEY]
    kept = _blocks.get(key)
    if kept is not None and data.startswith(kept[0], at):
        return kept[1].copy(), at + kept[2]
    start, end = at, len(data)
    if count * 4 > end - at:
        truncated()
    texts = []
    length_at = _LENGTH.unpack_from
    for _ in range(count):
        at = (at + 3) & ~3
        (length,) = length_at(data, at)
        at += 4
        if length:
            last = at + length - 1
            if data[last]:
                unterminated()
            texts.append(str(data[at:last], "utf-8"))
            at = last + 1
        else:
            texts.append("")
    if count and at - start <= _LONGEST_BLOCK_KEPT:
        if len(_blocks) >= _MOST_BLOCKS:
            _blocks.clear()
        _blocks[key] = (data[start:at], texts.copy(), at - start)
    return texts, at


def read_numbers(code: str, data: bytes, start: int, end: int) -> array[Any]:
    """Return the numbers in a range of a message, after checking the message's length."""
    if end > len(data):
        truncated()
    if end - start <= _COPIED_AT_ONCE:
        return array(code, data[start:end])
    numbers = array(code)
    numbers.frombytes(memoryview(data)[start:end])
    return numbers


def read_bools(data: bytes, start: int, end: int) -> list[bool]:
    """Return the bools in a range of a message, after checking the message's length."""
    raw = data[start:end]
    if len(raw) < end - start:
        truncated()
    if raw.translate(None, b"\0\1"):
        bad_bool(max(raw))
    return list(map(bool, raw))


def read_bytes(data: bytes, start: int, end: int) -> list[bytes]:
    """Return the single bytes in a range of a message, after checking the message's length."""
    if end > len(data):
        truncated()
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
        truncated()
    units = array("I", data[at:end])
    if order == ">":
        units.byteswap()
    most = max(units, default=0)
    if most > _LAST_UNIT:
        raise DataFaultError(
            phrase("a wide string contains a unit of {value}; units of UTF-16 are at most 65535", value=most)
        )
    return str(array("H", units).tobytes(), "utf-16-le"), end


def write_wide_text(text: str) -> bytes:
    """Encode a wide string: the number of UTF-16 units, then each unit in four bytes."""
    units = array("I", array("H", text.encode("utf-16-le")))
    return _LENGTH.pack(len(units)) + units.tobytes()


def truncated() -> None:
    """Raise the error for truncated data, or for an impossible length in the data."""
    raise DataFaultError(phrase("the data ends in the middle of the message, or a length in it is wrong"))


def unterminated() -> None:
    """Raise the error for a string that does not end with NUL."""
    raise DataFaultError(phrase("the end of a string does not match its length"))


def bad_bool(value: int) -> None:
    """Raise the error for a bool that is neither 0 nor 1."""
    raise DataFaultError(phrase("a bool has the value {value}", value=value))


def too_long(name: str, bound: int) -> None:
    """Raise the error for a field with more values or characters than its bound allows."""
    raise DataFaultError(phrase("'{name}' is longer than its bound of {bound}", name=name, bound=bound))


def check_bounds(name: str, texts: list[str], bound: int) -> None:
    """Check that no string is longer than a bound."""
    if any(len(text) > bound for text in texts):
        too_long(name, bound)
