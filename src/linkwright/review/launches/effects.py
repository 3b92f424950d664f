"""The rules for breaking changes of launch files: names of nodes, topics and arguments that others use."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import name_reason
from linkwright.review.launches.outlines import NAMESPACE, NAMESPACE_OF_INCLUDED, REMAPPING, Entry, LaunchOutline
from linkwright.review.launches.titles import TRANSFORM_PUBLISHERS, served_names
from linkwright.review.list_changes import list_items

_USER_INTERFACE = re.compile(r"rviz2?/|rqt|joint_state_publisher_gui/|plotjuggler/")
"""Programs that offer nothing to other programs."""
_SPAWNING = re.compile(
    r"(ros_gz_sim|ros_ign_gazebo)/(create|remove)|(gazebo_ros|gazebo)/(spawn_entity\.py|spawn_model)|webots_ros2\w*/.*spawn.*"
)
"""Programs that tell another program once to create a robot, and offer nothing themselves."""
_NAME = re.compile(r"[~/\w]+")
_NAMES_OF_NODES = ("name", "exec_name", NAMESPACE, NAMESPACE_OF_INCLUDED, "remappings")
_NEVER = re.compile(r"[^\s/]* \((if (false|0)|unless (true|1))\)", re.IGNORECASE)
"""A namespace that is pushed with a condition that does not hold."""


def removal_reason(entry: Entry, outline: LaunchOutline) -> Phrase | None:
    """Return why it is breaking that an action is removed, or None if it is not.

    Args:
        entry: the action.
        outline: the file that contains it.
    """
    if entry.kind == "argument" and "value" not in entry.settings:
        return phrase("a value that a caller passes for '{name}' has no effect", name=entry.name)
    if entry.kind == "remapping":
        return _remapping_reason(entry.name, entry.settings.get("to"), None, outline, outline)
    if entry.kind != "node" or offers_nothing(entry):
        return None
    names = served_names(entry)
    if entry.name.startswith(TRANSFORM_PUBLISHERS):
        if not names:
            return phrase("programs that look up the frame of the node do not find it")
        return phrase("programs that look up the frame '{name}' do not find it", name=names[0])
    if names:
        return phrase("the topics and services of {controllers} are missing", controllers=", ".join(names))
    return phrase("the topics and services of the node are missing")


def offers_nothing(entry: Entry) -> bool:
    """Return whether other programs do not use the node."""
    return _USER_INTERFACE.match(entry.name) is not None or _SPAWNING.fullmatch(entry.name) is not None


def setting_reason(
    entry: Entry, setting: str, old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return why a changed setting of an action is breaking, or None if it is not.

    Args:
        entry: the new action.
        setting: the name of the setting.
        old: its old value; None if there was none.
        new: its new value; None if there is none.
        old_outline: the old file.
        new_outline: the new file.
    """
    if entry.kind == "argument":
        return _argument_reason(entry, setting, old, new)
    if entry.kind == "remapping" and setting == "to":
        return _remapping_reason(entry.name, old, new, old_outline, new_outline)
    if entry.kind not in ("node", "include") or offers_nothing(entry):
        return None
    if entry.kind == "node" and setting.startswith(REMAPPING):
        source = setting.removeprefix(REMAPPING)
        if _are_remapped_elsewhere(f"{source} {old or ''}", new_outline):
            return None
        return _remapping_reason(source, old, new, old_outline, new_outline)
    names = (NAMESPACE_OF_INCLUDED,) if entry.kind == "include" else _NAMES_OF_NODES
    if setting not in names or _resolved_name(old, old_outline) == _resolved_name(new, new_outline):
        return None
    return phrase("programs that use the names of the node, its topics or its services do not find them")


def _argument_reason(entry: Entry, setting: str, old: str | None, new: str | None) -> Phrase | None:
    if setting == "default" and new is None and "value" not in entry.settings:
        return phrase("callers must pass '{name}'", name=entry.name)
    if setting == "choices" and old is not None and new is not None:
        gone = [item for item in list_items(old) if item not in list_items(new)]
        if gone:
            return phrase("callers that pass '{value}' fail", value=", ".join(gone))
    return None


def _resolved_name(text: str | None, outline: LaunchOutline) -> str:
    """Return a name with the defaults of arguments; empty for a name that is not given."""
    resolved = outline.resolved(text or "").strip("/")
    return _NEVER.sub("", resolved).strip("/")


def _remapping_reason(
    source: str, old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return why it is breaking that a name is remapped otherwise, or None if the name is the same."""
    old_name = old_outline.resolved(source if old is None else old)
    new_name = new_outline.resolved(source if new is None else new)
    if old_name.lstrip("/") == new_name.lstrip("/"):  # the same name in the empty namespace
        return None
    return name_reason(old_name)


def _are_remapped_elsewhere(names: str, outline: LaunchOutline) -> bool:
    """Return whether the arguments of nodes contain the names, as a spawner's ``--controller-ros-args`` can."""
    words = set(_NAME.findall(names))
    arguments = " ".join(entry.settings.get("arguments", "") for entry in outline.entries)
    return bool(words) and words <= set(_NAME.findall(arguments))
