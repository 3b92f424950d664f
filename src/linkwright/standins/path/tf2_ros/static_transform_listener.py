"""Stands in for ``tf2_ros.static_transform_listener``."""

from linkwright.standins.tf2_api.listener import StaticTransformListener

__all__ = ["StaticTransformListener"]
