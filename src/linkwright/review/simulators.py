"""Find hardware of ros2_control that another simulator loads than before, and controller managers that none loads."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import ROS2_CONTROL, Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.plugins import find_plugins, is_removed
from linkwright.review.renames.replaced_plugins import PluginReplacement
from linkwright.review.texts.comments import without_comments
from linkwright.review.unprefixed_calls import DESCRIPTION_SUFFIXES
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
_CLASSIC_MANAGER = re.compile(r"gazebo_ros2?_control")
_NEW_MANAGER = re.compile(r"(?:gz|ign)_ros2_control")
_FILE_PROPERTY = re.compile(r"plugin \S+ @filename")
_LOADED = re.compile(r"\b(?:load_controller|spawner|controller_spawner)\b")
"""A command that loads controllers into a controller manager."""
_SIMULATION = re.compile(r"gazebo|\bgz|ign_gazebo|[_-]sim\b|simulation", re.IGNORECASE)
_HARDWARE = re.compile(r"\w+/\w+(?:::\w+)*|\w+(?:::\w+)+")
_SIMULATED = re.compile(
    r"sim|mock|fake|dummy|virtual|test|loopback|topic_?based|mujoco|webots|isaac|unity|gazebo|gz|ign", re.IGNORECASE
)
"""The name of hardware that may not be that of a real robot."""


def find_simulator_reason(difference: Difference, versions: Versions, path: str | None) -> Phrase | None:
    """Return why hardware for another simulator, or a simulation instead of hardware, is breaking; None if it is not.

    A description that still has the old hardware, behind a condition, can be used with both. So can one that includes
    another changed file with it.

    Args:
        difference: the difference between both versions.
        versions: both versions.
        path: the path of the description that has the new value; None if it is unknown.
    """
    if not difference.name.startswith(ROS2_CONTROL) or difference.property != _PROPERTY or path is None:
        return _find_other_manager_reason(difference, versions, path)
    old, new = (text or "" for text in (difference.old, difference.new))
    old_simulator, new_simulator = (_SIMULATORS.get(text.partition("/")[0]) for text in (old, new))
    if old_simulator == new_simulator or _is_kept(versions, path, old):
        return None
    if old_simulator is None:
        is_real = _HARDWARE.fullmatch(old) is not None and _SIMULATED.search(old) is None
        return phrase("a simulation is used instead of the hardware of the robot") if is_real else None
    if new_simulator is None:
        is_real = _HARDWARE.fullmatch(new) is not None and _SIMULATED.search(new) is None
        return phrase("the hardware of the robot is used instead of a simulation") if is_real else None
    return phrase("simulations that start the robot in {simulator} find no controllers", simulator=old_simulator)


def _find_other_manager_reason(difference: Difference, versions: Versions, path: str | None) -> Phrase | None:
    """Return why a plugin with the controller manager of another simulator is breaking, or None if it is not."""
    if path is None or difference.kind != "changed":
        return None
    files = [difference.old or "", difference.new or ""]
    if isinstance(difference, PluginReplacement):
        plugins = (difference.old_plugin, difference.new_plugin)
        files = ["" if plugin is None else plugin.attributes.get("filename", "") for plugin in plugins]
    elif _FILE_PROPERTY.fullmatch(difference.property) is None:
        return None
    if _CLASSIC_MANAGER.search(files[0]) is None or _NEW_MANAGER.search(files[1]) is None:
        return None
    if _is_kept(versions, path, files[0]):
        return None
    return phrase("simulations that start the robot in {simulator} find no controllers", simulator=_CLASSIC)


def _is_kept(versions: Versions, path: str, text: str) -> bool:
    """Return whether a description, or another changed one, still has a text outside of comments."""
    paths = {path, *(file.new_path for file in versions.changed_files if file.new_path is not None)}
    descriptions = (other for other in paths if other.endswith(DESCRIPTION_SUFFIXES))
    return any(text in without_comments(versions.new.text(other), other) for other in descriptions)


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
        if _LOADED.search(text) and _SIMULATION.search(text):
            return phrase("no controller manager runs in the simulation, where '{file}' loads controllers", file=path)
    return phrase("no controller manager runs in the simulation")


def _runs_manager(elements: Iterable[Element]) -> bool:
    """Return whether a plugin in some elements runs the controller manager."""
    plugins = [plugin for element in elements for plugin in find_plugins(element)]
    return any(_MANAGER.search(PurePosixPath(plugin.attributes.get("filename", "")).name) for plugin in plugins)


def _names_manager(version: Version, path: str | None) -> bool:
    """Return whether a file names such a plugin. False if there is no file."""
    return path is not None and _MANAGER.search(without_comments(version.text(path), path)) is not None
