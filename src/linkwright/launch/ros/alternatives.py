"""Replacements for programs of packages that Linkwright does not replace."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase

_MAPPING = phrase("slam_toolbox also makes maps: run `linkwright launch slam_toolbox online_async_launch.py`")
_ALTERNATIVES = {
    "cartographer_ros": _MAPPING,
    "slam_gmapping": _MAPPING,
    "moveit_setup_assistant": phrase("`linkwright arm init` writes the MoveIt configuration of an arm"),
}


def find_alternative(package: str) -> Phrase | None:
    """Return what to use instead of the programs of a package, or None if there is nothing."""
    return _ALTERNATIVES.get(package)
