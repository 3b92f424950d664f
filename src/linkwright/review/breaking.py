"""Decide which changes to a description are breaking, by the names that other programs use."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence

from linkwright.descriptions.comparison import ROS2_CONTROL, Difference, find_lost_interfaces
from linkwright.diagnostics import Phrase, joined_first, phrase, quoted
from linkwright.review.changes import MAX_NAMES
from linkwright.review.joint_limits import find_limited_reason
from linkwright.review.names_in_plugins import NAME_TAGS, NAMESPACE_TAG, extract_used_name
from linkwright.urdf import Robot

MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
"""The types of joints with a position in ``/joint_states``."""
_LINEAR = "prismatic"
_MAX_QUOTED = 6
"""The maximum number of names in a reason."""
_CAMERA_NAME = re.compile(r"camera_?name", re.IGNORECASE)
"""The parameter of a camera of gazebo_ros that is the first part of the names of its topics."""
_SENSOR_FRAME = re.compile(r"(?:(?:gz|ignition|optical)_)?frame_id")
"""The tags of the frame of a sensor's messages."""
_INTERFACE = re.compile(r"(?:joint|sensor|gpio) (?P<joint>\S+) (?P<kind>command|state)_interface (?P<name>\S+)")
_PART = re.compile(r"(?:joint|sensor|gpio) (?P<joint>\S+)(?P<name> @name)?")


def find_breaking_reason(difference: Difference, old: Robot, new: Robot) -> Phrase | None:
    """Return why a difference breaks programs that use the robot, or None if it does not.

    Args:
        difference: the difference between both versions.
        old: the robot of the old version.
        new: the robot of the new version.
    """
    if difference.subject == "link":
        return _find_link_reason(difference)
    if difference.subject == "joint":
        return _find_joint_reason(difference, old, new)
    if difference.subject == "extension":
        return find_extension_reason(difference, find_lost_interfaces(old.extensions, new.extensions))
    return None


def _find_link_reason(difference: Difference) -> Phrase | None:
    name = difference.old if difference.kind == "renamed" else difference.name
    return frame_reason(name or "") if difference.kind in ("removed", "renamed") else None


def _find_joint_reason(difference: Difference, old: Robot, new: Robot) -> Phrase | None:
    if difference.kind in ("removed", "renamed"):
        name = (difference.old if difference.kind == "renamed" else difference.name) or ""
        joint = old.joints.get(name)
        if joint is None or joint.type not in MOVING_TYPES:
            return None  # only tf knows fixed joints, by their links
        return joint_name_reason(name)
    if difference.property != "type" or difference.old not in MOVING_TYPES:
        return None
    if difference.new not in MOVING_TYPES:
        return phrase("'{name}' no longer has a position in /joint_states", name=difference.name)
    if (difference.old == _LINEAR) != (difference.new == _LINEAR):
        return phrase("the positions of '{name}' change between rad and m", name=difference.name)
    new_joint = new.joints.get(difference.name)
    return None if new_joint is None else find_limited_reason(difference.old, new_joint)


def transform_reason(name: str) -> Phrase:
    """Return the reason why removing the static transform of a frame is breaking."""
    return phrase("the transform of the frame '{name}' is missing", name=name)


def frame_reason(name: str) -> Phrase:
    """Return the reason why removing a link is breaking."""
    return phrase("programs that look up the frame '{name}' do not find it", name=name)


def frames_reason(names: Sequence[str]) -> Phrase:
    """Return the reason why removing links is breaking."""
    if len(names) == 1:
        return frame_reason(names[0])
    return phrase("programs that look up the frames {names} do not find them", names=_quote(names))


def call_reason(name: str) -> Phrase:
    """Return the reason why removing a call of a macro is breaking."""
    return phrase("programs that use the frames and topics of '{name}' do not find them", name=name)


def message_frame_reason(name: str) -> Phrase:
    """Return the reason why another frame of messages is breaking."""
    return phrase("programs that look for the frame '{name}' in the messages do not find it", name=name)


def name_reason(name: str) -> Phrase:
    """Return the reason why removing a topic, service or other name is breaking."""
    return phrase("programs that use the name '{name}' do not find it", name=name)


def names_reason(names: Sequence[str]) -> Phrase:
    """Return the reason why removing some topics, services or other names is breaking."""
    if len(names) == 1:
        return name_reason(names[0])
    return phrase("programs that use the names {names} do not find them", names=quote_first(names))


