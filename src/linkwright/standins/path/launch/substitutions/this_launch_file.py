"""Stands in for ``launch.substitutions.this_launch_file``."""

from linkwright.launch.substitutions import ThisLaunchFile
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ThisLaunchFile"]
