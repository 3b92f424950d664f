"""Stands in for ``launch_testing.markers``."""

from linkwright.launch.actions.testing import keep_alive

__all__ = ["keep_alive"]
