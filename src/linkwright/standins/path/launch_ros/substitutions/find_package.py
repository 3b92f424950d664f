"""Stands in for ``launch_ros.substitutions.find_package``."""

from linkwright.launch.ros import FindPackagePrefix, FindPackageShare
from linkwright.launch.ros import FindPackagePrefix as FindPackage

__all__ = ["FindPackage", "FindPackagePrefix", "FindPackageShare"]
