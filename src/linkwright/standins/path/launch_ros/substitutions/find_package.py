"""Stands in for ``launch_ros.substitutions.find_package``."""

from linkwright.launch.ros import FindPackage, FindPackagePrefix, FindPackageShare

__all__ = ["FindPackage", "FindPackagePrefix", "FindPackageShare"]
