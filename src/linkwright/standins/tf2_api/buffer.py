"""The transform buffer of a node (tf2_ros ``Buffer``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.transforms import waiting as transform_waiting
from linkwright.standins.tf2_api.interface import BufferInterface


class Buffer(transform_waiting.Buffer, BufferInterface):
    """A transform buffer that can wait for transforms and transform messages.

    Args:
        cache_time: the duration for which transforms are stored; None for 10 seconds.
        node: a node that offers the service ``tf2_frames``; the buffer is cleared when the node's clock jumps back.
    """

    def __init__(self, cache_time: Any = None, node: Any = None) -> None:
        transform_waiting.Buffer.__init__(self, cache_time, node)
        BufferInterface.__init__(self)
