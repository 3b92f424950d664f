"""Stands in for ``launch_ros.substitutions.executable_in_package``."""

from linkwright.launch.ros import ExecutableInPackage
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ExecutableInPackage"]
