"""tf2_msgs: many transforms at once.

Five hundred joints at 30 Hz are 15 000 transforms a second. As message objects they would cost more than everything
else in the process together, so a `TFMessage` may carry a `TransformBatch`, the same facts as names and one array,
and makes the objects only for a reader who asks for them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.messages.geometry import Quaternion, Transform, TransformStamped, Vector3
from linkwright.messages.standard import Header
from linkwright.messages.time import Time


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
        rows = [
            (t.x, t.y, t.z, q.x, q.y, q.z, q.w)
            for t, q in ((each.transform.translation, each.transform.rotation) for each in transforms)
        ]
        return cls(
            parents=tuple(each.header.frame_id for each in transforms),
            children=tuple(each.child_frame_id for each in transforms),
            stamp_ns=max((each.header.stamp.nanoseconds for each in transforms), default=0),
            poses=np.array(rows, dtype=np.float64).reshape(-1, 7),
        )

    def to_messages(self) -> list[TransformStamped]:
        """The transforms as message objects."""
        return [
            TransformStamped(
                Header(Time.from_nanoseconds(self.stamp_ns), parent),
                child,
                Transform(Vector3(*row[:3]), Quaternion(*row[3:])),
            )
            for parent, child, row in zip(self.parents, self.children, self.poses.tolist(), strict=True)
        ]


class TFMessage:
    """Transforms, held as message objects or as a batch; each form is made from the other when it is asked for.

    Args:
        transforms: message objects; none when left out.
        batch: the transforms as arrays, instead of objects.
    """

    TYPE_NAME: ClassVar[str] = "tf2_msgs/msg/TFMessage"

    __slots__ = ("_batch", "_transforms")

    def __init__(
        self, transforms: Iterable[TransformStamped] | None = None, *, batch: TransformBatch | None = None
    ) -> None:
        if transforms is not None and batch is not None:
            raise ValueError("a TFMessage takes transforms or a batch, not both")
        self._batch = batch
        self._transforms = None if batch is not None else list(transforms or ())

    @property
    def transforms(self) -> list[TransformStamped]:
        """The transforms as message objects.

        The list of a message made from objects may be changed until it is published, that of one made from a batch
        never.
        """
        if self._transforms is None:
            assert self._batch is not None
            self._transforms = self._batch.to_messages()
        return self._transforms

    @transforms.setter
    def transforms(self, transforms: Iterable[TransformStamped]) -> None:
        self._transforms = list(transforms)
        self._batch = None

    @property
    def batch(self) -> TransformBatch:
        """The transforms as arrays. A message made from a batch gives that one; any other makes one of its list."""
        if self._batch is not None:
            return self._batch
        assert self._transforms is not None
        return TransformBatch.from_messages(self._transforms)

    def __eq__(self, other: object) -> bool:
        return self.transforms == other.transforms if isinstance(other, TFMessage) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # a mutable value, like the other messages

    def __repr__(self) -> str:
        return f"TFMessage(transforms={self.transforms!r})"
