"""Stands in for ``launch.utilities.create_future_impl``."""

from linkwright.launch.class_checks import create_future

__all__ = ["create_future"]
