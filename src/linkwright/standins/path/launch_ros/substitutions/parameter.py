"""Stands in for ``launch_ros.substitutions.parameter``."""

from linkwright.launch.ros import ParameterSubstitution as Parameter

__all__ = ["Parameter"]
