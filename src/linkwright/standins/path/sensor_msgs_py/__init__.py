"""Stands in for ``sensor_msgs_py``."""

__all__ = []
