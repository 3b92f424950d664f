"""Compare RViz configurations: displays, frames, tools, panels and the view."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import yaml

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase, quoted_names
from linkwright.diagnostics.phrase import count_shown
from linkwright.review.changes import MAX_NAMES, Location
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.files.parameters.yaml_values import compose_yaml, read_yaml_values
from linkwright.review.versions import Version

_MANAGER = "Visualization Manager"
_GLOBAL_PREFIX = f"{_MANAGER}.Global Options."
_VIEW_PREFIX = f"{_MANAGER}.Views.Current."
_VIEW_PROPERTIES = ("Class", "Target Frame")
"""The compared properties of the view. The others are the point from which it looks, which RViz saves each time."""
_IGNORED_PROPERTIES = frozenset(
    {"Class", "Name", "Value", "Displays", "Links", "Frames", "Tree", "Namespaces", "Status"}
)
"""The properties of displays that are compared separately, or that RViz fills from received data."""
_COMPUTED_PROPERTIES = frozenset({"Min Intensity", "Max Intensity", "Min Value", "Max Value", "Min Color", "Max Color"})
_TOPICS = ("Topic", "Image Topic", "Marker Topic")
"""The properties with the topic of a display: the last two in files of ROS 1."""
_MAX_PROPERTIES = 4
"""The maximum number of properties of a display in a line."""


@dataclass(frozen=True)
class _Item:
    """A display, tool or panel.

    Attributes:
        name: the displayed name, after the names of the enclosing groups.
        class_name: the plugin class, such as ``rviz_default_plugins/TF``.
        properties: the compared properties by name.
        line: the line in the file, starting at 1.
        column: the column in the file, starting at 1.
    """

    name: str
    class_name: str
    properties: Mapping[str, str]
    line: int
    column: int

    @property
    def topic(self) -> str:
        """The topic; empty if there is none."""
        return next((self.properties[name] for name in _TOPICS if name in self.properties), "")


@dataclass(frozen=True)
class _Configuration:
    displays: Sequence[_Item]
    tools: Sequence[_Item]
    panels: Sequence[_Item]
    values: Mapping[str, str]


def compare_rviz_files(pair: FilePair) -> None:
    """Compare two versions of an RViz configuration, without the layout of the window."""
    configurations = pair.read(_read)
    if configurations is None:
        return
    old, new = configurations
    _compare_values(pair, old.values, new.values)
    _compare_displays(pair, old.displays, new.displays)
    for items, title in (
        ((old.tools, new.tools), phrase("tools")),
        ((old.panels, new.panels), phrase("panels")),
    ):
        _compare_classes(pair, *items, title)


def rviz_contents(version: Version, path: str) -> Phrase | None:
    """Return the displays of a configuration with their topics, or None if there are none."""
    displays = _read(version.file(path)).displays
    names = [f"{display.name} {display.topic}".rstrip() for display in displays]
    return phrase("displays {names}", names=joined_first(names, MAX_NAMES)) if names else None


def _read(file: Path) -> _Configuration:
    text = file.read_text(encoding="utf-8-sig")
    root = compose_yaml(text)
    manager = _find_child(root, _MANAGER)
    if manager is None:
        raise UnreadableFileError(phrase("it has no '{name}'", name=_MANAGER))
    values = {name: value.text for name, value in read_yaml_values(text).items()}
    return _Configuration(
        list(_read_items(_find_child(manager, "Displays"), "")),
        list(_read_items(_find_child(manager, "Tools"), "")),
        list(_read_items(_find_child(root, "Panels"), "")),
        values,
    )


def _find_child(node: yaml.Node | None, name: str) -> yaml.Node | None:
    if not isinstance(node, yaml.MappingNode):
        return None
    return next((value for key, value in node.value if key.value == name), None)


def _get_text(node: yaml.Node | None) -> str:
    return str(node.value) if isinstance(node, yaml.ScalarNode) else ""


def _read_items(node: yaml.Node | None, group: str) -> Iterator[_Item]:
    """Yield the items of a list, including the items of display groups."""
    for item in node.value if isinstance(node, yaml.SequenceNode) else ():
        class_name = _get_text(_find_child(item, "Class"))
        if not class_name:
            continue
        name = group + (_get_text(_find_child(item, "Name")) or class_name)
        properties = dict(_read_properties(item, ""))
        yield _Item(name, class_name, properties, item.start_mark.line + 1, item.start_mark.column + 1)
        yield from _read_items(_find_child(item, "Displays"), f"{name}/")


def _read_properties(node: yaml.Node, path: str) -> Iterator[tuple[str, str]]:
    """Yield the properties of an item.

    A topic is a text in old files and a group of properties in new ones.
    """
    for key, value in node.value:
        name = str(key.value)
        if name in _COMPUTED_PROPERTIES or (not path and name in _IGNORED_PROPERTIES):
            continue
        full_name = path if path and name == "Value" else f"{path} {name}".strip()
        if isinstance(value, yaml.MappingNode):
            yield from _read_properties(value, full_name)
        elif isinstance(value, yaml.ScalarNode):
            yield full_name, " ".join(str(value.value).split())


def _compare_values(pair: FilePair, old: Mapping[str, str], new: Mapping[str, str]) -> None:
    for name in dict.fromkeys([*new, *old]):
        before, after = old.get(name), new.get(name)
        if name.startswith(_GLOBAL_PREFIX) and not _are_equal(before, after):
            pair.add(_format_change(name.removeprefix(_GLOBAL_PREFIX), before, after), None)
    old_view, new_view = (
        {name: values[name] for name in values if name.removeprefix(_VIEW_PREFIX) in _VIEW_PROPERTIES}
        for values in (old, new)
    )
    changes = [
        _format_change(name.removeprefix(_VIEW_PREFIX), old_view.get(name), new_view.get(name))
        for name in dict.fromkeys([*new_view, *old_view])
        if not _are_equal(old_view.get(name), new_view.get(name))
    ]
    if changes:
        classes = [view.get(f"{_VIEW_PREFIX}Class", "-") for view in (old_view, new_view)]
        text = phrase("view: {changes}", changes=joined(changes))
        if classes[0] != classes[1]:
            text = phrase("view {old} -> {new}", old=classes[0], new=classes[1])
        pair.add(text, None)


def _compare_displays(pair: FilePair, old: Sequence[_Item], new: Sequence[_Item]) -> None:
    unmatched_old, unmatched_new = list(old), list(new)
    for before, after in list(_take_matching_pairs(unmatched_old, unmatched_new)):
        for text in _compare_display(before, after):
            pair.add(text, _get_location(pair, after))
    for display in unmatched_new:
        text = phrase("display '{name}' of class '{type}' added", name=display.name, type=display.class_name)
        if display.topic:
            text = phrase("{change}: topic {topic}", change=text, topic=display.topic)
        pair.add(text, _get_location(pair, display))
    for display in unmatched_old:
        text = phrase("display '{name}' of class '{type}' removed", name=display.name, type=display.class_name)
        if display.topic:
            text = phrase("{change}: topic {topic}", change=text, topic=display.topic)
        pair.add(text, _get_location(pair, display, is_old=True))


def _take_matching_pairs(old: list[_Item], new: list[_Item]) -> Iterator[tuple[_Item, _Item]]:
    """Remove the matching displays from both lists, and yield them as pairs."""
    for keys in (("name", "class_name", "topic"), ("name", "class_name"), ("class_name", "topic"), ("name",)):
        for after in list(new):
            key = [getattr(after, name) for name in keys]
            matching = (display for display in old if [getattr(display, name) for name in keys] == key)
            before = next(matching, None) if all(key) or "name" in keys else None
            if before is not None:
                old.remove(before)
                new.remove(after)
                yield before, after


def _compare_display(old: _Item, new: _Item) -> Iterator[Phrase]:
    if old.name != new.name:
        yield phrase("display '{old}' renamed to '{name}'", old=old.name, name=new.name)
    if old.class_name != new.class_name:
        yield phrase("display '{name}': class {old} -> {new}", name=new.name, old=old.class_name, new=new.class_name)
    if old.topic != new.topic:
        yield phrase(
            "display '{name}': topic {old} -> {new}", name=new.name, old=old.topic or "-", new=new.topic or "-"
        )
    changes = [
        _format_change(name, old.properties[name], new.properties[name])
        for name in dict.fromkeys([*new.properties, *old.properties])
        if name not in _TOPICS and name in old.properties and name in new.properties
        if not _are_equal(old.properties[name], new.properties[name])
    ]
    if changes:
        shown = joined(changes[: count_shown(len(changes), _MAX_PROPERTIES)])
        text = phrase("display '{name}': {changes}", name=new.name, changes=shown)
        yield _join_changes(text, changes)


def _are_equal(old: str | None, new: str | None) -> bool:
    """Return whether two values are equal as texts, or as numbers of 32 bits, with which RViz calculates."""
    try:
        return old == new or (old is not None and new is not None and _to_float32(old) == _to_float32(new))
    except (ValueError, OverflowError):
        return False


def _to_float32(text: str) -> bytes:
    return struct.pack("f", float(text))


def _format_change(name: str, old: str | None, new: str | None) -> Phrase:
    if not old:
        return phrase("{parameter} {value} added", parameter=name, value=new or "''")
    if not new:
        return phrase("{parameter} {value} removed", parameter=name, value=old)
    return phrase("{parameter} {old} -> {new}", parameter=name, old=old, new=new)


def _join_changes(text: Phrase, changes: Sequence[Phrase]) -> Phrase:
    """Return a line with the first changes, and with the number of the others."""
    hidden_count = len(changes) - count_shown(len(changes), _MAX_PROPERTIES)
    if hidden_count <= 0:
        return text
    return counted("{change} and {count} more value", "{change} and {count} more values", hidden_count, change=text)


def _compare_classes(pair: FilePair, old: Sequence[_Item], new: Sequence[_Item], title: Phrase) -> None:
    old_classes, new_classes = ({item.class_name: item for item in items} for items in (old, new))
    added = [item for name, item in new_classes.items() if name not in old_classes]
    removed = [item for name, item in old_classes.items() if name not in new_classes]
    if added:
        names = quoted_names([item.class_name for item in added])
        pair.add(phrase("{kind} added: {names}", kind=title, names=names), _get_location(pair, added[0]))
    if removed:
        names = quoted_names([item.class_name for item in removed])
        text = phrase("{kind} removed: {names}", kind=title, names=names)
        pair.add(text, _get_location(pair, removed[0], is_old=True))
    for name, item in new_classes.items():
        before = old_classes.get(name)
        if before is not None and before.topic != item.topic:
            text = phrase("'{name}': topic {old} -> {new}", name=name, old=before.topic or "-", new=item.topic or "-")
            pair.add(text, _get_location(pair, item))


def _get_location(pair: FilePair, item: _Item, *, is_old: bool = False) -> Location:
    return Location(pair.old_path if is_old else pair.new_path, item.line, item.column, is_old)
