"""Layouts of transforms between the same frames, whose bytes differ in nothing but stamps and numbers.

A `TransformLayout` knows where those stand. So a message is written by filling a template, and one that was received
is recognised by comparing the rest with the template; in both directions the time for a transform is a few
nanoseconds, and no object is made for it.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.messages.cdr.values import TEXT4
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_HEADER = b"\x00\x01\x00\x00"
_MOST_KEPT = 64
_MOST_OF_ONE_LENGTH = 4

_layouts: dict[tuple[tuple[str, ...], tuple[str, ...]], TransformLayout] = {}
_by_length: dict[int, list[TransformLayout]] = {}


class TransformLayout:
    """The positions of stamps and poses in a TFMessage of certain frames.

    Args:
        parents: the frame each transform is given in.
        children: the frame each transform places.
    """

    def __init__(self, parents: tuple[str, ...], children: tuple[str, ...]) -> None:
        self.parents = parents
        self.children = children
        pieces = [struct.pack("<I", len(children))]
        masks = [b"\xff" * 4]
        stamps: list[int] = []
        poses: list[int] = []
        at = 4
        for parent, child in zip(parents, children, strict=True):
            texts = TEXT4[parent] + TEXT4[child]
            stamps.append(at // 4)
            at += 8 + len(texts)
            padding = -at % 8
            poses.append((at + padding) // 8)
            pieces.append(bytes(8) + texts + bytes(padding + 56))
            masks.append(bytes(8) + _mask(parent) + _mask(child) + bytes(padding + 56))
            at += padding + 56
        # The number of transforms alone is four bytes; any transform ends at a multiple of eight.
        self.length = len(_HEADER) + at
        self._words = np.frombuffer(b"".join(pieces) + bytes(-at % 8), np.uint64)
        self._mask = np.frombuffer(b"".join(masks) + bytes(-at % 8), np.uint64)
        self._stamps = np.array(stamps, dtype=np.intp)
        self._poses = np.array(poses, dtype=np.intp)[:, None] + np.arange(7)

    def with_one_stamp(self, stamp_ns: int, poses: NDArray[np.float64]) -> bytes:
        """The message of these poses with one stamp for all.

        Args:
            stamp_ns: nanoseconds since the epoch.
            poses: array, shape (n, 7), of x y z qx qy qz qw.

        Raises:
            OverflowError: the seconds are more than 32 bits can hold.
        """
        sec, nanosec = divmod(stamp_ns, NANOSECONDS_PER_SECOND)
        if not -(1 << 31) <= sec < 1 << 31:
            raise OverflowError(f"the stamp {stamp_ns} ns is more than 32 bits of seconds can hold")
        words = self._words.copy()
        halves = words.view(np.uint32)
        halves[self._stamps] = sec & 0xFFFFFFFF
        halves[self._stamps + 1] = nanosec
        return self._finished(words, poses)

    def with_stamps(self, stamps: Sequence[tuple[int, int]], poses: NDArray[np.float64]) -> bytes:
        """The message of these poses, each with its own stamp: seconds and nanoseconds."""
        words = self._words.copy()
        words.view(np.uint32)[self._stamps] = np.array([sec for sec, _ in stamps], np.int32).view(np.uint32)
        words.view(np.uint32)[self._stamps + 1] = np.array([nanosec for _, nanosec in stamps], np.uint32)
        return self._finished(words, poses)

    def _finished(self, words: NDArray[np.uint64], poses: NDArray[np.float64]) -> bytes:
        words.view(np.float64)[self._poses] = poses
        return _HEADER + words.tobytes()[: self.length - len(_HEADER)]

    def register(self) -> None:
        """Register this layout for messages that are received."""
        same_length = _by_length.setdefault(self.length, [])
        if self not in same_length:
            if len(_by_length) > _MOST_KEPT:
                _by_length.clear()
            same_length.insert(0, self)
            del same_length[_MOST_OF_ONE_LENGTH:]
            _by_length[self.length] = same_length

    def fits(self, words: NDArray[np.uint64]) -> bool:
        """Whether a message's words, without its header, are of these frames; stamps and numbers may be any."""
        return not ((words ^ self._words) & self._mask).any()

    def poses_in(self, words: NDArray[np.uint64]) -> NDArray[np.float64]:
        """The poses in a message, shape (n, 7)."""
        poses: NDArray[np.float64] = words.view(np.float64)[self._poses]
        return poses

    def stamps_in(self, words: NDArray[np.uint64]) -> NDArray[np.int64]:
        """The stamps in a message, nanoseconds since the epoch."""
        stamps = words.view(np.int32)[self._stamps].astype(np.int64)
        stamps *= NANOSECONDS_PER_SECOND
        stamps += words.view(np.uint32)[self._stamps + 1]
        return stamps


class ReceivedTransforms(NamedTuple):
    """A message that was received, and the layout that it has.

    Attributes:
        layout: the positions of the values.
        data: the message, header included.
        words: the message without its header.
    """

    layout: TransformLayout
    data: bytes
    words: NDArray[np.uint64]

    def poses(self) -> NDArray[np.float64]:
        """Array, shape (n, 7), of x y z qx qy qz qw."""
        return self.layout.poses_in(self.words)

    def stamps_ns(self) -> NDArray[np.int64]:
        """The stamp of each transform, nanoseconds since the epoch."""
        return self.layout.stamps_in(self.words)

    def newest_ns(self) -> int:
        """The newest stamp, in nanoseconds since the epoch."""
        stamps = self.stamps_ns()
        return int(stamps.max()) if len(stamps) else 0


def layout_for(parents: tuple[str, ...], children: tuple[str, ...]) -> TransformLayout:
    """The layout of a message with these frames; cached."""
    key = (parents, children)
    layout = _layouts.get(key)
    if layout is None:
        if len(_layouts) >= _MOST_KEPT:
            _layouts.clear()
        layout = _layouts[key] = TransformLayout(parents, children)
    return layout


def matching_layout(data: bytes) -> ReceivedTransforms | None:
    """The layout, of those remembered, that a received message has; None when it has none of them.

    Args:
        data: a message with a little-endian header.
    """
    candidates = _by_length.get(len(data))
    if candidates is None:
        return None
    words = np.frombuffer(data[len(_HEADER) :], np.uint64)
    for layout in candidates:
        if layout.fits(words):
            return ReceivedTransforms(layout, data, words)
    return None


def _mask(text: str) -> bytes:
    """Ones for the length and the text, zeros for the padding, which may have any value."""
    length = 4 + len(text.encode()) + 1
    return b"\xff" * length + bytes(-length % 4)
