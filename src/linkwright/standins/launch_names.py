"""What the packages ``launch`` and ``launch_ros`` have besides what they list, because of how they are built in ROS.

Launch files use it: after ``import launch`` alone they call ``launch.utilities.perform_substitutions``, and editors
that complete imports wrote ``from launch.launch_introspector import ExecuteProcess`` into many.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from importlib.machinery import PathFinder
from typing import Any

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


def submodules_of(package: str) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package: its submodules, imported when somebody asks for one."""

    def submodule(name: str) -> Any:
        if not name.startswith("__") and PathFinder.find_spec(f"{package}.{name}", sys.modules[package].__path__):
            return importlib.import_module(f"{package}.{name}")
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return submodule


def imported_there(name: str) -> Any:
    """The ``__getattr__`` of a module within a package: what the module of ROS imports itself, it offers as well.

    Raises:
        AttributeError: no package of the launch system has such a name.
    """
    if not name.startswith("_"):
        for package in _PACKAGES:
            found = vars(importlib.import_module(package)).get(name)
            if found is not None:
                return found
    raise AttributeError(f"no module of the launch system has a name '{name}'")
