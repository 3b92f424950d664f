"""Merge equal changes to several links, joints or extensions into one line."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable
from dataclasses import replace

from linkwright.descriptions.comparison import ROS2_CONTROL
from linkwright.diagnostics import phrase
from linkwright.review.changes import REMOVED_VALUE, Change, Location
from linkwright.review.texts.merged_interfaces import merge_interfaces
from linkwright.review.texts.merged_reasons import merge_reasons

_PART = re.compile(r"(?P<part>(?:joint|gpio|sensor) \S+|plugin \S+ \((?P<joint>[^()]+)\)) (?P<property>.+)")
"""A property of hardware of ros2_control below one of its joints, GPIOs or sensors, or of a plugin for a joint."""
_WHOLE_PLUGIN = re.compile(r"(?P<plugin>plugin \S+) \((?P<joint>[^()]+)\)")
"""An added or removed plugin for a joint."""
_PLUGIN = re.compile(r"(?:.* )?plugin (?P<name>\S+) (?P<property>[^()]+)")
"""A parameter of a plugin, perhaps in a sensor."""
_PARAMETER = re.compile(r"(?P<parent>(?:.* )?)(?P<parameter>param \S+)")
"""A parameter of hardware of ros2_control, or of one of its joints, as a whole."""
_TRANSMISSION = "transmission "
_PART_OF_TRANSMISSION = re.compile(r"(joint|actuator) \S+")
"""A joint or motor of a transmission. Its name differs in each transmission."""
_TOKEN = re.compile(r"[^\W_]+|[\W_]")
"""A word or number in a name, or a separating character."""
_NO_NAME = re.compile(r"None|[\d\s.,;:+\-e<>()]*", re.ASCII)
"""A missing value or numbers. They are the same change only if they are equal."""
_OWN_NAME = "*"
"""The mark for the name of the changed link, joint or extension in its properties and values."""


def merge_changes(changes: Iterable[Change]) -> list[Change]:
    """Return the changes, with equal changes to several links, joints or extensions merged.

    Renames count as equal if they replace the same part, such as a prefix.
    """
    changes = merge_interfaces(list(changes))
    for key, names in (
        (_make_content_key, _list_names),
        (_make_part_key, _list_part_names),
        (_make_plugin_key, _list_plugin_names),
        (_make_parameter_key, _list_parameter_names),
    ):
        groups: dict[Hashable, list[Change]] = {}
        for number, change in enumerate(changes):
            content = key(change) if change.name else None
            groups.setdefault(number if content is None else (content, change.cases), []).append(change)
        changes = [group[0] if len(group) == 1 else _merge_group(group, names) for group in groups.values()]
    return merge_interfaces(list(changes))


def _make_content_key(change: Change) -> Hashable:
    """Return a key that is equal for the same change to other links, joints or extensions."""
    own_name = change.name.rpartition(" ")[2]
    effect, property_name, (template, subject, old, new) = change.content
    if REMOVED_VALUE in change.core.arguments:
        new = ""  # properties that are removed together had different values
    old_name = _find_old_name(change)
    if old_name is not None:
        return effect, template, subject, name_edit(old_name, change.name)
    property_name = property_name.replace(own_name, _OWN_NAME) if len(own_name) > 1 else property_name
    if change.name.startswith(_TRANSMISSION):
        property_name = _PART_OF_TRANSMISSION.sub(rf"\1 {_OWN_NAME}", property_name)
    contents = str(change.sentence.arguments.get("contents", "")).replace(own_name, _OWN_NAME)
    return effect, template, subject, property_name, name_edit(old, new), contents


def name_edit(old: str, new: str) -> Hashable:
    """Return the replaced part of a name and its replacement.

    For values that are not names, both values are returned.
    """
    if _NO_NAME.fullmatch(old) or _NO_NAME.fullmatch(new):
        return old, new
    start, end = _count_common_ends(old, new)
    removed, inserted = old[start : len(old) - end], new[start : len(new) - end]
    if not removed or not inserted:
        return removed, inserted, start == 0
    old_tokens, new_tokens = _TOKEN.findall(old), _TOKEN.findall(new)
    start, end = _count_common_ends(old_tokens, new_tokens)
    return tuple(old_tokens[start : len(old_tokens) - end]), tuple(new_tokens[start : len(new_tokens) - end])


def _count_common_ends(old: str | list[str], new: str | list[str]) -> tuple[int, int]:
    """Return the lengths of the common prefix and suffix.

    The suffix takes precedence, so that the two do not overlap.
    """
    length = min(len(old), len(new))
    end = next((index for index in range(length) if old[-1 - index] != new[-1 - index]), length)
    max_start = length - end
    return next((index for index in range(max_start) if old[index] != new[index]), max_start), end


def _find_old_name(change: Change) -> str | None:
    """Return the old name of a renamed link, joint or extension; None for other changes."""
    arguments = change.core.arguments
    is_renamed = "old" in arguments and "new" not in arguments
    return str(arguments["old"]) if is_renamed else None


def _list_names(change: Change) -> tuple[str, ...]:
    old_name = _find_old_name(change)
    return change.name if old_name is None else f"{old_name} -> {change.name}", *change.other_names


def _make_part_key(change: Change) -> Hashable | None:
    """Return a key that is equal for the same change to other joints of the same hardware.

    The result is None for changes that are not about hardware.
    """
    new_name = _find_new_part_name(change)
    if new_name is not None:
        if change.other_names:
            return None
        tag, _, old_name = change.property_name.rpartition(" ")
        return change.effect, change.name, tag, name_edit(old_name, new_name)
    plugin = _WHOLE_PLUGIN.fullmatch(change.property_name)
    if plugin is not None:
        template, *values = change.values
        is_joint = re.compile(rf"(?<!\w){re.escape(plugin['joint'])}(?!\w)")
        return change.effect, change.name, plugin["plugin"], template, is_joint.sub(_OWN_NAME, values[-1])
    part = _PART.fullmatch(change.property_name)
    return None if part is None else (change.effect, change.name, part["property"], change.values, change.other_names)


def _find_new_part_name(change: Change) -> str | None:
    """Return the new name of a renamed element of an extension; None for other changes."""
    arguments = change.core.arguments
    is_renamed = "new" in arguments and change.core.template.endswith("renamed to '{new}'")
    return str(arguments["new"]) if is_renamed else None


def _list_part_names(change: Change) -> tuple[str, ...]:
    new_name = _find_new_part_name(change)
    if new_name is not None:
        return (f"{change.property_name} -> {new_name}",)
    plugin = _WHOLE_PLUGIN.fullmatch(change.property_name)
    if plugin is not None:
        return (plugin["joint"],)
    part = _PART.fullmatch(change.property_name)
    return (change.name,) if part is None else (part["joint"] or part["part"],)


def _make_plugin_key(change: Change) -> Hashable | None:
    """Return a key that is equal for the same change to the same parameter of other plugins; None for other changes."""
    plugin = _PLUGIN.fullmatch(change.property_name)
    if plugin is None or change.other_names or change.name.startswith(ROS2_CONTROL):
        return None
    arguments = change.sentence.arguments
    return (
        change.effect,
        plugin["property"],
        change.values,
        change.sentence.template,
        str(arguments.get("contents", "")),
    )


def _list_plugin_names(change: Change) -> tuple[str, ...]:
    plugin = _PLUGIN.fullmatch(change.property_name)
    return (change.name if plugin is None else plugin["name"],)


def _make_parameter_key(change: Change) -> Hashable | None:
    """Return a key that is equal for parameters added to or removed from one element.

    The result is None for other changes.
    """
    parameter = _PARAMETER.fullmatch(change.property_name)
    if parameter is None or change.reason is not None or change.other_names or "old" in change.core.arguments:
        return None
    return change.name, parameter["parent"], change.core.template


def _list_parameter_names(change: Change) -> tuple[str, ...]:
    parameter = _PARAMETER.fullmatch(change.property_name)
    if parameter is None:
        return (change.name,)
    arguments = change.core.arguments
    return (f"{parameter['parameter']} {arguments.get('new', arguments.get(REMOVED_VALUE, ''))}".strip(),)


def _merge_group(changes: list[Change], list_names: Callable[[Change], tuple[str, ...]]) -> Change:
    first = changes[0]
    names = dict.fromkeys(name for change in changes for name in list_names(change))
    if list_names is _list_part_names:
        names |= dict.fromkeys(first.other_names)
    for name in list_names(first)[:1]:
        del names[name]
    locations: dict[Location, None] = {}
    for location in (location for change in changes for location in (change.location, *change.other_locations)):
        if location is not None and location != first.location:
            locations[location] = None
    reason = merge_reasons(change.reason for change in changes)
    sentence = first.sentence
    is_parameter = list_names is _list_parameter_names
    if not is_parameter and len({str(change.core.arguments.get(REMOVED_VALUE)) for change in changes}) > 1:
        arguments = {name: value for name, value in first.core.arguments.items() if name != REMOVED_VALUE}
        sentence = phrase("{subject} '{name}': {property} removed", **arguments)
    return replace(first, sentence=sentence, reason=reason, other_names=tuple(names), other_locations=tuple(locations))
