"""Stands in for ``launch_ros.substitutions``."""

from linkwright.launch.ros import ExecutableInPackage, FindPackage, FindPackagePrefix, FindPackageShare
from linkwright.launch.ros import ParameterSubstitution as Parameter
from linkwright.standins.imported_names import submodules_of

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]

__getattr__ = submodules_of(__name__)
