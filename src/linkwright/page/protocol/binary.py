"""Binary frames to pages, little endian: transforms, content with large arrays, and pieces of these.

Content is what displays draw of the messages they take. Its frame is four uint32 (kind 2, bytes of the header, 0, 0),
the header as JSON in UTF-8, and the arrays; the header and each array are padded to a multiple of 8 bytes. The header
is ``{"display", "key", "frame", "stamp", "pose", "content"}``; where the content has an array the JSON has ``{"$":
[type, offset, count]}``: the type is ``f4`` or ``u1``, and the offset counts bytes from the end of the padded header.
"""

from __future__ import annotations

import json
import struct
from typing import Any, ClassVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from linkwright.page.protocol.message import DataContent, ServerMessage, plain

_TRANSFORMS_HEADER = struct.Struct("<IIIId")
TRANSFORMS_KIND = 1


class FrameTable(ServerMessage):
    """Names and parents (index, -1 for a root) of the frames in the binary frames with this revision."""

    revision: int
    names: list[str]
    parents: list[int]


def pack_transforms(revision: int, stamp: float, poses: NDArray[Any], ages: NDArray[Any]) -> bytes:
    """Return a binary frame of transforms: header, poses, ages, little endian.

    The header is four uint32 (kind 1, revision of the frame table, number of frames N, 0) and a float64 stamp in
    seconds; then float32 N x 7 (x y z qx qy qz qw in the fixed frame, NaN where there is no transform) and float32 N
    (seconds since each frame's last transform; 0 for static frames).

    Args:
        revision: the revision of the `FrameTable` that names the rows.
        stamp: time of the newest transform in it, seconds.
        poses: array, shape (N, 7).
        ages: array, shape (N,).

    Raises:
        ValueError: when the shapes do not agree.
    """
    count = len(poses)
    if poses.shape != (count, 7) or ages.shape != (count,):
        raise ValueError(f"poses must be (N, 7) and ages (N,), not {poses.shape} and {ages.shape}")
    header = _TRANSFORMS_HEADER.pack(TRANSFORMS_KIND, revision, count, 0, stamp)
    return header + poses.astype("<f4").tobytes() + np.asarray(ages).astype("<f4").tobytes()


def unpack_transforms(frame: bytes) -> tuple[int, NDArray[np.float64]]:
    """Return revision and poses, shape (N, 7), of a frame of `pack_transforms`; revision -1 for other frames."""
    if len(frame) < _TRANSFORMS_HEADER.size or _TRANSFORMS_HEADER.unpack_from(frame)[0] != TRANSFORMS_KIND:
        return -1, np.empty((0, 7))
    _, revision, count, _, _ = _TRANSFORMS_HEADER.unpack_from(frame)
    numbers = np.frombuffer(frame, "<f4", count * 7, _TRANSFORMS_HEADER.size)
    return revision, numbers.reshape(count, 7).astype(np.float64)


DATA_KIND = 2
_HEADER = struct.Struct("<IIII")
_ALIGNMENT = 8

Floats = NDArray[np.float32]
"""An array of any shape, flat in the page, as a Float32Array."""

Bytes = NDArray[np.uint8]
"""Bytes; a Uint8Array in the page."""

_TYPES = {"f": ("f4", "<f4"), "u": ("u1", "u1")}
_EMPTY: dict[str, dict[str, list[Any]]] = {kind: {"$": [name, 0, 0]} for kind, (name, _) in _TYPES.items()}
"""The placeholder of empty arrays, of which simple markers have three each."""


class DisplayForgotten(ServerMessage):
    """Remove a display's content: that with a key, or all of it."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "key")

    display: str
    key: str | None


def pack_data(
    display: str,
    content: DataContent,
    *,
    key: str = "",
    frame: str = "",
    pose: NDArray[Any] | None = None,
    stamp: float = 0.0,
) -> bytes:
    """Return a binary frame with a display's content.

    Args:
        display: its id.
        content: a dataclass of `DataContent`.
        key: the key of this content among several of the display; a newer one with the key replaces it.
        frame: the frame that the content is in; empty for the Fixed Frame.
        pose: x, y, z, qx, qy, qz, qw of that frame in the Fixed Frame when the content was true; None when it is to
            follow the frame wherever it goes.
        stamp: the time of the content, seconds.
    """
    arrays = _Arrays()
    header = {
        "display": display,
        "key": key,
        "frame": frame,
        "stamp": stamp,
        "pose": None if pose is None else [float(number) for number in pose],
        "content": content,
    }
    text = _json(header, arrays)
    parts = [_HEADER.pack(DATA_KIND, len(text), 0, 0), text, _padding(_HEADER.size + len(text))]
    return b"".join([*parts, *arrays.parts])


class _Arrays:
    """The arrays of a frame, one after the other.

    Attributes:
        parts: their bytes and the padding.
    """

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self._length = 0

    def clear(self) -> None:
        """Forget all arrays."""
        self.parts.clear()
        self._length = 0

    def put_aside(self, value: Any) -> Any:
        """Add an array and return its placeholder in the header; other values become plain ones."""
        return self.put(value) if isinstance(value, np.ndarray) else plain(value)

    def put(self, array: NDArray[Any]) -> dict[str, list[Any]]:
        """Add an array; returns its placeholder in the header."""
        if array.size == 0:
            return _EMPTY[array.dtype.kind]
        name, wire = _TYPES[array.dtype.kind]
        reference = {"$": [name, self._length, array.size]}
        data = np.ascontiguousarray(array, dtype=wire).tobytes()
        padding = _padding(len(data))
        self.parts += [data, padding]
        self._length += len(data) + len(padding)
        return reference


def _json(header: dict[str, Any], arrays: _Arrays) -> bytes:
    """Return the header, without its arrays; half characters, as names of files may have, become question marks."""
    try:
        return msgspec.json.encode(header, enc_hook=arrays.put_aside)
    except UnicodeEncodeError:
        arrays.clear()
        header = msgspec.to_builtins(header, enc_hook=arrays.put_aside)
        return json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "replace")


def _padding(length: int) -> bytes:
    return b"\0" * (-length % _ALIGNMENT)


PIECE_KIND = 4


def pack_piece(frame: bytes, number: int, offset: int, size: int) -> bytes:
    """Return a binary frame with a part of another.

    It is four uint32, little endian (kind 4, number, offset, length of the whole frame), and the bytes from the offset
    on. The page takes the whole frame as received when it has the last piece; a piece with the offset 0 begins another.

    Args:
        frame: the complete frame.
        number: the same for all pieces of the frame, and another for those of the next.
        offset: the offset of the piece, bytes.
        size: the largest size of the piece, bytes.
    """
    return _HEADER.pack(PIECE_KIND, number, offset, len(frame)) + frame[offset : offset + size]
