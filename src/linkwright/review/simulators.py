"""Find hardware of ros2_control that another simulator loads than before, and controller managers that none loads."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import ROS2_CONTROL, Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.comments import without_comments
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.plugins import find_plugins, is_removed
from linkwright.review.versions import Version, Versions
from linkwright.xmltree import Element

_CLASSIC, _NEW = "Gazebo Classic", "Gazebo"
_SIMULATORS = {
    "gazebo_ros2_control": _CLASSIC,
    "ign_ros2_control": _NEW,
    "gz_ros2_control": _NEW,
}
"""The simulators that load the hardware plugins of a package."""
_PROPERTY = "hardware plugin"
_MANAGER = re.compile(r"(?:gazebo_ros2?|gz_ros2|ign_ros2)_control(?!/)")
"""The file of a plugin of a simulator that runs the controller manager. A slash follows in names of hardware."""
_LOADED = re.compile(r"\b(?:load_controller|spawner|controller_spawner)\b")
"""A command that loads controllers into a controller manager."""
_SIMULATED = re.compile(r"gazebo|\bgz|ign_gazebo|[_-]sim\b|simulation", re.IGNORECASE)


def find_simulator_reason(difference: Difference, version: Version, path: str | None) -> Phrase | None:
    """Return the reason why hardware for another simulator is breaking, or None if it is not.

    A description that still has the old hardware, behind a condition, can be used with both simulators.

    Args:
        difference: the difference between both versions.
        version: the new version.
        path: the path of the description that has the new value; None if it is unknown.
    """
    if not difference.name.startswith(ROS2_CONTROL) or difference.property != _PROPERTY or path is None:
        return None
    old, new = (text or "" for text in (difference.old, difference.new))
    old_simulator, new_simulator = (_SIMULATORS.get(text.partition("/")[0]) for text in (old, new))
    if None in (old_simulator, new_simulator) or old_simulator == new_simulator or old in version.text(path):
        return None
    return phrase("simulations that start the robot in {simulator} find no controllers", simulator=old_simulator or "")


def find_lost_manager_reason(difference: Difference, new: Iterable[Element], versions: Versions) -> Phrase | None:
    """Return the reason why a removed plugin that ran the controller manager is breaking, or None if it is not.

    It is not breaking if the new robot has such a plugin, or if a changed file newly has one.

    Args:
        difference: the difference between both versions.
        new: the elements of the new version.
        versions: both versions.
    """
    element = difference.element
    if element is None or not is_removed(difference) or not _runs_manager([element]) or _runs_manager(new):
        return None
    if any(
        _names_manager(versions.new, file.new_path) and not _names_manager(versions.old, file.old_path)
        for file in versions.changed_files
    ):
        return None
    place = difference.old_place
    folder = None if place is None else versions.old.package_of(versions.old.relative(place.span.file) or "")
    for path in versions.new.paths(("",), folder) if folder is not None else ():
        text = without_comments(versions.new.text(path), path) if is_launch_file(path) else ""
        if _LOADED.search(text) and _SIMULATED.search(text):
            return phrase("no controller manager runs in the simulation, where '{file}' loads controllers", file=path)
    return phrase("no controller manager runs in the simulation")


def _runs_manager(elements: Iterable[Element]) -> bool:
    """Return whether a plugin in some elements runs the controller manager."""
    plugins = [plugin for element in elements for plugin in find_plugins(element)]
    return any(_MANAGER.search(PurePosixPath(plugin.attributes.get("filename", "")).name) for plugin in plugins)


def _names_manager(version: Version, path: str | None) -> bool:
    """Return whether a file names such a plugin. False if there is no file."""
    return path is not None and _MANAGER.search(without_comments(version.text(path), path)) is not None
