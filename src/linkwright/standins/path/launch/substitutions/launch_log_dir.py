"""Stands in for ``launch.substitutions.launch_log_dir``."""

from linkwright.launch.substitutions import LaunchLogDir
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchLogDir"]
