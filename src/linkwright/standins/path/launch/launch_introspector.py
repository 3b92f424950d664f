"""Stands in for ``launch.launch_introspector``."""

from linkwright.launch.introspector import LaunchIntrospector
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchIntrospector"]
