"""Stands in for ``launch_ros.substitutions.executable_in_package``."""

from linkwright.launch.ros import ExecutableInPackage

__all__ = ["ExecutableInPackage"]
