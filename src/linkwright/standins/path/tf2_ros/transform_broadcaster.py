"""Stands in for ``tf2_ros.transform_broadcaster``."""

from linkwright.graph.transforms.broadcaster import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
