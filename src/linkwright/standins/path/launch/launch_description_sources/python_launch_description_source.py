"""Stands in for ``launch.launch_description_sources.python_launch_description_source``."""

from linkwright.launch.sources import PythonLaunchDescriptionSource
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PythonLaunchDescriptionSource"]
