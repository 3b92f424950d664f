"""Stands in for ``launch_testing.actions``."""

from linkwright.launch.actions.testing import ReadyToTest

__all__ = ["ReadyToTest"]
