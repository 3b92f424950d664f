"""Stands in for ``launch.launch_introspector``."""

from linkwright.launch.introspector import LaunchIntrospector

__all__ = ["LaunchIntrospector"]
