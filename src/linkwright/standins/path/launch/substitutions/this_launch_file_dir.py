"""Stands in for ``launch.substitutions.this_launch_file_dir``."""

from linkwright.launch.substitutions import ThisLaunchFileDir

__all__ = ["ThisLaunchFileDir"]
