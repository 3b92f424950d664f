"""Stands in for ``launch_ros``, the ROS 2 part of the launch system."""

from launch_ros import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
