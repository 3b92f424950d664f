"""Stands in for ``rclpy.handle``."""

from linkwright.graph.faults import InvalidHandleError as InvalidHandle

__all__ = ["InvalidHandle"]
