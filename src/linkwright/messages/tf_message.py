"""The message tf2_msgs/msg/TFMessage, optimized for many transforms.

Five hundred joints at 30 Hz are 15 000 transforms per second. Creating message objects for them would take longer than
all other work of the process. Therefore, a `TFMessage` may contain a `TransformBatch`, which has the same data as names
and one array, or the received bytes. It creates the objects only when they are requested.

Messages with transforms between the same frames differ only in the bytes of stamps and numbers. A `TransformLayout`
stores the positions of these bytes. A message is written by filling in a template, and a received message is recognized
by comparing its other bytes with the template. In both directions, a transform takes a few nanoseconds and no object is
created.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.messages.cdr.values import TEXT4
from linkwright.messages.classes import add_class, class_of
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.message import Message, definition_of, from_values
from linkwright.messages.wellknown import Header, Quaternion, Time, Transform, TransformStamped, Vector3
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_HEADER = b"\x00\x01\x00\x00"
_MAX_LAYOUTS = 64
_MAX_LAYOUTS_PER_LENGTH = 4

_layouts: dict[tuple[tuple[str, ...], tuple[str, ...]], TransformLayout] = {}
_layouts_by_length: dict[int, list[TransformLayout]] = {}


class TransformLayout:
    """The positions of stamps and poses in the bytes of a TFMessage with particular frames.

    Args:
        parents: the parent frame of each transform.
        children: the child frame of each transform.
    """

    def __init__(self, parents: tuple[str, ...], children: tuple[str, ...]) -> None:
        self.parents = parents
        self.children = children
        template_chunks = [struct.pack("<I", len(children))]
        masks = [b"\xff" * 4]
        stamps: list[int] = []
        poses: list[int] = []
        offset = 4
        for parent, child in zip(parents, children, strict=True):
            encoded_names = TEXT4[parent] + TEXT4[child]
            stamps.append(offset // 4)
            offset += 8 + len(encoded_names)
            padding = -offset % 8
            poses.append((offset + padding) // 8)
            template_chunks.append(bytes(8) + encoded_names + bytes(padding + 56))
            masks.append(bytes(8) + _mask(parent) + _mask(child) + bytes(padding + 56))
            offset += padding + 56
        # The number of transforms takes four bytes; each transform ends at a multiple of eight.
        self.length = len(_HEADER) + offset
        self._words = np.frombuffer(b"".join(template_chunks) + bytes(-offset % 8), np.uint64)
        self._mask = np.frombuffer(b"".join(masks) + bytes(-offset % 8), np.uint64)
        self._stamps = np.array(stamps, dtype=np.intp)
        self._poses = np.array(poses, dtype=np.intp)[:, None] + np.arange(7)

    def with_one_stamp(self, stamp_ns: int, poses: NDArray[np.float64]) -> bytes:
        """Return the bytes of a message with a pose for each transform and one stamp for all.

        Args:
            stamp_ns: the stamp, in nanoseconds since the epoch.
            poses: array, shape (n, 7), of x y z (meters) and qx qy qz qw.

        Raises:
            OverflowError: the seconds do not fit into 32 bits.
        """
        sec, nanosec = divmod(stamp_ns, NANOSECONDS_PER_SECOND)
        if not -(1 << 31) <= sec < 1 << 31:
            raise OverflowError(f"the seconds of the stamp {stamp_ns} ns do not fit into 32 bits")
        words = self._words.copy()
        halves = words.view(np.uint32)
        halves[self._stamps] = sec & 0xFFFFFFFF
        halves[self._stamps + 1] = nanosec
        return self._with_poses(words, poses)

    def with_stamps(self, stamps: Sequence[tuple[int, int]], poses: NDArray[np.float64]) -> bytes:
        """Return the bytes of a message with a pose and a stamp for each transform.

        Args:
            stamps: the seconds and nanoseconds of each stamp.
            poses: array, shape (n, 7), of x y z (meters) and qx qy qz qw.
        """
        words = self._words.copy()
        words.view(np.uint32)[self._stamps] = np.array([sec for sec, _ in stamps], np.int32).view(np.uint32)
        words.view(np.uint32)[self._stamps + 1] = np.array([nanosec for _, nanosec in stamps], np.uint32)
        return self._with_poses(words, poses)

    def _with_poses(self, words: NDArray[np.uint64], poses: NDArray[np.float64]) -> bytes:
        words.view(np.float64)[self._poses] = poses
        return _HEADER + words.tobytes()[: self.length - len(_HEADER)]

    def register(self) -> None:
        """Register this layout, so that received messages of the same length are compared with it."""
        same_length = _layouts_by_length.setdefault(self.length, [])
        if self not in same_length:
            if len(_layouts_by_length) > _MAX_LAYOUTS:
                _layouts_by_length.clear()
            same_length.insert(0, self)
            del same_length[_MAX_LAYOUTS_PER_LENGTH:]
            _layouts_by_length[self.length] = same_length

    def fits(self, words: NDArray[np.uint64]) -> bool:
        """Return whether a message has the frames of this layout, with any stamps and numbers.

        Args:
            words: the message without its header.
        """
        return not ((words ^ self._words) & self._mask).any()

    def poses_in(self, words: NDArray[np.uint64]) -> NDArray[np.float64]:
        """Return the poses in a message: array, shape (n, 7), of x y z (meters) and qx qy qz qw."""
        poses: NDArray[np.float64] = words.view(np.float64)[self._poses]
        return poses

    def stamps_in(self, words: NDArray[np.uint64]) -> NDArray[np.int64]:
        """Return the stamp of each transform in a message, in nanoseconds since the epoch."""
        stamps = words.view(np.int32)[self._stamps].astype(np.int64)
        stamps *= NANOSECONDS_PER_SECOND
        stamps += words.view(np.uint32)[self._stamps + 1]
        return stamps


class ReceivedTransforms(NamedTuple):
    """A received message and its layout.

    Attributes:
        layout: the positions of stamps and poses.
        data: the bytes of the message, including the header.
        words: the message without its header, as unsigned 64-bit integers.
    """

    layout: TransformLayout
    data: bytes
    words: NDArray[np.uint64]

    def poses(self) -> NDArray[np.float64]:
        """Return the poses: array, shape (n, 7), of x y z (meters) and qx qy qz qw."""
        return self.layout.poses_in(self.words)

    def stamps_ns(self) -> NDArray[np.int64]:
        """Return the stamp of each transform, in nanoseconds since the epoch."""
        return self.layout.stamps_in(self.words)

    def newest_ns(self) -> int:
        """Return the newest stamp, in nanoseconds since the epoch."""
        stamps = self.stamps_ns()
        return int(stamps.max()) if len(stamps) else 0


def layout_for(parents: tuple[str, ...], children: tuple[str, ...]) -> TransformLayout:
    """Return the cached layout for messages with these parent and child frames."""
    key = (parents, children)
    layout = _layouts.get(key)
    if layout is None:
        if len(_layouts) >= _MAX_LAYOUTS:
            _layouts.clear()
        layout = _layouts[key] = TransformLayout(parents, children)
    return layout


def matching_layout(data: bytes) -> ReceivedTransforms | None:
    """Return a received message with the registered layout that it matches, or None.

    Args:
        data: the bytes of a message with a little-endian header.
    """
    candidates = _layouts_by_length.get(len(data))
    if candidates is None:
        return None
    words = np.frombuffer(data[len(_HEADER) :], np.uint64)
    for layout in candidates:
        if layout.fits(words):
            return ReceivedTransforms(layout, data, words)
    return None


def _mask(text: str) -> bytes:
    """Return a mask for an encoded string, with ones for its bytes and zeros for the padding.

    Padding may have any value.
    """
    length = 4 + len(text.encode()) + 1
    return b"\xff" * length + bytes(-length % 4)


_MAX_SINGLE_TRANSFORMS = 6
"""The maximum number of transforms for which single objects are faster than a layout."""

_SHORT_MESSAGE_SIZE = 600
"""The size in bytes below which a message contains only a few transforms."""


@dataclass(frozen=True, slots=True, eq=False)
class TransformBatch:
    """Transforms with the same stamp, stored as arrays.

    A publisher that repeatedly sends the same frames should always pass the same two tuples, because receivers use them
    as cache keys.

    Attributes:
        parents: the parent frame of each transform.
        children: the child frame of each transform.
        stamp_ns: the stamp of all transforms, in nanoseconds since the epoch.
        poses: array, shape (n, 7), of the pose of each child in its parent: x y z (meters) and qx qy qz qw.
    """

    parents: tuple[str, ...]
    children: tuple[str, ...]
    stamp_ns: int
    poses: NDArray[np.float64]

    def __post_init__(self) -> None:
        count = len(self.children)
        if len(self.parents) != count or self.poses.shape != (count, 7):
            raise ValueError(
                f"{len(self.parents)} parents, {count} children and poses of shape {self.poses.shape} do not agree"
            )

    def __len__(self) -> int:
        return len(self.children)

    @classmethod
    def from_messages(cls, transforms: Iterable[TransformStamped]) -> TransformBatch:
        """Create a batch from message objects, with the newest of their stamps."""
        transforms = list(transforms)
        return cls(
            parents=tuple(transform.header.frame_id for transform in transforms),
            children=tuple(transform.child_frame_id for transform in transforms),
            stamp_ns=max((transform.header.stamp.nanoseconds for transform in transforms), default=0),
            poses=_poses(transforms),
        )

    def to_messages(self) -> list[TransformStamped]:
        """Return the transforms as message objects."""
        stamp = Time.from_nanoseconds(self.stamp_ns)
        return [
            TransformStamped(
                header=Header(stamp=Time(sec=stamp.sec, nanosec=stamp.nanosec), frame_id=parent),
                child_frame_id=child,
                transform=Transform(
                    translation=from_values(Vector3, pose[:3]), rotation=from_values(Quaternion, pose[3:])
                ),
            )
            for parent, child, pose in zip(self.parents, self.children, self.poses.tolist(), strict=True)
        ]


class TFMessage(Message):
    """Transforms, stored as message objects, as a batch or as received bytes.

    The other forms are created on demand.

    Args:
        transforms: the transforms as message objects; an empty list by default.
        batch: the transforms as arrays, instead of `transforms`.
    """

    __module__ = "tf2_msgs.msg._tf_message"  # The module that repr shows and rclpy's users expect.

    __slots__ = ("_batch", "_list", "_received")

    TYPE_NAME = "tf2_msgs/msg/TFMessage"
    _definition = LIBRARY.structure("tf2_msgs/msg/TFMessage")

    def __init__(
        self, *, transforms: Iterable[TransformStamped] | None = None, batch: TransformBatch | None = None, **other: Any
    ) -> None:
        if other:
            raise AssertionError("Invalid arguments passed to constructor: " + ", ".join(sorted(other)))
        if transforms is not None and batch is not None:
            raise ValueError("a TFMessage takes transforms or a batch, not both")
        self._received: ReceivedTransforms | None = None
        self._batch = batch
        self._list: list[TransformStamped] | None = None
        if batch is None:
            self.transforms = [] if transforms is None else transforms

    @property
    def transforms(self) -> list[TransformStamped]:
        """The transforms as message objects.

        If the message was created from objects, the list may be changed until the message is published. If it was
        created from a batch, the list must not be changed.
        """
        if self._list is None:
            if self._received is not None:
                self._list = _generic_reader()(self._received.data)._list
                self._received = self._batch = None
            else:
                assert self._batch is not None
                self._list = self._batch.to_messages()
        assert self._list is not None
        return self._list

    @transforms.setter
    def transforms(self, transforms: Iterable[TransformStamped]) -> None:
        values = transforms if isinstance(transforms, list) else list(transforms)
        if not all(isinstance(value, TransformStamped) for value in values):
            raise AssertionError(
                "The 'transforms' field must be a set or sequence and each value of type 'TransformStamped'"
            )
        self._list = values
        self._batch = None
        self._received = None

    _transforms = transforms  # rclpy's class has a slot with this name

    @property
    def batch(self) -> TransformBatch:
        """The transforms as arrays.

        They are created on demand if the message was not created from a batch.
        """
        if self._batch is not None:
            return self._batch
        if self._received is not None:
            received = self._received
            self._batch = TransformBatch(
                received.layout.parents, received.layout.children, received.newest_ns(), received.poses()
            )
            return self._batch
        assert self._list is not None
        return TransformBatch.from_messages(self._list)

    def columns(self) -> tuple[tuple[str, ...], tuple[str, ...], list[int], NDArray[np.float64]] | None:
        """Return the parents, children, stamps and poses of the transforms.

        Stamps are in nanoseconds since the epoch. Poses are an array, shape (n, 7), of x y z (meters) and qx qy qz qw.

        If the message stores objects, return None, because reading the objects directly is faster.
        """
        if self._received is not None:
            layout = self._received.layout
            return layout.parents, layout.children, self._received.stamps_ns().tolist(), self._received.poses()
        if self._list is None and self._batch is not None:
            batch = self._batch
            return batch.parents, batch.children, [batch.stamp_ns] * len(batch), batch.poses
        return None

    def _write(self) -> bytes:
        if self._list is None:
            if self._received is not None:
                return self._received.data
            assert self._batch is not None
            batch = self._batch
            return layout_for(batch.parents, batch.children).with_one_stamp(batch.stamp_ns, batch.poses)
        values: list[Any] = self._list
        if len(values) < _MAX_SINGLE_TRANSFORMS:
            return _generic_writer()(self)
        parents = tuple([value._header._frame_id for value in values])
        children = tuple([value._child_frame_id for value in values])
        stamps = [(value._header._stamp._sec, value._header._stamp._nanosec) for value in values]
        return layout_for(parents, children).with_stamps(stamps, _poses(values))

    @classmethod
    def _read(cls, data: bytes) -> TFMessage:
        if len(data) < _SHORT_MESSAGE_SIZE:
            return _generic_reader()(data)
        received = matching_layout(data)
        if received is None:
            message = _generic_reader()(data)
            values = message.transforms
            layout = layout_for(
                tuple([value.header.frame_id for value in values]), tuple([value.child_frame_id for value in values])
            )
            layout.register()
            return message
        message = cls.__new__(cls)
        message._received = received
        message._list = message._batch = None
        return message


# Programs read this value. It does not change the slots, which are fixed when the class is created.
TFMessage.__slots__ = ("_transforms",)  # type: ignore[assignment]  # of another length

add_class(TFMessage)


def _poses(transforms: list[Any]) -> NDArray[np.float64]:
    rows = [
        (t._x, t._y, t._z, q._x, q._y, q._z, q._w)
        for t, q in ((transform._transform._translation, transform._transform._rotation) for transform in transforms)
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


@cache
def _generic_writer() -> Callable[[Message], bytes]:
    """Return the function that writes transforms one by one, compiled on first use."""
    from linkwright.messages.cdr.writer import compile_writer

    return compile_writer(definition_of(TFMessage))


@cache
def _generic_reader() -> Callable[[bytes], TFMessage]:
    """Return the function that reads transforms one by one, compiled on first use."""
    from linkwright.messages.cdr.reader import compile_reader

    return compile_reader(definition_of(TFMessage), class_of)
