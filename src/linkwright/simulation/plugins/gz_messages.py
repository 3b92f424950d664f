"""Messages of gz in descriptions, as the messages of ROS into which a bridge converts them.

The messages are in the text format of protobuf.

Source: ros_gz_bridge (the ROS type of each type of gz).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.messages import get_message
from linkwright.messages.errors import FieldValueError
from linkwright.messages.message import Message
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.protobuf_text import Fields, TextFormatError, message_from_fields, parse_fields
from linkwright.xmltree import Element

ROS_TYPES = {
    "Actuators": "actuator_msgs/msg/Actuators",
    "Altimeter": "ros_gz_interfaces/msg/Altimeter",
    "BatteryState": "sensor_msgs/msg/BatteryState",
    "Boolean": "std_msgs/msg/Bool",
    "Color": "std_msgs/msg/ColorRGBA",
    "Contacts": "ros_gz_interfaces/msg/Contacts",
    "Double": "std_msgs/msg/Float64",
    "Empty": "std_msgs/msg/Empty",
    "Entity": "ros_gz_interfaces/msg/Entity",
    "EntityWrench": "ros_gz_interfaces/msg/EntityWrench",
    "Float": "std_msgs/msg/Float32",
    "IMU": "sensor_msgs/msg/Imu",
    "Image": "sensor_msgs/msg/Image",
    "Int32": "std_msgs/msg/Int32",
    "JointTrajectory": "trajectory_msgs/msg/JointTrajectory",
    "LaserScan": "sensor_msgs/msg/LaserScan",
    "LogicalCameraImage": "ros_gz_interfaces/msg/LogicalCameraImage",
    "NavSat": "sensor_msgs/msg/NavSatFix",
    "Odometry": "nav_msgs/msg/Odometry",
    "Param": "ros_gz_interfaces/msg/ParamVec",
    "Pose": "geometry_msgs/msg/Pose",
    "Quaternion": "geometry_msgs/msg/Quaternion",
    "StringMsg": "std_msgs/msg/String",
    "Time": "builtin_interfaces/msg/Time",
    "Twist": "geometry_msgs/msg/Twist",
    "UInt32": "std_msgs/msg/UInt32",
    "Vector3d": "geometry_msgs/msg/Vector3",
    "Wrench": "geometry_msgs/msg/Wrench",
}
"""The ROS type of each type of gz, for the topics that the simulation publishes or takes."""

_PARAMETERS_TYPE = "Param"
_ANY_FIELDS: dict[str, tuple[int, str, Callable[[Any], Any]]] = {
    "bool_value": (1, "bool_value", bool),
    "int_value": (2, "integer_value", int),
    "double_value": (3, "double_value", float),
    "string_value": (4, "string_value", str),
}
"""The fields of ``gz.msgs.Any`` that a ROS parameter can have: the number of the type, the field and its type."""


def find_ros_type(plugin: SimulatedPlugin[Any], element: Element) -> str:
    """Return the ROS type for the type of gz in the attribute ``type`` of an element.

    Raises:
        LinkwrightError: SIM160, the type has no ROS type.
    """
    name = element.attributes.get("type", "")
    ros_type = ROS_TYPES.get(_short_name(name))
    if ros_type is None:
        raise plugin.parameter_error(
            phrase("plugin '{plugin}': the type '{type}' has no ROS type", plugin=plugin.context.name, type=name)
        )
    return ros_type


def read_topic(plugin: SimulatedPlugin[Any], element: Element) -> str:
    """Return the absolute name of the topic in the attribute ``topic`` of an element.

    Raises:
        LinkwrightError: SIM160, there is no topic.
    """
    topic = element.attributes.get("topic", "")
    if not topic:
        raise plugin.parameter_error(
            phrase("plugin '{plugin}': <{tag}> needs a topic", plugin=plugin.context.name, tag=element.tag)
        )
    return f"/{topic.lstrip('/')}"


def read_message(plugin: SimulatedPlugin[Any], element: Element, text: str, path: tuple[str, ...] = ()) -> Message:
    """Return the ROS message for a text.

    Args:
        plugin: the plugin that the element belongs to.
        element: the element with the type of the message.
        text: the fields, or the value of a nested field.
        path: the names of the nested field whose value the text contains.

    Raises:
        LinkwrightError: SIM160, the type has no ROS type, or the text is not such a message.
    """
    try:
        fields: Fields = parse_fields(f"{path[-1]}: {text}" if path else text)
        for name in reversed(path[:-1]):
            fields = {name: [fields]}
        if _short_name(element.attributes.get("type", "")) == _PARAMETERS_TYPE:
            return _create_parameters(fields)
        return message_from_fields(find_ros_type(plugin, element), fields)
    except (TextFormatError, FieldValueError) as error:
        if isinstance(error, LinkwrightError):
            raise plugin.parameter_error(error.diagnostics[0].message) from error
        message = phrase(
            "plugin '{plugin}': '{text}' is not a message in the text format of protobuf",
            plugin=plugin.context.name,
            text=" ".join(text.split()),
        )
        raise plugin.parameter_error(message) from error


def _short_name(name: str) -> str:
    """Return the name of a type without its package."""
    return name.rpartition(".")[2]


def _create_parameters(fields: Fields) -> Message:
    """Return the values of a ``gz.msgs.Param`` as parameters.

    Values without a type of ROS, such as vectors, are left out, as by the bridge.

    Raises:
        TextFormatError: an entry has no name or no value.
    """
    try:
        entries = [(str(entry["key"][-1]), entry["value"][-1].items()) for entry in fields.get("params", ())]
        parameters = [
            get_message("rcl_interfaces/msg/Parameter")(name=name, value=_create_parameter_value(field, items[-1]))
            for name, values in entries
            for field, items in values
            if field in _ANY_FIELDS
        ]
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise TextFormatError(str(fields)) from error
    message: Message = get_message(ROS_TYPES[_PARAMETERS_TYPE])(params=parameters)
    return message


def _create_parameter_value(field: str, item: Any) -> Message:
    type_number, ros_field, convert = _ANY_FIELDS[field]
    message: Message = get_message("rcl_interfaces/msg/ParameterValue")(type=type_number, **{ros_field: convert(item)})
    return message
