"""Read calls of macros without the prefix ``xacro:``, which xacro of ROS 1 expanded until ROS Melodic.

Source: ``handle_macro_call`` and ``eval_all`` of xacro 1.13 (``tag_name`` with and without the prefix).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from os import PathLike

from linkwright.diagnostics import phrase, quoted_names
from linkwright.review.changes import Change, Effect

DESCRIPTION_SUFFIXES = (".xacro", ".urdf")
_NAMESPACE, _ROOT = "xmlns:xacro", "<robot"
_DEFINITION = re.compile(r"<(?:xacro:)?macro\s[^>]*?\bname\s*=\s*[\"'](?:xacro:)?([\w.\-]+)[\"']")
_TAG = re.compile(r"<(/?)([A-Za-z_][\w.\-]*)(?=[\s/>])")
_OPENING_TAG = re.compile(r"<([A-Za-z_][\w.\-]*)(?=[\s/>])")
_PREFIX = "xacro:"
_ANY_TAG = re.compile(r"<(xacro:|)([A-Za-z_][\w.\-]*)(?=[\s/>])")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_STATEMENTS = frozenset({"macro", "property", "include", "if", "unless", "insert_block"})
_TAGS_OF_URDF = frozenset(
    {
        "robot", "link", "joint", "inertial", "inertia", "mass", "origin", "visual", "collision", "geometry",
        "box", "cylinder", "sphere", "capsule", "mesh", "material", "color", "texture", "parent", "child",
        "axis", "limit", "dynamics", "mimic", "calibration", "safety_controller", "gazebo", "sensor", "camera",
        "ray", "plugin", "transmission", "actuator", "type", "hardwareInterface", "mechanicalReduction",
        "ros2_control", "hardware", "param", "image",
    }
)  # fmt: skip
"""Tags of URDF, which a macro of the same name does not replace in this reading."""


def find_prefixed_texts(texts: Mapping[str, str]) -> dict[str | PathLike[str], str]:
    """Return the texts in which xacro of ROS 1 expands tags without the prefix, with the prefix.

    Args:
        texts: the texts of all descriptions of a version, by path.
    """
    macros = find_macros(texts.values())
    prefixed: dict[str | PathLike[str], str] = {}
    for path, text in texts.items():
        if find_unprefixed_calls(text, macros):
            prefixed[path] = _add_prefixes(text, macros)
    return prefixed


def find_macros(texts: Iterable[str]) -> frozenset[str]:
    """Return the names of the macros that texts define, without the tags of URDF."""
    return frozenset(match[1] for text in texts for match in _DEFINITION.finditer(text)) - _TAGS_OF_URDF


def find_unprefixed_calls(text: str, macros: Iterable[str]) -> list[str]:
    """Return the tags of xacro and the macros that a text uses without the prefix, in the order of the text."""
    if _NAMESPACE not in text or _ROOT not in text:
        return []
    names = _STATEMENTS | frozenset(macros)
    if names.isdisjoint(_OPENING_TAG.findall(text)):
        return []
    return [name for name in dict.fromkeys(_OPENING_TAG.findall(_COMMENT.sub("", text))) if name in names]


def _add_prefixes(text: str, macros: Iterable[str]) -> str:
    names = _STATEMENTS | frozenset(macros)
    return _TAG.sub(lambda match: f"<{match[1]}xacro:{match[2]}" if match[2] in names else match[0], text)


def is_of_ros1(manifest: str) -> bool:
    """Return whether the text of a manifest is that of a package of ROS 1, with catkin or rosbuild."""
    is_of_rosbuild = "<package" in manifest and "<name" not in manifest  # rosbuild takes the name of the folder
    return is_of_rosbuild or ("catkin" in manifest and "ament" not in manifest)


def compare_prefixes(
    old_text: str,
    new_text: str,
    find_old_macros: Callable[[], Iterable[str]],
    find_new_macros: Callable[[], Iterable[str]],
) -> list[Change]:
    """Return the changes that calls of macros get or lose the prefix.

    Args:
        old_text: the old text of a description.
        new_text: the new text of the description.
        find_old_macros: a function that returns all macros of the old version. It reads all descriptions, and is only
            called if a tag with the prefix may be one without it in the other text.
        find_new_macros: the same for the new version.
    """
    if not _may_change_prefixes(old_text, new_text):
        return []
    old = find_unprefixed_calls(old_text, find_old_macros())
    new = find_unprefixed_calls(new_text, find_new_macros())
    changes = []
    for name_list, text, others in ((old, new_text, new), (new, old_text, old)):
        names = [name for name in name_list if name not in others and f"<xacro:{name}" in text]
        if names and name_list is old:
            sentence = phrase("prefix 'xacro:' added to {names}", names=quoted_names(names))
            changes.append(Change(sentence))
        elif names:
            sentence = phrase("prefix 'xacro:' removed from {names}", names=quoted_names(names))
            reason = phrase("xacro does not expand them since ROS Noetic")
            changes.append(Change(sentence, Effect.BREAKING, reason))
    return changes


def _may_change_prefixes(old_text: str, new_text: str) -> bool:
    """Return whether one text has a tag without the prefix that the other text has with it."""
    old, new = (set(_ANY_TAG.findall(text)) for text in (old_text, new_text))
    return any(("" if prefix else _PREFIX, name) in new for prefix, name in old)
