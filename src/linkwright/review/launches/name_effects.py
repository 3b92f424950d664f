"""Decide whether another name of a node, or another remapping of its names, is breaking."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import name_reason, names_reason, possible_name_reason
from linkwright.review.launches.chosen_texts import is_choice
from linkwright.review.launches.matching import find_loaded_class
from linkwright.review.launches.outlines import PARAMETER, REMAPPING, Entry, LaunchOutline, without_condition
from linkwright.review.launches.programs.default_names import find_package_folders
from linkwright.review.launches.programs.sides import (
    Side,
    find_old_side,
    is_name_of_known_node,
    is_new_name,
    only_looks_up,
)
from linkwright.review.launches.taken_names import is_taken_over

_DESCRIPTION = ("robot_state_publisher/robot_state_publisher", "robot_description")
"""A program and its topic, which is a parameter in ROS 1."""
_NAME = re.compile(r"[~/\w]+")
_LOOP_VARIABLE = re.compile(r"\$\(eval [a-z_]\w*\)")
"""The variable of a loop in a name, whose value is not empty."""
_UNKNOWN_NAME = re.compile(r"\w\(|\w[.\[][a-z_\"']")
"""A call, attribute or item of Python in a name, whose value is unknown."""
_VARIABLE = re.compile(r"\$\((?:var|arg) [^()]*\)")
_UNKNOWN_NAMESPACE = re.compile(r"(?:^|/)(\$\((?:var|arg) [^()]*\)[^$]*)$")
_PACKAGE = re.compile(r"\$\(find(?:-pkg-share)? ([\w.-]+)\)")
_NAMESPACE_ARGUMENT = re.compile(r"(?!use_)(\w+_)?(namespace|ns)\d*")
"""The arguments whose values, judging by the argument name, are namespaces."""
_ENABLED_CONDITION = re.compile(r" \((if (true|1)|unless (false|0))\)", re.IGNORECASE)
_DISABLED_NAMESPACE = re.compile(r"[^\s/]* \((if (false|0)|unless (true|1))\)", re.IGNORECASE)
"""A namespace that is pushed with a condition that does not hold."""


def find_node_remapping_reason(
    entry: Entry,
    source: str,
    old: str | None,
    new: str | None,
    old_outline: LaunchOutline,
    new_outline: LaunchOutline,
) -> Phrase | None:
    """Return the reason why a changed remapping of a node is breaking, or None if it is not."""
    if is_new_name(entry.name, source, old_outline.root, new_outline.root):
        return None
    program = find_loaded_class(entry) or entry.name
    side = find_old_side(program, source, old_outline.root, new_outline.root)
    if side is Side.UNKNOWN and any(is_name_of_known_node(target) for target in (old, new) if target is not None):
        return None
    if side in (Side.USES, Side.LACKS) or _are_remapped_elsewhere(f"{source} {old or ''}", new_outline):
        return None
    if old is not None and old_outline.resolve(old) in _find_remapping_targets(entry, new_outline):
        return None  # the new file gives the name to a different topic of the node
    if old is not None and is_taken_over(entry, old, old_outline, new_outline):
        return None
    is_known = publishes(program, source, old_outline, new_outline)
    return find_remapping_reason(source, old, new, old_outline, new_outline, is_known=is_known)


def find_lost_target_reason(entry: Entry, old: LaunchOutline, new: LaunchOutline) -> Phrase | None:
    """Return the reason why removing one of several nodes of a program is breaking, or None if it is not.

    The node certainly publishes or serves a topic or service with a new name that no other action gives to anything.

    Args:
        entry: the removed node. Another action still starts its program.
        old: the outline of the old file.
        new: the outline of the new file.
    """
    program = find_loaded_class(entry) or entry.name
    others = {target for other in new.entries for target in _find_remapping_targets(other, new)}
    others |= {new.resolve(other.settings.get("to", "")) for other in new.entries if other.kind == "remapping"}
    lost: list[str] = []
    for setting, value in entry.settings.items():
        source, target = without_condition(setting).removeprefix(REMAPPING), old.resolve(value)
        is_lost = setting.startswith(REMAPPING) and target not in others and _NAME.fullmatch(target) is not None
        if is_lost and publishes(program, source, old, new):
            lost.append(target)
    return names_reason(lost) if lost else None


def publishes(program: str, source: str, old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether a program certainly publishes or serves a name.

    Args:
        program: the package and the executable of the node, or its class.
        source: the name that the node itself gives to the topic or service.
        old: the outline of the old file.
        new: the outline of the new file.
    """
    is_description = (program, source.lstrip("/")) == _DESCRIPTION and not new.is_ros1
    return is_description or find_old_side(program, source, old.root, new.root) is Side.OFFERS


