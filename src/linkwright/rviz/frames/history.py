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
class OwnFrame:
    """A frame that a display places and that tf does not know.

    Attributes:
        name: the name of the frame.
        parent: a tf frame; None while no tf frame is connected to this frame.
        pose: the pose of `parent` in this frame: x, y, z, qx, qy, qz, qw.
    """

    name: str
    parent: str | None = None
    pose: NDArray[np.float64] = field(default_factory=_IDENTITY.copy)


class FrameHistory:
    """A tf2 buffer that subscribes only while it is used; robots alone are shown without it.

    Displays may place frames that tf does not know, which can then be the Fixed Frame. Only this viewer sees these
    frames.

    Args:
        node: the node that subscribes.

    Attributes:
        on_own: callbacks for a frame that a display has placed, moved or withdrawn.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._listeners: list[Callable[[], None]] = []
        self._subscriptions: list[Any] = []
        self._own: dict[str, OwnFrame] = {}
        self.on_own: list[Callable[[], None]] = []

    @cached_property
    def _buffer(self) -> BufferCore:
        from linkwright.graph.transforms.core import BufferCore

        return BufferCore(logger=self._node.get_logger())

    def use(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Subscribe, and call the listener whenever transforms arrive.

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
                self._end()

        return release

    def pose(self, fixed_frame: str, frame: str, stamp_ns: int) -> NDArray[np.float64]:
        """Return the pose of a frame in the Fixed Frame: x, y, z, qx, qy, qz, qw.

        Args:
            fixed_frame: the Fixed Frame.
            frame: the frame, which may be the Fixed Frame even if tf does not know it.
            stamp_ns: the time, nanoseconds; 0 for the latest.

        Raises:
            TransformException: the pose is not known; the message is tf2's.
        """
        if frame == fixed_frame:
            return _IDENTITY
        own = self.own(fixed_frame)
        if own is not None and own.parent is not None:
            return compose(own.pose, self.pose(own.parent, frame, stamp_ns))
        found, _ = self._buffer.lookup(fixed_frame, frame, stamp_ns)
        return np.array(found)

    def names(self) -> frozenset[str]:
        """Return the names of all frames in the transforms received so far."""
        return frozenset(self._buffer.frame_names())

    def own(self, name: str) -> OwnFrame | None:
        """Return the frame that a display has placed under a name, or None if there is none or tf knows it."""
        found = next((own for own in self._own.values() if own.name == name), None)
        return None if found is None or name in self._buffer.frame_names() else found

    def known(self, frame: str, pose: ArrayLike) -> tuple[str, NDArray[np.float64]]:
        """Return a frame and a pose that other programs understand, for a pose in any frame.

        If a display has placed the frame, the pose is converted to a frame of tf. Otherwise both are returned
        unchanged.

        Args:
            frame: the frame that the pose is in.
            pose: x, y, z, qx, qy, qz, qw.
        """
        own = self.own(frame)
        if own is None or own.parent is None:
            return frame, np.asarray(pose, dtype=np.float64)
        return own.parent, compose(invert(own.pose), pose)

    def place(self, display: str, own: OwnFrame | None) -> None:
        """Place the frame of a display, or withdraw it.

        Args:
            display: the display's ID.
            own: the frame and its pose; None to withdraw the display's frame.
        """
        if own is None:
            if self._own.pop(display, None) is None:
                return
        else:
            self._own[display] = own
        for listener in self.on_own:
            listener()

    def forget(self) -> None:
        """Discard all transforms except static ones, because time was reset."""
        self._buffer.clear()

    def _add_transforms(self, message: TFMessage, *, static: bool) -> None:
        self._buffer.update(message, static=static)
        for listener in list(self._listeners):
            run_logged(self._node.get_logger(), "placing messages", listener)

    def _end(self) -> None:
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self.__dict__.pop("_buffer", None)
