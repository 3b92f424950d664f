"""Stands in for ``launch.event_handlers.on_include_launch_description``."""

from linkwright.launch.event_handlers import OnIncludeLaunchDescription
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnIncludeLaunchDescription"]
