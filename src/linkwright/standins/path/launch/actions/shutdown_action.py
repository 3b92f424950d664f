"""Stands in for ``launch.actions.shutdown_action``."""

from linkwright.launch.actions import Shutdown

__all__ = ["Shutdown"]
