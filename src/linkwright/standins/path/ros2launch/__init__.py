"""Stands in for ``ros2launch``."""

from ros2launch import api

__all__ = ["api"]
