"""The plugins of simulators in added and removed elements, with the topics that other programs use."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, joined, phrase, quoted_names
from linkwright.review.names_in_plugins import NAME_TAGS, used_name
from linkwright.xmltree import Element

_DEFAULT_TOPICS = {
    "gazebo_ros_diff_drive": {"cmd_vel": "cmd_vel|command", "odom": "odom"},
    "gazebo_ros_skid_steer_drive": {"cmd_vel": "command", "odom": "odom"},
    "gazebo_ros_tricycle_drive": {"cmd_vel": "cmd_vel|command", "odom": "odom"},
    "gazebo_ros_ackermann_drive": {"cmd_vel": "cmd_vel|command", "odom": "odom"},
    "gazebo_ros_planar_move": {"cmd_vel": "cmd_vel|command", "odom": "odom"},
    "gazebo_ros_p3d": {"odom": "odom|topic"},
    "gazebo_ros_joint_state_publisher": {"joint_states": "joint_states|topic"},
}
"""By plugin: the default topics, and a pattern for the parameters and remappings that give others."""
_TOPIC_TAGS = re.compile(r"topic", re.IGNORECASE)
_FILE = re.compile(r"(lib)?(?P<name>.+?)(\.so)?")


def plugins_of(element: Element) -> list[Element]:
    """Return the plugins that an element contains, or the element itself if it is one."""
    if element.tag == "plugin":
        return [element]
    return [plugin for child in element.elements() for plugin in plugins_of(child)]


def plugin_name(plugin: Element) -> str:
    """Return the name of a plugin, or else its file, or the class of hardware."""
    file = PurePosixPath(plugin.attributes.get("filename", "")).name
    return plugin.attributes.get("name") or file or plugin.text().strip()


def plugin_topics(plugin: Element) -> list[str]:
    """Return the topics that a plugin names, and the default topics of a known one."""
    parameters = list(_parameters(plugin))
    topics = [used_name(value) for tag, value in parameters if _TOPIC_TAGS.search(tag) or tag == "remapping"]
    match = _FILE.fullmatch(PurePosixPath(plugin.attributes.get("filename", "")).name)
    for topic, pattern in _DEFAULT_TOPICS.get(match["name"] if match else "", {}).items():
        is_replaced = re.compile(pattern, re.IGNORECASE)
        if not any(
            is_replaced.search(tag if tag != "remapping" else value.partition(":=")[0])
            for tag, value in parameters
            if _TOPIC_TAGS.search(tag) or tag == "remapping"
        ):
            topics.append(topic)
    return list(dict.fromkeys(topics))


def sensor_topics(element: Element) -> list[str]:
    """Return the topics that the sensors in an element name."""
    own = [child.text().strip() for child in element.elements() if element.tag == "sensor" and child.tag == "topic"]
    return [*own, *(topic for child in element.elements() for topic in sensor_topics(child))]


def _parameters(plugin: Element) -> Iterator[tuple[str, str]]:
    for child in plugin.elements():
        text = " ".join(child.text().split())
        if text and NAME_TAGS.search(child.tag):
            yield child.tag, text
        yield from _parameters(child)


def _sensors_with_topics(element: Element) -> Iterator[Phrase]:
    """Yield the sensors in an element that name topics."""
    own = [child.text().strip() for child in element.elements("topic")] if element.tag == "sensor" else []
    topics = list(filter(None, own))
    if topics:
        name = element.attributes.get("name") or element.attributes.get("type", "")
        yield phrase("sensor '{name}' with the topics {topics}", name=name, topics=quoted_names(topics))
    for child in element.elements():
        yield from _sensors_with_topics(child)


def contents_text(element: Element) -> Phrase | None:
    """Return the topics of a plugin, or the plugins and sensors in another element with theirs, or None."""
    if element.tag == "plugin":
        topics = plugin_topics(element)
        return phrase("topics {topics}", topics=quoted_names(topics)) if topics else None
    parts: list[Phrase] = []
    for plugin in plugins_of(element):
        topics = plugin_topics(plugin)
        part = phrase("plugin '{name}'", name=plugin_name(plugin))
        if topics:
            names = quoted_names(topics)
            part = phrase("plugin '{name}' with the topics {topics}", name=plugin_name(plugin), topics=names)
        parts.append(part)
    parts += _sensors_with_topics(element)
    return joined(parts) if parts else None


def topics_of(element: Element) -> list[str]:
    """Return the topics of the plugins and sensors in an element."""
    topics = [topic for plugin in plugins_of(element) for topic in plugin_topics(plugin)]
    return list(dict.fromkeys([*topics, *sensor_topics(element)]))


def is_added(difference: Difference) -> bool:
    """Return whether an element or value was added."""
    return difference.kind == "added" or (difference.kind == "changed" and difference.old is None)


def is_removed(difference: Difference) -> bool:
    """Return whether an element or value was removed."""
    return difference.kind == "removed" or (difference.kind == "changed" and difference.new is None)


def added_topics(differences: Iterable[Difference]) -> frozenset[str]:
    """Return the topics of the plugins and sensors that a new version adds."""
    elements = (each.element for each in differences if each.kind == "added" or each.new is not None)
    return frozenset(topic for element in elements if element is not None for topic in topics_of(element))


def missing_topics_reason(difference: Difference, added: frozenset[str]) -> Phrase | None:
    """Return why it is breaking that an element is removed: topics that others use are missing.

    Args:
        difference: the difference.
        added: the topics that other elements of the new version offer.
    """
    if not is_removed(difference) or difference.element is None:
        return None
    topics = [topic for topic in topics_of(difference.element) if topic not in added]
    if not topics:
        return None
    return phrase("programs that use {topics} do not find the names", topics=quoted_names(topics))