def find_remapping_reason(
    source: str,
    old: str | None,
    new: str | None,
    old_outline: LaunchOutline,
    new_outline: LaunchOutline,
    *,
    is_known: bool = False,
) -> Phrase | None:
    """Return the reason why a changed remapping of a name is breaking.

    The result is None if the resulting name is the same.

    Args:
        source: the name in the node.
        old: the old name outside of it; None if it was the same.
        new: the new name outside of it; None if it is the same.
        old_outline: the outline of the old file.
        new_outline: the outline of the new file.
        is_known: whether the node certainly publishes or serves the name.
    """
    old_name = old_outline.resolve(source if old is None else old)
    new_name = new_outline.resolve(source if new is None else new)
    if old_name.lstrip("/") == new_name.lstrip("/"):  # the same name in the empty namespace
        return None
    if not _NAME.fullmatch(_VARIABLE.sub("", new_name) or "/") or _has_new_variable(old_name, new_name):
        return None  # the name may be the same
    return name_reason(old_name) if is_known else possible_name_reason(old_name)


def find_renaming_reason(
    old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return the reason why a changed node name or namespace is breaking, or None."""
    old_name, new_name = resolve_name(old, old_outline), resolve_name(new, new_outline)
    if not old_name and _LOOP_VARIABLE.search(new_name):
        return phrase("programs that use the names of the node, its topics or its services do not find them")
    if (
        _strip_known_prefix(old_name) == _strip_known_prefix(new_name)
        or _UNKNOWN_NAME.search(new_name)
        or _has_new_variable(old_name, new_name)
        or _can_be(new_name, old_name)
        or is_choice(old_name)
        or is_choice(new_name)
    ):
        return None
    return phrase("programs that use the names of the node, its topics or its services do not find them")


def find_included_renaming_reason(
    entry: Entry,
    argument: str,
    old: str | None,
    new: str | None,
    old_outline: LaunchOutline,
    new_outline: LaunchOutline,
) -> Phrase | None:
    """Return the reason why another namespace for an included file of another repository is breaking, or None.

    The name of the argument tells that it is a namespace. The old namespace and the new one must be certain.

    Args:
        entry: an include; other actions have no such reason.
        argument: the name of the argument.
        old: its old value; None if it was not passed.
        new: its new value; None if it is no longer passed.
        old_outline: the outline of the old file.
        new_outline: the outline of the new file.
    """
    package = _PACKAGE.match(entry.name) if entry.kind == "include" else None
    root = new_outline.root
    if package is None or root is None or _NAMESPACE_ARGUMENT.fullmatch(argument) is None or old is None or new is None:
        return None
    names = [resolve_name(value, outline).strip("\"'/") for value, outline in ((old, old_outline), (new, new_outline))]
    is_certain = all(_NAME.fullmatch(name or "/") for name in names)
    if names[0] == names[1] or not is_certain or package[1] in find_package_folders(root):
        return None
    return phrase("the topics of the nodes that it starts get other names")


def names_looked_up_frame(argument: str, outline: LaunchOutline) -> bool:
    """Return whether an argument only gives nodes the names of frames that they look up but do not publish."""
    variable = re.compile(rf"\$\((?:var|arg) {re.escape(argument)}[ )]")
    uses = [
        (entry.name, without_condition(setting))
        for entry in outline.entries
        for setting, value in entry.settings.items()
        if variable.search(f"{entry.name} {value}")
    ]
    return bool(uses) and all(
        setting.startswith(PARAMETER) and only_looks_up(program, setting.removeprefix(PARAMETER), outline.root)
        for program, setting in uses
    )


def _can_be(name: str, other: str) -> bool:
    """Return whether a name with variables of Python can be another name."""
    parts = _LOOP_VARIABLE.split(name)
    return len(parts) > 1 and re.fullmatch(".+".join(map(re.escape, parts)), other) is not None


def _strip_known_prefix(name: str) -> str:
    """Return the part of a name from its last unknown variable, or the whole name.

    The value of the variable may begin with ``/``, which discards the prefix.
    """
    match = _UNKNOWN_NAMESPACE.search(name)
    return name if match is None else match[1]


def resolve_name(text: str | None, outline: LaunchOutline) -> str:
    """Return a name with the defaults of the arguments; empty for None."""
    resolved = outline.resolve(text or "").strip("/")
    return _DISABLED_NAMESPACE.sub("", _ENABLED_CONDITION.sub("", resolved)).strip("/")


def _has_new_variable(old: str, new: str) -> bool:
    """Return whether a new name has an unknown variable that the old name lacks."""
    return not set(_VARIABLE.findall(new)) <= set(_VARIABLE.findall(old))


def _find_remapping_targets(entry: Entry, outline: LaunchOutline) -> set[str]:
    """Return the names to which an action remaps others."""
    settings = entry.settings.items()
    return {outline.resolve(value) for name, value in settings if name.startswith(REMAPPING)}


def _are_remapped_elsewhere(names: str, outline: LaunchOutline) -> bool:
    """Return whether arguments of nodes remap the names.

    An example is ``--controller-ros-args`` of a spawner.
    """
    words = set(_NAME.findall(names))
    arguments = " ".join(entry.settings.get("arguments", "") for entry in outline.entries)
    return bool(words) and words <= set(_NAME.findall(arguments))
