"""Stands in for ``rclpy.context``."""

from linkwright.standins.rclpy_api.context import Context

__all__ = ["Context"]
