"""Stands in for ``launch_ros.substitutions.find_package``."""

from linkwright.launch.ros import FindPackage, FindPackagePrefix, FindPackageShare
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FindPackage", "FindPackagePrefix", "FindPackageShare"]
