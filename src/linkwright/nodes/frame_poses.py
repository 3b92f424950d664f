"""Lookup of frame poses for nodes that transform messages."""

from __future__ import annotations

from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph import Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener

_WARNING_PERIOD_S = 5.0


class FramePoses:
    """A lookup of frame poses in the transforms that a node receives.

    Args:
        node: the node that subscribes to ``/tf`` and ``/tf_static``.
        warning_prefix: the beginning of the warning about a missing transform.

    Attributes:
        buffer: the transform buffer.
    """

    def __init__(self, node: Node, warning_prefix: str) -> None:
        self._node = node
        self._warning_prefix = warning_prefix
        self.buffer = BufferCore(logger=node.get_logger().get_child("tf2"))
        TransformListener(self.buffer, node)

    def pose(self, target: str, source: str, time_ns: int) -> Transform | None:
        """Return the pose of the frame `source` in the frame `target` at a time, or None.

        The lookup does not wait. If there is no transform for the time, the latest transform is used. If there is no
        transform at all, a throttled warning is logged.
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
            self._node.get_logger().warning(f"{self._warning_prefix} {error}", throttle_duration_sec=_WARNING_PERIOD_S)
            return None
