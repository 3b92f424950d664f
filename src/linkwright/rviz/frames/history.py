"""Recent transforms, used to place messages at the time in their headers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.geometry.arrays import compose, invert
from linkwright.graph import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS, Node, run_logged
from linkwright.messages import TFMessage

if TYPE_CHECKING:
    from linkwright.graph.transforms.core import BufferCore

_IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True)
class PlacedFrame:
    """A frame that is not in tf, placed by a display.

    Attributes:
        name: the name of the frame.
        parent: a tf frame; None while no tf frame is connected to this frame.
        pose: the pose of `parent` in this frame: x, y, z, qx, qy, qz, qw.
    """

    name: str
    parent: str | None = None
    pose: NDArray[np.float64] = field(default_factory=_IDENTITY.copy)


class FrameHistory:
    """A tf2 buffer that subscribes only while it has listeners.

    A page with only a robot does not need it.

    Displays may place frames that are not in tf. Such a frame can be the Fixed Frame. Other programs do not receive it.

    Args:
        node: the node that subscribes.

    Attributes:
        on_placed_frame: callbacks that are called when a display has placed, moved or withdrawn a frame.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._listeners: list[Callable[[], None]] = []
        self._subscriptions: list[Any] = []
        self._placed_frames: dict[str, PlacedFrame] = {}
        self.on_placed_frame: list[Callable[[], None]] = []

    @cached_property
    def _buffer(self) -> BufferCore:
        from linkwright.graph.transforms.core import BufferCore

        return BufferCore(logger=self._node.get_logger())

    def add_listener(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Subscribe, and call a listener whenever transforms arrive.

        Return a function that removes the listener, and unsubscribes if there is no other listener.
        """
        self._listeners.append(listener)
        if not self._subscriptions:
            for topic, static, qos in (("/tf", False, TF_QOS), ("/tf_static", True, STATIC_TF_SUBSCRIPTION_QOS)):
                self._subscriptions.append(
                    self._node.create_subscription(TFMessage, topic, partial(self._add_transforms, static=static), qos)
                )

        def release() -> None:
            if listener in self._listeners:
                self._listeners.remove(listener)
            if not self._listeners:
                self._unsubscribe()

        return release

    def pose(self, fixed_frame: str, frame: str, stamp_ns: int) -> NDArray[np.float64]:
        """Return the pose of a frame in the Fixed Frame: x, y, z, qx, qy, qz, qw.

        Args:
            fixed_frame: the Fixed Frame.
            frame: the frame; it need not be in tf if it is the Fixed Frame.
            stamp_ns: the time in ns since the epoch; 0 for the latest transform.

        Raises:
            TransformException: the pose is not known; the message is the text of tf2.
        """
        if frame == fixed_frame:
            return _IDENTITY
        placed_frame = self.placed_frame(fixed_frame)
        if placed_frame is not None and placed_frame.parent is not None:
            return compose(placed_frame.pose, self.pose(placed_frame.parent, frame, stamp_ns))
        pose_values, _ = self._buffer.lookup(fixed_frame, frame, stamp_ns)
        return np.array(pose_values)

    def names(self) -> frozenset[str]:
        """Return the names of all frames in the transforms received so far."""
        return frozenset(self._buffer.frame_names())

    def placed_frame(self, name: str) -> PlacedFrame | None:
        """Return the frame that a display has placed under a name, or None.

        None is also returned if tf has a frame with this name.
        """
        placed_frame = next((candidate for candidate in self._placed_frames.values() if candidate.name == name), None)
        return None if placed_frame is None or name in self._buffer.frame_names() else placed_frame

    def to_known_frame(self, frame: str, pose: ArrayLike) -> tuple[str, NDArray[np.float64]]:
        """Return a frame of tf and the pose in it, so that other programs can use the pose.

        If a display has placed the given frame, the pose is converted to a frame of tf. Otherwise frame and pose are
        returned unchanged.

        Args:
            frame: the frame that the pose is in.
            pose: x, y, z, qx, qy, qz, qw.
        """
        placed_frame = self.placed_frame(frame)
        if placed_frame is None or placed_frame.parent is None:
            return frame, np.asarray(pose, dtype=np.float64)
        return placed_frame.parent, compose(invert(placed_frame.pose), pose)

    def set_placed_frame(self, display: str, placed_frame: PlacedFrame | None) -> None:
        """Place the frame of a display, or withdraw it.

        Args:
            display: the display's ID.
            placed_frame: the frame and its pose; None to withdraw the display's frame.
        """
        if placed_frame is None:
            if self._placed_frames.pop(display, None) is None:
                return
        else:
            self._placed_frames[display] = placed_frame
        for listener in self.on_placed_frame:
            listener()

    def clear(self) -> None:
        """Discard all transforms except static ones, because time was reset."""
        self._buffer.clear()

    def _add_transforms(self, message: TFMessage, *, static: bool) -> None:
        self._buffer.update(message, static=static)
        for listener in list(self._listeners):
            run_logged(self._node.get_logger(), "placing messages", listener)

    def _unsubscribe(self) -> None:
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self.__dict__.pop("_buffer", None)
