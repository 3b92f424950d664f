"""Stands in for ``launch.substitutions.this_launch_file_dir``."""

from linkwright.launch.substitutions import ThisLaunchFileDir
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ThisLaunchFileDir"]
