"""Stands in for ``launch.logging``."""

from linkwright.launch.engine.user_logging import get_logger

__all__ = ["get_logger"]
