"""Stands in for ``tf2_ros.transform_broadcaster``."""

from linkwright.graph.transform_broadcaster import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
