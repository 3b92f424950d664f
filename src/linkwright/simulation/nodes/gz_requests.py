"""Messages and requests of gz in the text format of protobuf, as the command ``gz`` takes and prints them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.messages import get_message, get_service
from linkwright.messages.message import Message
from linkwright.simulation.gz_services import CREATE, SET_POSE, GzService, remove_pose
from linkwright.simulation.plugins.gz_messages import ROS_TYPES
from linkwright.simulation.plugins.protobuf_text import (
    Fields,
    is_sequence,
    message_from_fields,
    parse_fields,
)

_ENTITY_TYPE, _POSE_TYPE = "ros_gz_interfaces/msg/Entity", "geometry_msgs/msg/Pose"
_FIELD_NAMES = {"nanosec": "nsec"}
"""The names of fields in gz that differ from those in ROS."""


def create_request(service: GzService, text: str) -> Any:
    """Return the request of a service of gz as a request of ROS.

    Raises:
        TextFormatError: the text is not in the text format.
        FieldValueError: a field does not exist in ROS, or a value is not valid for it.
    """
    fields = _to_ros_fields(parse_fields(text))
    request = get_service(service.ros_type).Request()
    if service is SET_POSE:
        entity_fields: Fields = {name: fields.pop(name) for name in ("name", "id") if name in fields}
        request.entity = message_from_fields(_ENTITY_TYPE, entity_fields)
        request.pose = message_from_fields(_POSE_TYPE, fields)
        return request
    (field_name,) = request.get_fields_and_field_types()
    type_name = request.get_fields_and_field_types()[field_name].replace("/", "/msg/", 1)
    message = message_from_fields(type_name, fields)
    if service is CREATE and "pose" not in fields:
        remove_pose(message)
    setattr(request, field_name, message)
    return request


def create_message(gz_type: str, text: str) -> Message | None:
    """Return a message of gz as a message of ROS, or None if its type has none.

    Raises:
        TextFormatError: the text is not in the text format.
        FieldValueError: a field does not exist in ROS, or a value is not valid for it.
    """
    ros_type = ROS_TYPES.get(gz_type.rpartition(".")[2])
    return None if ros_type is None else message_from_fields(ros_type, _to_ros_fields(parse_fields(text)))


def format_message(message: Any) -> str:
    """Return a message of ROS in the text format; fields with default values are left out, as by protobuf."""
    return "".join(f"{line}\n" for line in _format_fields(message))


def _to_ros_fields(fields: Fields) -> Fields:
    """Return fields of gz as fields of ROS.

    In protobuf, the omitted ``w`` of a rotation is 0, and in ROS it is 1. A rotation that only consists of zeros is
    none. Types of entities are names in protobuf, and numbers in ROS.
    """
    ros_fields: Fields = {}
    for name, items in fields.items():
        values = [_to_ros_fields(item) if isinstance(item, dict) else item for item in items]
        if name == "orientation":
            values = [{"w": [0.0], **value} if any(value.values()) else value for value in values]
        elif name == "type" and isinstance(values[-1], str):
            values = [getattr(get_message(_ENTITY_TYPE), values[-1], values[-1])]
        ros_fields[name] = values
    return ros_fields


def _format_fields(message: Any) -> Iterator[str]:
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        for item in value if is_sequence(value) else [value]:
            yield from _format_field(_FIELD_NAMES.get(name, name), item, keeps_default=is_sequence(value))


def _format_field(name: str, value: Any, *, keeps_default: bool) -> Iterator[str]:
    if isinstance(value, Message):
        lines = list(_format_fields(value))
        if lines or keeps_default:
            yield f"{name} {{"
            yield from (f"  {line}" for line in lines)
            yield "}"
    elif isinstance(value, bool):
        if value or keeps_default:
            yield f"{name}: {str(value).lower()}"
    elif isinstance(value, str):
        if value or keeps_default:
            escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
            yield f'{name}: "{escaped}"'
    elif value or keeps_default:
        yield f"{name}: {value:.17g}" if isinstance(value, float) else f"{name}: {value}"
