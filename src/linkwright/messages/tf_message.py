"""tf2_msgs/msg/TFMessage: many transforms at once.

Five hundred joints at 30 Hz are 15 000 transforms a second. As message objects they would cost more than everything
else in the process together, so a `TFMessage` may carry a `TransformBatch`, the same facts as names and one array, or
the bytes it was received as, and makes the objects only for a reader who asks for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages.cdr.transform_layout import ReceivedTransforms, layout_for, matching_layout
from linkwright.messages.classes import add_class, class_of
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.message import Message, definition_of
from linkwright.messages.wellknown import Header, Quaternion, Time, Transform, TransformStamped, Vector3

_FEW = 6
"""The greatest number of transforms that are written and read faster one by one than by a layout."""

_SHORT = 600
"""Bytes of a message of few transforms."""


@dataclass(frozen=True, slots=True, eq=False)
class TransformBatch:
    """Transforms that hold at one moment.

    Attributes:
        parents: the frame each transform is given in.
        children: the frame each transform places.
        stamp_ns: the moment, nanoseconds since the epoch.
        poses: array, shape (n, 7), of x y z (metres) and qx qy qz qw: each child in its parent.

    Publishers that send the same frames again and again pass the same two tuples each time: receivers keep what they
    worked out for them.
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
        """The same transforms as one batch, stamped with the newest of their stamps."""
        transforms = list(transforms)
        return cls(
            parents=tuple(transform.header.frame_id for transform in transforms),
            children=tuple(transform.child_frame_id for transform in transforms),
            stamp_ns=max((transform.header.stamp.nanoseconds for transform in transforms), default=0),
            poses=_poses(transforms),
        )

    def to_messages(self) -> list[TransformStamped]:
        """The transforms as message objects."""
        stamp = Time.from_nanoseconds(self.stamp_ns)
        return [
            TransformStamped(
                Header(Time(stamp.sec, stamp.nanosec), parent),
                child,
                Transform(Vector3(*row[:3]), Quaternion(*row[3:])),
            )
            for parent, child, row in zip(self.parents, self.children, self.poses.tolist(), strict=True)
        ]


class TFMessage(Message):
    """Transforms, held as message objects, as a batch or as they were received; other forms are made on demand.

    Args:
        transforms: message objects; none when left out.
        batch: the transforms as arrays, instead of objects.
    """

    __module__ = "tf2_msgs.msg._tf_message"  # what its repr and rclpy's users take it for

    __slots__ = ("_batch", "_list", "_received")

    TYPE_NAME = "tf2_msgs/msg/TFMessage"
    _definition = LIBRARY.structure("tf2_msgs/msg/TFMessage")

    def __init__(
        self, transforms: Iterable[TransformStamped] | None = None, *, batch: TransformBatch | None = None, **other: Any
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

        The list of a message made from objects may be changed until it is published, that of one made from a batch
        never.
        """
        if self._list is None:
            if self._received is not None:
                self._list = _ordinary_reader()(self._received.data)._list
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

    _transforms = transforms  # where rclpy's class has its slot

    @property
    def batch(self) -> TransformBatch:
        """The transforms as arrays: the batch that the message was made of, or one made of its transforms."""
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
        """Parents, children, stamps (nanoseconds since the epoch) and poses, shape (n, 7), of the transforms.

        None for a message that holds objects: these are read faster as they are.
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
        if len(values) < _FEW:
            return _ordinary_writer()(self)
        parents = tuple([value._header._frame_id for value in values])
        children = tuple([value._child_frame_id for value in values])
        stamps = [(value._header._stamp._sec, value._header._stamp._nanosec) for value in values]
        return layout_for(parents, children).with_stamps(stamps, _poses(values))

    @classmethod
    def _read(cls, data: bytes) -> TFMessage:
        if len(data) < _SHORT:
            return _ordinary_reader()(data)
        received = matching_layout(data)
        if received is None:
            message = _ordinary_reader()(data)
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


# What rclpy's users find there; the slots above are fixed by now.
TFMessage.__slots__ = ("_transforms",)  # type: ignore[assignment]  # of another length

add_class(TFMessage)


def _poses(transforms: list[Any]) -> NDArray[np.float64]:
    rows = [
        (t._x, t._y, t._z, q._x, q._y, q._z, q._w)
        for t, q in ((transform._transform._translation, transform._transform._rotation) for transform in transforms)
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


@cache
def _ordinary_writer() -> Callable[[Message], bytes]:
    """The function that writes the transforms one by one, compiled from the definition on first use."""
    from linkwright.messages.cdr.writer import compile_writer

    return compile_writer(definition_of(TFMessage))


@cache
def _ordinary_reader() -> Callable[[bytes], TFMessage]:
    """The function that reads the transforms one by one, compiled from the definition on first use."""
    from linkwright.messages.cdr.reader import compile_reader

    return compile_reader(definition_of(TFMessage), class_of)
