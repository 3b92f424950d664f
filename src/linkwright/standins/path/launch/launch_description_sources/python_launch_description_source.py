"""Stands in for ``launch.launch_description_sources.python_launch_description_source``."""

from linkwright.launch.sources import PythonLaunchDescriptionSource

__all__ = ["PythonLaunchDescriptionSource"]
