"""Looks up the poses of frames for nodes that transform messages."""

from __future__ import annotations

from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph import Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener

_SECONDS_BETWEEN_COMPLAINTS = 5.0


class FramePoses:
    """The transforms that a node has received.

    Args:
        node: the node that subscribes to ``/tf`` and ``/tf_static``.
        complaint: the beginning of the warning about a missing transform.

    Attributes:
        buffer: the transform buffer.
    """

    def __init__(self, node: Node, complaint: str) -> None:
        self._node = node
        self._complaint = complaint
        self.buffer = BufferCore(logger=node.get_logger().get_child("tf2"))
        TransformListener(self.buffer, node)

    def pose(self, target: str, source: str, time_ns: int) -> Transform | None:
        """Return the pose of the frame `source` in the frame `target` at a time, or the latest pose.

        The lookup does not wait. If the transform for the time has not arrived yet, the latest transform is used.
        Without any transform, a throttled warning is logged and the result is None.
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
