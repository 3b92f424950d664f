"""Recent transforms, to place messages by the time in their headers."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.graph import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS, Node, run_logged
from linkwright.messages import TFMessage

if TYPE_CHECKING:
    from linkwright.graph.transforms.core import BufferCore

_IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class FrameHistory:
    """A tf2 buffer that subscribes only while a display uses it: robots alone need no history.

    Args:
        node: to subscribe with.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._listeners: list[Callable[[], None]] = []
        self._subscriptions: list[Any] = []

    @cached_property
    def _buffer(self) -> BufferCore:
        from linkwright.graph.transforms.core import BufferCore

        return BufferCore(logger=self._node.get_logger())

    def use(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Begin to listen, and call back whenever transforms came; what is returned ends that."""
        self._listeners.append(listener)
        if not self._subscriptions:
            for topic, static, qos in (("/tf", False, TF_QOS), ("/tf_static", True, STATIC_TF_SUBSCRIPTION_QOS)):
                self._subscriptions.append(
                    self._node.create_subscription(
                        TFMessage, topic, lambda message, static=static: self._take(message, static), qos
                    )
                )

        def release() -> None:
            if listener in self._listeners:
                self._listeners.remove(listener)
            if not self._listeners:
                self._end()

        return release

    def pose(self, fixed_frame: str, frame: str, stamp_ns: int) -> NDArray[np.float64]:
        """The pose of a frame in the Fixed Frame: x, y, z, qx, qy, qz, qw.

        Args:
            fixed_frame: the Fixed Frame.
            frame: the frame, which may be the Fixed Frame though tf does not know it.
            stamp_ns: when, nanoseconds; 0 for the latest.

        Raises:
            TransformException: tf2's reasons why there is none.
        """
        if frame == fixed_frame:
            return _IDENTITY
        found, _ = self._buffer.lookup(fixed_frame, frame, stamp_ns)
        return np.array(found)

    def names(self) -> frozenset[str]:
        """The frames that transforms named."""
        return frozenset(self._buffer.frame_names())

    def forget(self) -> None:
        """Forget all moving transforms: time begins anew."""
        self._buffer.clear()

    def _take(self, message: TFMessage, static: bool) -> None:
        self._buffer.update(message, static=static)
        for listener in list(self._listeners):
            run_logged(self._node.get_logger(), "placing messages", listener)

    def _end(self) -> None:
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self.__dict__.pop("_buffer", None)
