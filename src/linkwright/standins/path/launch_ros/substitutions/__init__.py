"""Stands in for ``launch_ros.substitutions``."""

from linkwright.launch.ros import ExecutableInPackage, FindPackage, FindPackagePrefix, FindPackageShare
from linkwright.launch.ros import ParameterSubstitution as Parameter

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]
