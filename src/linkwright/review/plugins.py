"""Read the simulator plugins in added and removed elements, with the topics that other programs use."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, joined, phrase, quoted_names
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.breaking import namespace_reason
from linkwright.review.names_in_plugins import NAME_TAGS, NAMESPACE_TAG, extract_used_name
from linkwright.review.texts.element_values import format_values
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
"""The default topics by plugin, and a pattern for the parameters and remappings that replace them."""
_TOPIC_TAGS = re.compile(r"topic", re.IGNORECASE)
_PART_TAGS = ("plugin", "sensor")
_SENSOR_TOPIC = re.compile(r"(?:.* )?sensor (?P<name>\S+) topic")
"""The path of the topic of a sensor."""
_PLUGIN_PARAMETER = re.compile(r"plugin (?P<name>\S+) (?:\S+ )*?(?P<tag>\S+)(?: \d+)?")
"""The path of a parameter of a plugin."""
_MAX_VALUES = 12
"""The maximum number of values of a plugin, sensor or other element in a line."""
_CAMERA_TAGS = frozenset({"ros", "frame_name", "hack_baseline", "min_depth", "max_depth"})
"""Parameters of ``gazebo_ros_camera`` of ROS 2."""
_FILE = re.compile(r"(lib)?(?P<name>.+?)(\.so)?")


def find_plugins(element: Element) -> list[Element]:
    """Return the plugins inside an element, or the element itself if it is a plugin."""
    if element.tag == "plugin":
        return [element]
    return [plugin for child in element.elements() for plugin in find_plugins(child)]


def find_plugin_name(plugin: Element) -> str:
    """Return the name of a plugin, or else its file, or the class of a plugin of hardware or Webots."""
    file = PurePosixPath(plugin.attributes.get("filename", "")).name
    return plugin.attributes.get("name") or file or plugin.attributes.get("type") or plugin.text().strip()


def find_plugin_topics(plugin: Element) -> list[str]:
    """Return the topics that a plugin names, and the default topics of a known plugin."""
    parameters = list(_find_parameters(plugin))
    topics = [extract_used_name(value) for tag, value in parameters if _TOPIC_TAGS.search(tag) or tag == "remapping"]
    return list(dict.fromkeys([*topics, *_find_default_topics(plugin)]))


def _find_default_topics(plugin: Element) -> list[str]:
    """Return the default topics of a known plugin that its parameters do not replace."""
    parameters, topics = list(_find_parameters(plugin)), []
    match = _FILE.fullmatch(PurePosixPath(plugin.attributes.get("filename", "")).name)
    for topic, pattern in _DEFAULT_TOPICS.get(match["name"] if match else "", {}).items():
        is_replaced = re.compile(pattern, re.IGNORECASE)
        if not any(
            is_replaced.search(tag if tag != "remapping" else value.partition(":=")[0])
            for tag, value in parameters
            if _TOPIC_TAGS.search(tag) or tag == "remapping"
        ):
            topics.append(topic)
    return topics


def find_sensor_topics(element: Element) -> list[str]:
    """Return the topics that the sensors in an element name."""
    own_topics = [
        child.text().strip() for child in element.elements() if element.tag == "sensor" and child.tag == "topic"
    ]
    return [*own_topics, *(topic for child in element.elements() for topic in find_sensor_topics(child))]


def _find_parameters(plugin: Element) -> Iterator[tuple[str, str]]:
    for child in plugin.elements():
        text = " ".join(child.text().split())
        if text and NAME_TAGS.search(child.tag):
            yield child.tag, text
        yield from _find_parameters(child)


def format_contents(element: Element) -> Phrase | None:
    """Return the values of a plugin or sensor, or the plugins and sensors in an element.

    The result includes the default topics of a known plugin.
    """
    if element.tag in _PART_TAGS or not any(child.tag in _PART_TAGS and child.attributes for child in element.walk()):
        texts = [format_values(element, _MAX_VALUES), _format_default_topics(element)]
        return joined(list(filter(None, texts))) if any(texts) else None
    texts = [*format_plugins(element, _MAX_VALUES), format_values(element, _MAX_VALUES, _PART_TAGS)]
    return joined(list(filter(None, texts)))


def format_plugins(element: Element, limit: int) -> list[Phrase]:
    """Return the plugins and sensors in an element with their values.

    Args:
        element: the XML element.
        limit: the maximum number of values to show for each plugin or sensor.
    """
    parts: list[Phrase] = []
    for child in element.elements():
        if child.tag in _PART_TAGS and child.attributes:
            shown = ("type", find_plugin_name(child)) if child.tag == "plugin" else ()
            attributes = {
                name: value for name, value in child.attributes.items() if name != "name" and (name, value) != shown
            }
            texts: list[Phrase | None] = [as_phrase(f"{name}={value}") for name, value in attributes.items()]
            texts += [format_values(child, limit, _PART_TAGS), _format_default_topics(child)]
            title = phrase("plugin '{name}'", name=find_plugin_name(child))
            if child.tag == "sensor":
                title = phrase("sensor '{name}'", name=child.attributes.get("name", ""))
            items = list(filter(None, texts))
            parts.append(phrase("{entry} ({items})", entry=title, items=joined(items)) if items else title)
        parts += format_plugins(child, limit)
    return parts


def _format_default_topics(element: Element) -> Phrase | None:
    topics = _find_default_topics(element) if element.tag == "plugin" else []
    return phrase("topics {topics}", topics=quoted_names(topics)) if topics else None


def find_topics(element: Element) -> list[str]:
    """Return the topics of the plugins and sensors in an element."""
    topics = [topic for plugin in find_plugins(element) for topic in find_plugin_topics(plugin)]
    cameras = [topic for child in element.walk() if child.tag == "sensor" for topic in _find_camera_topics(child)]
    return list(dict.fromkeys([*topics, *cameras, *find_sensor_topics(element)]))


def _find_camera_topics(sensor: Element) -> Iterator[str]:
    """Yield the default topics of the plugin of a camera in ROS 2, whose first part is the name of the sensor.

    The plugin of ROS 1 has tags in mixed case, and its topics do not have this name.
    """
    for plugin in sensor.elements("plugin"):
        tags = {child.tag for child in plugin.elements()}
        if "gazebo_ros_camera" in plugin.attributes.get("filename", "") and tags & _CAMERA_TAGS:
            is_named = "camera_name" in tags or any(tag == "remapping" for tag, _ in _find_parameters(plugin))
            for topic in () if is_named or any(map(str.isupper, "".join(tags))) else ("image_raw", "camera_info"):
                yield f"{sensor.attributes.get('name', '')}/{topic}"


def is_added(difference: Difference) -> bool:
    """Return whether an element or value was added."""
    return difference.kind == "added" or (difference.kind == "changed" and difference.old is None)


def is_removed(difference: Difference) -> bool:
    """Return whether an element or value was removed."""
    return difference.kind == "removed" or (difference.kind == "changed" and difference.new is None)


def find_added_topics(differences: Iterable[Difference]) -> frozenset[str]:
    """Return the topics that the new version adds.

    They are in added plugins and sensors, and in changed values of plugins.
    """
    topics: set[str] = set()
    for difference in differences:
        if is_removed(difference):
            continue
        if difference.element is not None:
            topics |= {*find_topics(difference.element), *_find_names(difference.element)}
        elif difference.new is not None and NAME_TAGS.search(difference.property.rpartition(" ")[2]):
            topics.add(extract_used_name(difference.new))
    return frozenset(topics)


def find_offered_topics(differences: Iterable[Difference]) -> set[str]:
    """Return the topics of added plugins and sensors."""
    elements = [item.element for item in differences if is_added(item) and item.element is not None]
    return {topic for element in elements for topic in find_topics(element)}


def _find_names(element: Element) -> Iterator[str]:
    """Yield the names in the parameters of the plugins in an element."""
    text = " ".join(element.text().split())
    own_parameters = [(element.tag, text)] if text and NAME_TAGS.search(element.tag) else []
    yield from (extract_used_name(value) for _, value in (*own_parameters, *_find_parameters(element)))


def is_still_offered(difference: Difference, added: frozenset[str]) -> bool:
    """Return whether another value of the new version contains the old name in a plugin.

    Args:
        difference: the difference between both versions.
        added: the names that the new version adds; see `find_added_topics`.
    """
    if difference.subject != "extension" or difference.kind != "changed" or not difference.old:
        return False
    is_name = NAME_TAGS.search(difference.property.rpartition(" ")[2]) is not None
    name = extract_used_name(difference.old if difference.element is None else difference.element.text())
    return is_name and name in added


def find_default_topic_reason(difference: Difference, elements: Iterable[Element]) -> Phrase | None:
    """Return why an added topic of a sensor is breaking, or None for other differences.

    Args:
        difference: the difference between both versions.
        elements: the elements of the new version.
    """
    match = _SENSOR_TOPIC.fullmatch(f"{difference.name} {difference.property}".strip())
    if match is None or not is_added(difference):
        return None
    sensors = (child for element in elements for child in element.walk() if child.tag == "sensor")
    sensor = next((child for child in sensors if child.attributes.get("name") == match["name"]), None)
    return None if sensor is None else find_sensor_reason(sensor)


def find_sensor_reason(sensor: Element) -> Phrase | None:
    """Return why a topic that a sensor newly names is breaking: the default topic is gone.

    The result is None for a sensor of Gazebo classic, whose plugin has its own topics.
    """
    if any(sensor.elements("plugin")):
        return None
    return phrase(
        "programs and bridges that use the default topic of the sensor '{name}' get no messages",
        name=sensor.attributes.get("name", ""),
    )


def names_same_topic(difference: Difference, old: Iterable[Element], new: Iterable[Element]) -> bool:
    """Return whether a topic only gains or loses the slash before it, and thus remains the same topic.

    This is so for a sensor of Gazebo, and for a plugin if its namespace is the root in both versions.

    Args:
        difference: the difference between both versions.
        old: the extensions of the old robot.
        new: the extensions of the new robot.
    """
    if is_same_sensor_topic(difference):
        return True
    match = _PLUGIN_PARAMETER.fullmatch(difference.property)
    if match is None or difference.kind != "changed" or not difference.old or not difference.new:
        return False
    is_topic = _TOPIC_TAGS.search(match["tag"]) is not None or match["tag"] == "remapping"
    if not is_topic or not differ_only_in_slash(difference.old, difference.new):
        return False
    return all(is_in_root_namespace(elements, match["name"]) for elements in (old, new))


def is_same_sensor_topic(difference: Difference) -> bool:
    """Return whether the topic of a sensor only gains or loses the slash before it, which Gazebo adds."""
    path = f"{difference.name} {difference.property}".strip()
    if _SENSOR_TOPIC.fullmatch(path) is None or not difference.old or not difference.new:
        return False
    return differ_only_in_slash(difference.old, difference.new)


def differ_only_in_slash(old: str, new: str) -> bool:
    """Return whether two topics or remappings name the same topics except for the slash at the start."""
    return [part.strip().lstrip("/") for part in old.split(":=")] == [
        part.strip().lstrip("/") for part in new.split(":=")
    ]


def is_in_root_namespace(elements: Iterable[Element], name: str, evaluate: Callable[[str], str] = str) -> bool:
    """Return whether all plugins of a name are in the root namespace.

    Without a namespace, a plugin of ``gazebo_ros`` for ROS 1 is in that of its model.

    Args:
        elements: the elements with the plugins.
        name: the name of the plugins.
        evaluate: a function that returns the value of an unexpanded text.
    """
    plugins = [plugin for element in elements for plugin in find_plugins(element) if find_plugin_name(plugin) == name]
    for plugin in plugins:
        spaces = [
            evaluate(child.text().strip()).strip("/ ") for child in plugin.walk() if NAMESPACE_TAG.search(child.tag)
        ]
        is_classic = "gazebo_ros" in plugin.attributes.get("filename", "") and plugin.first("ros") is None
        if any(spaces) or (is_classic and not spaces):
            return False
    return bool(plugins)


def find_missing_topics_reason(difference: Difference, added: frozenset[str]) -> Phrase | None:
    """Return why removing or replacing an element is breaking, or None if it is not.

    The change is breaking if the new version lacks topics of the element.

    Args:
        difference: the difference between both versions.
        added: the topics that other elements of the new version offer.
    """
    element = difference.element if is_removed(difference) else getattr(difference, "old_plugin", None)
    if element is None:
        return None
    topics = [topic for topic in find_topics(element) if topic not in added]
    if not topics:
        return None if find_topics(element) else _find_missing_namespace_reason(element, added)
    return phrase("programs that use {topics} do not find the names", topics=quoted_names(topics))


def _find_missing_namespace_reason(element: Element, added: frozenset[str]) -> Phrase | None:
    """Return why removing a plugin without names of topics but with a namespace is breaking, or None."""
    namespaces = [
        namespace
        for plugin in find_plugins(element)
        for child in plugin.elements()
        if NAMESPACE_TAG.search(child.tag) and (namespace := child.text().strip()).strip("/")
    ]
    lost = [namespace for namespace in namespaces if namespace not in added]
    return namespace_reason(lost[0]) if lost else None