def _quote(names: Iterable[str]) -> Phrase:
    """Return names, each in quotation marks, as many as a sentence lists."""
    return joined_first(map(quoted, names), MAX_NAMES)


def quote_first(names: Iterable[str]) -> Phrase:
    """Return the first names, each in quotation marks, and the number of the others, which the change lists."""
    return joined_first(map(quoted, names), _MAX_QUOTED)


def possible_name_reason(name: str) -> Phrase:
    """Return the reason why removing a name may be breaking if the node offers it."""
    return phrase("if the node publishes or serves '{name}', programs that use it do not find it", name=name)


def possible_names_reason(names: Sequence[str]) -> Phrase:
    """Return the reason why removing some names may be breaking if the node offers them."""
    if len(names) == 1:
        return possible_name_reason(names[0])
    return phrase(
        "if the node publishes or serves {names}, programs that use the names do not find them",
        names=quote_first(names),
    )


def joint_name_reason(name: str) -> Phrase:
    """Return the reason why removing a moving joint is breaking."""
    return phrase("controllers and programs that name the joint '{name}' do not find it", name=name)


def find_extension_reason(difference: Difference, lost: Collection[tuple[str, str]] | None = None) -> Phrase | None:
    """Return why a difference in an extension element is breaking, or None if it is not.

    Args:
        difference: the difference between both versions.
        lost: the ros2_control interfaces that the new robot no longer offers; see `find_lost_interfaces`. None if
            the robots are unknown.
    """
    if difference.name.startswith(ROS2_CONTROL):
        return _find_hardware_reason(difference, lost)
    return find_plugin_name_reason(difference) if difference.kind == "changed" and difference.old is not None else None


def _find_hardware_reason(difference: Difference, lost: Collection[tuple[str, str]] | None) -> Phrase | None:
    if difference.kind == "removed":
        reason = phrase("controllers of this hardware do not find its interfaces")
        return reason if lost is None or lost else None
    if difference.kind != "changed" or not difference.old:
        return None
    interface = _INTERFACE.fullmatch(difference.property)
    if interface is not None and difference.new is None:
        joint, name = interface["joint"], interface["name"]
        key = joint, f"state {name}" if interface["kind"] == "state" else name
        reason = phrase("controllers that claim '{joint}/{name}' do not start", joint=joint, name=name)
        return reason if lost is None or key in lost else None
    part = _PART.fullmatch(difference.property)
    is_renamed = part is not None and part["name"] is not None
    if part is None or (difference.new is not None and not is_renamed):
        return find_plugin_name_reason(difference)
    joint = difference.old if is_renamed else part["joint"]
    if lost is not None and not any(lost_joint == joint for lost_joint, _ in lost):
        return None
    return phrase("controllers that claim interfaces of '{joint}' do not start", joint=joint)


def find_plugin_name_reason(difference: Difference) -> Phrase | None:
    """Return why a changed plugin parameter is breaking, or None if it is not.

    A parameter is breaking if it names a topic, service or frame.
    """
    last_word = difference.property.split(" ")[-1]
    tag = difference.property.split(" ")[-2] if last_word.startswith("@") and " " in difference.property else last_word
    is_same_name = difference.new is not None and extract_used_name(difference.old or "") == extract_used_name(
        difference.new
    )
    if NAMESPACE_TAG.search(tag) and (difference.old or difference.property.endswith("ros namespace")):
        return None if is_same_name else namespace_reason(extract_used_name(difference.old or ""))
    if difference.old and _CAMERA_NAME.fullmatch(tag) and not is_same_name:
        return namespace_reason(difference.old)
    if difference.old and NAME_TAGS.search(tag) and not is_same_name and not _is_refused(difference):
        name = extract_used_name(difference.old)
        return message_frame_reason(name) if _SENSOR_FRAME.fullmatch(tag) else name_reason(name)
    return None


def _is_refused(difference: Difference) -> bool:
    """Return whether ROS 2 refuses the old name in the ``<ros>`` of a plugin, because it has an empty part."""
    return "ros remapping" in difference.property and "//" in (difference.old or "")


def namespace_reason(name: str) -> Phrase:
    """Return the reason why another namespace of a plugin is breaking."""
    return phrase(
        "programs do not find the topics and services of the plugin in the namespace '{name}'", name=name or "/"
    )


def world_reason(name: str) -> Phrase:
    """Return the reason why removing or renaming a world is breaking."""
    return phrase("programs that use the topics and services of the world '{name}' do not find them", name=name)
