"""Stands in for ``launch_testing.actions.ready``."""

from linkwright.launch.actions.testing import ReadyToTest

__all__ = ["ReadyToTest"]
