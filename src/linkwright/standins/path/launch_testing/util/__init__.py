"""Stands in for ``launch_testing.util``."""

from linkwright.launch.actions.testing import KeepAliveProc

__all__ = ["KeepAliveProc"]
