"""What the packages ``launch`` and ``launch_ros`` have besides what they list, because of how they are built in ROS.

Launch files use it: after ``import launch`` alone they call ``launch.utilities.perform_substitutions``, and editors
that complete imports wrote ``from launch.launch_introspector import ExecuteProcess`` into many.
"""

from __future__ import annotations

from linkwright.standins.imported_names import imported_from

_PACKAGES = (
    "launch",
    "launch.actions",
    "launch.substitutions",
    "launch.conditions",
    "launch.event_handlers",
    "launch.events",
    "launch.events.process",
    "launch.descriptions",
    "launch.launch_description_sources",
    "launch.frontend",
    "launch.utilities",
    "launch_ros.actions",
    "launch_ros.descriptions",
    "launch_ros.substitutions",
    "launch_ros.parameter_descriptions",
    "launch_ros.utilities",
)
"""Where names are looked for, in this order."""

imported_there = imported_from(_PACKAGES, "the launch system")
"""The ``__getattr__`` of a module within a package: what the module of ROS imports itself, it offers as well."""
