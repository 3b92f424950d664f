"""Frames: their names as a message, where they are as a binary frame."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.protocol.message import ServerMessage

_TRANSFORMS_HEADER = struct.Struct("<IIIId")
TRANSFORMS_KIND = 1


class FrameTable(ServerMessage):
    """Names and parents (index, -1 for a root) of the frames in the binary frames with this revision."""

    revision: int
    names: list[str]
    parents: list[int]


def pack_transforms(revision: int, stamp: float, poses: NDArray[Any], ages: NDArray[Any]) -> bytes:
    """One binary frame: header, poses, ages, little endian.

    The header is four uint32 (kind 1, revision of the frame table, number of frames N, 0) and a float64 stamp in
    seconds; then float32 N x 7 (x y z qx qy qz qw in the fixed frame, NaN where there is no transform) and float32 N
    (seconds since each frame was last heard of; 0 for static frames).

    Args:
        revision: of the `FrameTable` that names the rows.
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
    """Revision and poses, shape (N, 7), of a frame of `pack_transforms`; revision -1 for another kind of frame."""
    if len(frame) < _TRANSFORMS_HEADER.size or _TRANSFORMS_HEADER.unpack_from(frame)[0] != TRANSFORMS_KIND:
        return -1, np.empty((0, 7))
    _, revision, count, _, _ = _TRANSFORMS_HEADER.unpack_from(frame)
    numbers = np.frombuffer(frame, "<f4", count * 7, _TRANSFORMS_HEADER.size)
    return revision, numbers.reshape(count, 7).astype(np.float64)
