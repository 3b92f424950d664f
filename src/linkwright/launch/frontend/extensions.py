"""What brings tags, substitutions and languages of launch files: our own modules, and those of installed packages.

Packages name theirs in entry points, as for ROS 2's own launch. Ours are entry points too, but are not written into the
metadata of our distribution: where ROS is installed beside it, ROS's launch would load them.
"""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Iterator
from importlib.metadata import EntryPoint, entry_points
from typing import Any

ACTIONS = "launch.frontend.launch_extension"
"""The group of modules that expose actions and substitutions when they are imported."""

PARSERS = "launch.frontend.parser"
"""The group of parsers, each by the name of its language."""

_KINDS = {ACTIONS: "launch extension", PARSERS: "parser extension"}

_OURS = {
    ACTIONS: {
        "actions": "linkwright.launch.model.actions",
        "include": "linkwright.launch.frontend.include",
        "substitutions": "linkwright.launch.model.substitutions",
        "ros": "linkwright.launch.ros",
    },
    PARSERS: {"xml": "linkwright.launch.frontend.xml:Parser", "yaml": "linkwright.launch.frontend.yaml:Parser"},
}


def load(group: str) -> Iterator[tuple[str, Any]]:
    """Name and object of each entry point of a group, ours first; for one that fails there is a warning instead."""
    ours = (EntryPoint(name, value, group) for name, value in _OURS[group].items())
    for entry_point in (*ours, *entry_points(group=group)):
        try:
            loaded = entry_point.load()
        except Exception:  # noqa: BLE001, PERF203 - a broken package must not stop the others
            problem = f"Failed to load the {_KINDS[group]}: {entry_point.name}\n{traceback.format_exc()}"
            warnings.warn(problem, stacklevel=2)
        else:
            yield entry_point.name, loaded
