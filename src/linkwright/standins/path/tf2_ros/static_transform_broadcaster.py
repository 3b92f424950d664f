"""Stands in for ``tf2_ros.static_transform_broadcaster``."""

from linkwright.graph.transform_broadcaster import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
