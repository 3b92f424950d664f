"""The element ``<ros>`` of Gazebo classic: node name, remappings, parameters and QoS.

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
from linkwright.sdf.plugins import library_name
from linkwright.xmltree import Element

_INVALID_NAME_CHARACTER = re.compile(r"[^A-Za-z0-9_]")
_LIBRARIES_OF_ROS_2 = frozenset(
    (
        *("gazebo_ros2_control", "gz_ros2_control-system", "ign_ros2_control-system", "ignition_ros2_control-system"),
        *("gazebo_ros_ackermann_drive", "gazebo_ros_gps_sensor", "gazebo_ros_ray_sensor"),
    )
)
"""Libraries that ROS 1 lacks. They only read the namespace in ``<ros>``."""
_NUMBER_TYPES = {"int": int, "double": float, "float": float}


@dataclass(slots=True)
class NodeDescription:
    """The name, namespace and arguments of a plugin's node.

    Attributes:
        name: the node's name.
        namespace: the node's namespace.
        parameters: the values of parameters, by name.
        remappings: the rules, as pairs of the original and the new name.
        qos: the elements that override QoS policies, by topic name in ``<ros>`` and ``publisher`` or ``subscriber``.
    """

    name: str
    namespace: str = "/"
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    qos: dict[tuple[str, str], Element] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        """The fully qualified name of the node, after remapping."""
        rules = Remappings(self.remappings)
        return join(absolute_namespace(rules.namespace(self.namespace, self.name)), rules.node_name(self.name))


def read_node_description(name: str, element: Element | None, namespace: str) -> NodeDescription:
    """Return the description of a plugin's node, from the element ``<ros>`` if there is one.

    Args:
        name: the name of the plugin; characters that a node name cannot contain become underscores.
        element: the element of the plugin; None if it has no element.
        namespace: the namespace if the element declares none.

    Raises:
        LinkwrightError: an ``<argument>`` is not a ROS argument.
    """
    node = NodeDescription(_to_node_name(name), _find_namespace(element) or namespace)
    ros = element.first("ros") if element is not None else None
    if ros is None:
        return node
    arguments = ["--ros-args"]
    for argument in ros.elements("argument"):
        tokens = argument.text().split()
        arguments += (
            ["-r", *tokens]
            if len(tokens) == 1 and ":=" in tokens[0]
            else [item for item in tokens if item != "--ros-args"]
        )
    for rule in ros.elements("remapping"):
        arguments += ["-r", rule.text().strip()]
    parsed_arguments = parse(arguments)
    node.remappings = parsed_arguments.remappings_for(node.name)
    node.parameters = {
        element.attributes.get("name", ""): _read_value(element) for element in ros.elements("parameter")
    }
    node.parameters |= parsed_arguments.parameters_for(node.full_name)
    for topic in (element for qos in ros.elements("qos") for element in qos.elements("topic")):
        for endpoint in ("publisher", "subscriber", "subscription"):
            override = topic.first(endpoint)
            if override is not None:
                node.qos[topic.attributes.get("name", ""), endpoint.replace("subscription", "subscriber")] = override
    return node


def override_profile(profile: QoSProfile, element: Element) -> QoSProfile:
    """Return a copy of a QoS profile with the policies that an element sets.

    Invalid values have no effect.
    """
    result = QoSProfile(profile.depth, profile.reliability, profile.durability, profile.history)
    for child in element.elements():
        value = child.text().strip().upper()
        if child.tag == "reliability" and value in ReliabilityPolicy.__members__:
            result.reliability = ReliabilityPolicy[value]
        elif child.tag == "durability" and value in DurabilityPolicy.__members__:
            result.durability = DurabilityPolicy[value]
        elif child.tag == "history" and value in HistoryPolicy.__members__:
            result.history = HistoryPolicy[value]
        if child.tag == "history" and child.attributes.get("depth", "").isdigit():
            result.depth = int(child.attributes["depth"])
    return result


def _find_namespace(element: Element | None) -> str:
    """Return the namespace in ``<ros>``, or in the plugin's element if its library also exists in ROS 1.

    Returns an empty string if neither declares one.
    """
    for namespace in _declared_namespaces(element):
        if namespace.strip("/ "):
            return "/" + namespace.strip("/ ")
    return ""


def _declared_namespaces(element: Element | None) -> Iterator[str]:
    if element is None:
        return
    for ros in element.elements("ros"):
        yield from (element.text() for element in ros.elements("namespace"))
    if library_name(element.attributes.get("filename", "")) in _LIBRARIES_OF_ROS_2:
        return
    for tag in ("robotNamespace", "robot_namespace"):
        yield from (child.text() for child in element.elements(tag))


def _to_node_name(name: str) -> str:
    valid_name = _INVALID_NAME_CHARACTER.sub("_", name) or "plugin"
    return f"_{valid_name}" if valid_name[0].isdigit() else valid_name


def _read_value(element: Element) -> Any:
    text, kind = element.text().strip(), element.attributes.get("type", "string")
    if kind == "bool":
        return text.lower() in ("true", "1")
    try:
        return _NUMBER_TYPES[kind](text) if kind in _NUMBER_TYPES else text
    except ValueError:
        return text
