"""Stands in for what launch files use of ``controller_manager``."""

from controller_manager import launch_utils

__all__ = ["launch_utils"]
