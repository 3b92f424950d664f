"""Stands in for ``launch_testing`` as far as launching the launch files of tests needs it."""

from launch_testing import actions, markers, util

__all__ = ["actions", "markers", "util"]
