"""Lookup of frame poses, for nodes that transform messages."""

from __future__ import annotations

from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph import Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener

_SECONDS_BETWEEN_COMPLAINTS = 5.0


class FramePoses:
    """The transforms that a node receives.

    Args:
        node: the node that subscribes to ``/tf`` and ``/tf_static``.
        complaint: the start of the warning about a missing transform.

    Attributes:
        buffer: the transforms.
    """

    def __init__(self, node: Node, complaint: str) -> None:
        self._node = node
        self._complaint = complaint
        self.buffer = BufferCore(logger=node.get_logger().get_child("tf2"))
        TransformListener(self.buffer, node)

    def pose(self, target: str, source: str, time_ns: int) -> Transform | None:
        """Return the pose of a frame in another one at a time, or the latest known.

        It never waits: if a transform is a little late, the previous one is used. If there is no transform at all, it
        logs a throttled warning and returns None.
        """
        if target == source:
            return IDENTITY
        try:
            return self.buffer.lookup(target, source, time_ns)[0]
        except TransformException:
            pass
        try:
            return self.buffer.lookup(target, source, 0)[0]
        except TransformException as error:
            self._node.get_logger().warning(
                f"{self._complaint} {error}", throttle_duration_sec=_SECONDS_BETWEEN_COMPLAINTS
            )
            return None
