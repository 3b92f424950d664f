"""Stands in for ``rclpy.waitable``, as far as it goes without the wait sets of the C libraries."""

from linkwright.standins.rclpy_api.waitable import NumberOfEntities

__all__ = ["NumberOfEntities"]
