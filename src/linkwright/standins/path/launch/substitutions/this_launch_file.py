"""Stands in for ``launch.substitutions.this_launch_file``."""

from linkwright.launch.substitutions import ThisLaunchFile

__all__ = ["ThisLaunchFile"]
