"""Stands in for ``rclpy.impl``."""

__all__ = []
