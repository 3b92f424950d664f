"""What displays draw of the messages they take: content with large arrays, as binary frames.

A frame is four uint32 (kind 2, bytes of the header, 0, 0), the header as JSON in UTF-8, and the arrays; the header and
each array are padded to a multiple of 8 bytes. The header is ``{"display", "key", "frame", "stamp", "pose",
"content"}``; where the content has an array the JSON has ``{"$": [type, offset, count]}``: the type is ``f4``, little
endian, or ``u1``, and the offset counts bytes from the end of the padded header.
"""

from __future__ import annotations

import dataclasses
import json
import struct
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.protocol.record import record

if TYPE_CHECKING:
    from linkwright.viewer.protocol import DataContent

DATA_KIND = 2
_HEADER = struct.Struct("<IIII")
_ALIGNMENT = 8

Floats = NDArray[np.float32]
"""An array of any shape that pages see flat, as a Float32Array."""

Bytes = NDArray[np.uint8]
"""As a Uint8Array."""

_TYPES = {"f": ("f4", "<f4"), "u": ("u1", "u1")}
_EMPTY: dict[str, dict[str, list[Any]]] = {kind: {"$": [name, 0, 0]} for kind, (name, _) in _TYPES.items()}
"""What stands for empty arrays, of which simple markers have three each."""

_PLAIN_TYPES = frozenset((str, float, int, bool, type(None)))


@record
class DisplayForgotten:
    """Content of a display is to be drawn no more: that with a key, or all of it."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "key")

    display: str
    key: str | None
    type: Literal["display_forgotten"] = "display_forgotten"


def pack_data(
    display: str,
    content: DataContent,
    *,
    key: str = "",
    frame: str = "",
    pose: NDArray[Any] | None = None,
    stamp: float = 0.0,
) -> bytes:
    """One binary frame with what a display draws.

    Args:
        display: its id.
        content: a dataclass of `DataContent`.
        key: which of several contents of the display this is; a newer one with the key replaces it.
        frame: the frame that the content is in; empty for the Fixed Frame.
        pose: x, y, z, qx, qy, qz, qw of that frame in the Fixed Frame when the content was true; None when it is to
            follow the frame wherever it goes.
        stamp: of the content, seconds.

    Raises:
        ValueError: when a number outside of the arrays is not finite.
    """
    arrays = _Arrays()
    header = {
        "display": display,
        "key": key,
        "frame": frame,
        "stamp": stamp,
        "pose": None if pose is None else [float(each) for each in pose],
        "content": _plain(content, arrays),
    }
    text = json.dumps(header, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode("utf-8", "replace")
    parts = [_HEADER.pack(DATA_KIND, len(text), 0, 0), text, _padding(_HEADER.size + len(text))]
    return b"".join([*parts, *arrays.parts])


class _Arrays:
    """The arrays of a frame, one after the other.

    Attributes:
        parts: their bytes and what pads them.
    """

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self._length = 0

    def put(self, array: NDArray[Any]) -> dict[str, list[Any]]:
        """Add one; what stands for it in the header."""
        if array.size == 0:
            return _EMPTY[array.dtype.kind]
        name, wire = _TYPES[array.dtype.kind]
        reference = {"$": [name, self._length, array.size]}
        data = np.ascontiguousarray(array, dtype=wire).tobytes()
        padding = _padding(len(data))
        self.parts += [data, padding]
        self._length += len(data) + len(padding)
        return reference


def _plain(value: Any, arrays: _Arrays) -> Any:
    """As JSON can have it. A frame may hold thousands of markers, most of them numbers in lists."""
    kind: Any = type(value)
    if kind in _PLAIN_TYPES:
        return value
    if kind is list:
        return [item if type(item) in _PLAIN_TYPES else _plain(item, arrays) for item in value]
    if isinstance(value, np.ndarray):
        return arrays.put(value)
    if kind is dict:
        return {key: _plain(item, arrays) for key, item in value.items()}
    if isinstance(value, (str, int, float)):
        return value  # of classes derived from these
    return {
        name: item if type(item := getattr(value, name)) in _PLAIN_TYPES else _plain(item, arrays)
        for name in _field_names(kind)
    }


@cache
def _field_names(cls: Any) -> tuple[str, ...]:
    return tuple(each.name for each in dataclasses.fields(cls))


def _padding(length: int) -> bytes:
    return b"\0" * (-length % _ALIGNMENT)
