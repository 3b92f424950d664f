"""Stands in for ``launch.events.shutdown``."""

from linkwright.launch.events import Shutdown

__all__ = ["Shutdown"]
