"""Compare configurations of ros_gz bridges: the bridged topics with their types."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import yaml

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.breaking import name_reason
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.yaml_values import compose_yaml
from linkwright.review.texts.list_changes import change_text
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.merging import name_edit

_TOPIC_KEYS = ("ros_topic_name", "topic_name", "gz_topic_name", "ign_topic_name")
_ROS_TYPE, _DIRECTION = "ros_type_name", "direction"
TRANSFORM_TOPICS = ("tf", "tf_static")
_TO_ROS = ("GZ_TO_ROS", "IGN_TO_ROS")
_FROM_ROS = ("ROS_TO_GZ", "ROS_TO_IGN")


@dataclass(frozen=True)
class Bridge:
    """A bridged topic.

    Attributes:
        settings: the settings by name.
        positions: the line and the column of each setting, starting at 1.
        line: the line of the bridge.
        column: the column of the bridge.
    """

    settings: Mapping[str, str]
    positions: Mapping[str, tuple[int, int]]
    line: int
    column: int

    @property
    def topic(self) -> str:
        """The name of the topic in ROS."""
        return next((self.settings[key] for key in _TOPIC_KEYS if key in self.settings), "")

    @property
    def contents(self) -> Phrase | None:
        """The settings besides the topic in ROS; None if there are none."""
        topic_key = next((key for key in _TOPIC_KEYS if key in self.settings), None)
        return joined([f"{key} {value}" for key, value in self.settings.items() if key != topic_key]) or None


def read_bridges(text: str) -> list[Bridge] | None:
    """Return the bridges that a YAML document configures; None for any other document.

    Raises:
        UnreadableFileError: the text is not YAML.
    """
    root = compose_yaml(text)
    if not isinstance(root, yaml.SequenceNode) or not root.value:
        return None
    bridges = [bridge for bridge in map(_read_bridge, root.value) if bridge is not None]
    return bridges if len(bridges) == len(root.value) else None


def _read_bridge(node: yaml.Node) -> Bridge | None:
    settings: dict[str, str] = {}
    positions: dict[str, tuple[int, int]] = {}
    for key, value in node.value if isinstance(node, yaml.MappingNode) else []:
        if isinstance(key, yaml.ScalarNode) and isinstance(value, yaml.ScalarNode):
            settings[key.value] = value.value
            positions[key.value] = value.start_mark.line + 1, value.start_mark.column + 1
    if not any(key in settings for key in _TOPIC_KEYS):
        return None
    return Bridge(settings, positions, node.start_mark.line + 1, node.start_mark.column + 1)


def compare_bridges(pair: FilePair, old: Sequence[Bridge], new: Sequence[Bridge]) -> None:
    """Compare two versions of a configuration of bridges, topic by topic."""
    unmatched_old, unmatched_new = list(old), list(new)
    groups: dict[Hashable, list[_SettingChange]] = {}
    for old_bridge, new_bridge in list(_take_matching_pairs(unmatched_old, unmatched_new)):
        for change in _compare_settings(old_bridge, new_bridge):
            groups.setdefault(change.key, []).append(change)
    for first, *others in groups.values():
        reason = merge_reasons(change.reason for change in (first, *others))
        pair.add(first.text, Location(pair.new_path, *first.position), reason)
        names = tuple(change.name for change in others)
        locations = tuple(Location(pair.new_path, *change.position) for change in others)
        pair.changes[-1] = replace(pair.changes[-1], other_names=names, other_locations=locations)
    for bridge in unmatched_new:
        text = _append_contents(phrase("bridge '{topic}' added", topic=bridge.topic), bridge)
        pair.add(text, Location(pair.new_path, bridge.line, bridge.column))
    for bridge in unmatched_old:
        location = Location(pair.old_path, bridge.line, bridge.column, is_old=True)
        text = _append_contents(phrase("bridge '{topic}' removed", topic=bridge.topic), bridge)
        pair.add(text, location, explain_lost_topic(bridge.topic))


def explain_lost_topic(topic: str) -> Phrase:
    """Return the reason why it is breaking that a bridge no longer has a topic. Other nodes publish transforms, too."""
    if topic.strip("/") in TRANSFORM_TOPICS:
        return phrase("the transforms of the simulator are no longer on '{topic}'", topic=topic)
    return name_reason(topic)


def _append_contents(text: Phrase, bridge: Bridge) -> Phrase:
    return phrase("{change}: {contents}", change=text, contents=bridge.contents) if bridge.contents else text


def _take_matching_pairs(old: list[Bridge], new: list[Bridge]) -> Iterator[tuple[Bridge, Bridge]]:
    """Remove the matching bridges from both lists, and yield them as pairs.

    Bridges match if they have the same ROS topic, with or without the first slash, or else the same simulator topic and
    type.
    """
    for keys in (("topic",), ("relative topic",), ("gz_topic_name", _ROS_TYPE), ("ign_topic_name", _ROS_TYPE)):
        for new_bridge in list(new):
            key = _make_match_key(new_bridge, keys)
            old_bridge = next(
                (bridge for bridge in old if key is not None and _make_match_key(bridge, keys) == key), None
            )
            if old_bridge is not None:
                old.remove(old_bridge)
                new.remove(new_bridge)
                yield old_bridge, new_bridge


def _make_match_key(bridge: Bridge, names: Sequence[str]) -> tuple[str, ...] | None:
    topics = {"topic": bridge.topic, "relative topic": bridge.topic.lstrip("/")}
    values = [topics[name] if name in topics else bridge.settings.get(name) for name in names]
    known_values = tuple(value for value in values if value)
    return known_values if len(known_values) == len(names) else None


class _SettingChange(NamedTuple):
    """A changed setting of a bridge.

    Attributes:
        key: a key that is equal for topics that are edited alike.
        name: the topic, with the old one if it is renamed.
        text: the sentence about the change.
        position: the line and the column of the setting.
        reason: the reason why the change is breaking; None if it is not.
    """

    key: Hashable
    name: str
    text: Phrase
    position: tuple[int, int]
    reason: Phrase | None


def _compare_settings(old: Bridge, new: Bridge) -> Iterator[_SettingChange]:
    """Yield the settings that differ. The topic in ROS is the first one."""
    topic = new.topic
    topic_key = next((key for key in _TOPIC_KEYS if key in new.settings), "")
    if old.topic != topic:
        is_same = old.topic.lstrip("/") == topic.lstrip("/")  # the same name in the empty namespace
        reason = None if is_same else explain_lost_topic(old.topic)
        key = topic_key, name_edit(old.topic, topic), reason and reason.template
        text = phrase("bridge '{old}' renamed to '{topic}'", old=old.topic, topic=topic)
        yield _SettingChange(key, f"{old.topic} -> {topic}", text, new.positions[topic_key], reason)
    for name in dict.fromkeys([*new.settings, *old.settings]):
        before, after = old.settings.get(name), new.settings.get(name)
        if before == after or (name == topic_key and old.topic != topic):
            continue
        is_topic = name in _TOPIC_KEYS and before is not None and after is not None
        edit = name_edit(before or "", after or "") if is_topic else topic
        change = change_text(name, "-" if before is None else before, "-" if after is None else after)
        text = phrase("bridge '{topic}': {change}", topic=topic, change=change)
        reason = _find_setting_reason(topic, name, before, after)
        yield _SettingChange((name, edit), topic, text, new.positions.get(name, (new.line, new.column)), reason)


def _find_setting_reason(topic: str, name: str, old: str | None, new: str | None) -> Phrase | None:
    """Return the reason why a changed setting of a bridge is breaking, or None if it is not."""
    if name == _ROS_TYPE and old is not None and new is not None and _normalize_type(old) != _normalize_type(new):
        return phrase("programs that use the topic '{topic}' with the old type do not receive it", topic=topic)
    if name == _DIRECTION and old is not None and old not in _FROM_ROS and new in _FROM_ROS:
        return phrase("the bridge no longer publishes the topic '{topic}'", topic=topic)
    if name == _DIRECTION and old is not None and old not in _TO_ROS and new in _TO_ROS:
        return phrase("the bridge no longer subscribes to the topic '{topic}'", topic=topic)
    return None


def _normalize_type(name: str) -> str:
    """Return a comparable type name: both forms become ``sensor_msgs/Imu``."""
    return name.replace("/msg/", "/")
