"""The element ``<ros>`` of Gazebo classic's plugins: node name, remappings, parameters and QoS.

Source: ``gazebo_ros::Node`` of gazebo_ros_pkgs for ROS 2.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.names.rules import Remappings, absolute_namespace, join
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.xmltree import Element

_NO_NAME = re.compile(r"[^A-Za-z0-9_]")
_NUMBERS = {"int": int, "double": float, "float": float}


@dataclass(slots=True)
class NodeDescription:
    """The name, namespace and arguments of a plugin's node.

    Attributes:
        name: the node's name.
        namespace: the node's namespace.
        parameters: the values of parameters, by name.
        remappings: rules ``(from, to)``.
        qos: the elements that override QoS policies, by topic as written and ``publisher`` or ``subscriber``.
    """

    name: str
    namespace: str = "/"
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    qos: dict[tuple[str, str], Element] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        """The full name of the node, after remapping."""
        rules = Remappings(self.remappings)
        return join(absolute_namespace(rules.namespace(self.namespace, self.name)), rules.node_name(self.name))


def node_of(name: str, element: Element | None, namespace: str) -> NodeDescription:
    """Return the description of a plugin's node, from the element ``<ros>`` if there is one.

    Args:
        name: the name of the plugin; characters that a node name cannot contain become underscores.
        element: the element of the plugin.
        namespace: the default namespace.

    Raises:
        LinkwrightError: an ``<argument>`` is not a ROS argument.
    """
    node = NodeDescription(_as_name(name), _namespace(element) or namespace)
    ros = element.first("ros") if element is not None else None
    if ros is None:
        return node
    given = ["--ros-args"]
    for argument in ros.elements("argument"):
        words = argument.text().split()
        given += ["-r", *words] if len(words) == 1 and ":=" in words[0] else [w for w in words if w != "--ros-args"]
    for rule in ros.elements("remapping"):
        given += ["-r", rule.text().strip()]
    read = parse(given)
    node.remappings = read.remappings_for(node.name)
    node.parameters = {element.attributes.get("name", ""): _value(element) for element in ros.elements("parameter")}
    node.parameters |= read.parameters_for(node.full_name)
    for topic in (element for qos in ros.elements("qos") for element in qos.elements("topic")):
        for side in ("publisher", "subscriber", "subscription"):
            override = topic.first(side)
            if override is not None:
                node.qos[topic.attributes.get("name", ""), side.replace("subscription", "subscriber")] = override
    return node


def overridden(profile: QoSProfile, element: Element) -> QoSProfile:
    """Return a copy of a QoS profile with the settings of an element; unknown values have no effect."""
    result = QoSProfile(profile.depth, profile.reliability, profile.durability, profile.history)
    for child in element.elements():
        word = child.text().strip().upper()
        if child.tag == "reliability" and word in ReliabilityPolicy.__members__:
            result.reliability = ReliabilityPolicy[word]
        elif child.tag == "durability" and word in DurabilityPolicy.__members__:
            result.durability = DurabilityPolicy[word]
        elif child.tag == "history" and word in HistoryPolicy.__members__:
            result.history = HistoryPolicy[word]
        if child.tag == "history" and child.attributes.get("depth", "").isdigit():
            result.depth = int(child.attributes["depth"])
    return result


def _namespace(element: Element | None) -> str:
    """Return the namespace of ``<ros>``, or of the plugin itself as in ROS 1; empty if there is none."""
    for text in _namespaces(element):
        if text.strip("/ "):
            return "/" + text.strip("/ ")
    return ""


def _namespaces(element: Element | None) -> Iterator[str]:
    if element is None:
        return
    for inside in element.elements("ros"):
        yield from (element.text() for element in inside.elements("namespace"))
    for tag in ("robotNamespace", "robot_namespace"):
        yield from (child.text() for child in element.elements(tag))


def _as_name(name: str) -> str:
    plain = _NO_NAME.sub("_", name) or "plugin"
    return f"_{plain}" if plain[0].isdigit() else plain


def _value(element: Element) -> Any:
    text, kind = element.text().strip(), element.attributes.get("type", "string")
    if kind == "bool":
        return text.lower() in ("true", "1")
    try:
        return _NUMBERS[kind](text) if kind in _NUMBERS else text
    except ValueError:
        return text
