"""Stands in for ``launch.launch_description_sources``."""

from linkwright.launch.sources import AnyLaunchDescriptionSource, PythonLaunchDescriptionSource

__all__ = ["AnyLaunchDescriptionSource", "PythonLaunchDescriptionSource"]
