"""Stands in for ``launch_ros.substitutions``."""

from linkwright.launch.ros import ExecutableInPackage, FindPackagePrefix, FindPackageShare
from linkwright.launch.ros import FindPackagePrefix as FindPackage

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]
