"""Stands in for ``tf2_ros.static_transform_broadcaster``."""

from linkwright.graph.transforms.broadcaster import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
