"""The rules for breaking changes of a description: names that other programs use."""

from __future__ import annotations

import re

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.names_in_plugins import NAME_TAGS, path_of_renamed, used_name
from linkwright.urdf import Robot

_MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
"""The types of joints with a position in ``/joint_states``."""
_INTERFACE = re.compile(r"joint (?P<joint>\S+) (?P<kind>command|state)_interface (?P<name>\S+)")


def breaking_reason(difference: Difference, old: Robot) -> Phrase | None:
    """Return why a difference breaks programs that use the robot, or None if it does not.

    Args:
        difference: the difference.
        old: the old robot.
    """
    if difference.subject == "link":
        return _link_reason(difference)
    if difference.subject == "joint":
        return _joint_reason(difference, old)
    if difference.subject == "extension":
        return _extension_reason(difference)
    return None


def _link_reason(difference: Difference) -> Phrase | None:
    name = difference.old if difference.kind == "renamed" else difference.name
    if difference.kind in ("removed", "renamed"):
        return phrase("programs that look up the frame '{name}' do not find it", name=name or "")
    return None


def _joint_reason(difference: Difference, old: Robot) -> Phrase | None:
    if difference.kind in ("removed", "renamed"):
        name = (difference.old if difference.kind == "renamed" else difference.name) or ""
        joint = old.joints.get(name)
        if joint is None or joint.type not in _MOVING_TYPES:
            return None  # only tf knows fixed joints, by their links
        return phrase("controllers and programs that name the joint '{name}' do not find it", name=name)
    if difference.property == "type" and difference.old in _MOVING_TYPES and difference.new not in _MOVING_TYPES:
        return phrase("'{name}' has no position in /joint_states any more", name=difference.name)
    return None


def _extension_reason(difference: Difference) -> Phrase | None:
    if difference.kind == "removed" and difference.name.startswith("ros2_control"):
        return phrase("controllers of this hardware do not find its interfaces")
    if difference.kind != "changed" or not difference.old:
        return None
    interface = _INTERFACE.fullmatch(difference.property)
    if interface is not None and difference.new is None:
        return phrase(
            "controllers that claim '{joint}/{name}' do not start", joint=interface["joint"], name=interface["name"]
        )
    renamed = path_of_renamed(difference, difference.property)
    if renamed is not None and difference.name.startswith("ros2_control"):
        return phrase("controllers that claim an interface of '{name}' do not start", name=difference.old)
    return plugin_name_reason(difference)


def plugin_name_reason(difference: Difference) -> Phrase | None:
    """Return why a changed parameter of a plugin is breaking: it names topics, services or frames that others use."""
    last_word = difference.property.split(" ")[-1]
    tag = difference.property.split(" ")[-2] if last_word.startswith("@") and " " in difference.property else last_word
    is_same = difference.new is not None and used_name(difference.old or "") == used_name(difference.new)
    if difference.old and NAME_TAGS.search(tag) and not is_same:
        return phrase("programs that use the name '{name}' do not find it", name=used_name(difference.old))
    return None
