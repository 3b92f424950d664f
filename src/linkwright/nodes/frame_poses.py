"""Looking up poses of frames, for nodes that transform messages."""

from __future__ import annotations

from linkwright.geometry.single import IDENTITY, Transform
from linkwright.graph import Node, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener

_SECONDS_BETWEEN_COMPLAINTS = 5.0


class FramePoses:
    """The transforms that a node receives.

    Args:
        node: listens to ``/tf`` and ``/tf_static``.
        complaint: what its warning begins with where a transform cannot be had.

    Attributes:
        buffer: the transforms.
    """

    def __init__(self, node: Node, complaint: str) -> None:
        self._node = node
        self._complaint = complaint
        self.buffer = BufferCore(logger=node.get_logger().get_child("tf2"))
        TransformListener(self.buffer, node)

    def pose(self, target: str, source: str, time_ns: int) -> Transform | None:
        """The pose of a frame in another one at a time, or the latest known.

        It never waits: a transform that is a little late is used as it was before. Where there is none at all, that is
        logged now and then, and the result is None.
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
