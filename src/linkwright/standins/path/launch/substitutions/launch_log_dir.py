"""Stands in for ``launch.substitutions.launch_log_dir``."""

from linkwright.launch.substitutions import LaunchLogDir

__all__ = ["LaunchLogDir"]
