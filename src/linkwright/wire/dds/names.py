"""Map ROS 2 names and types to DDS (design article "Topic and service name mapping", rmw)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from linkwright.wire.type_names import to_ros_type

DISCOVERY_TOPIC = "ros_discovery_info"
"""The topic on which each participant announces its nodes."""


class Role(Enum):
    """The roles of DDS topics: ROS topics, requests and responses."""

    TOPIC = "rt"
    REQUEST = "rq"
    REPLY = "rr"


_SUFFIXES = {Role.TOPIC: "", Role.REQUEST: "Request", Role.REPLY: "Reply"}
_ROLES = {role.value: role for role in Role}


@dataclass(frozen=True, slots=True)
class RosName:
    """The ROS name of a DDS topic.

    Attributes:
        role: the role of the topic.
        name: the absolute name of the topic or service.
    """

    role: Role
    name: str


def to_dds_topic(role: Role, name: str, *, plain: bool = False) -> str:
    """Return the DDS topic for an absolute ROS name.

    Args:
        role: the role of the topic.
        name: the name, such as ``/joint_states``.
        plain: whether to omit the prefix, as the QoS setting ``avoid_ros_namespace_conventions`` requires.
    """
    return ("" if plain else role.value) + name + _SUFFIXES[role]


def parse_ros_name(topic: str) -> RosName | None:
    """Return the ROS name of a DDS topic, or None if the topic does not belong to ROS."""
    prefix, slash, path = topic.partition("/")
    role = _ROLES.get(prefix)
    if role is None or not slash:
        return None
    suffix = _SUFFIXES[role]
    if not path.endswith(suffix) or len(path) == len(suffix):
        return None
    return RosName(role, "/" + path[: len(path) - len(suffix)])


def parse_service_type(type_name: str) -> str | None:
    """Return the service type of a request or reply type, or None for any other type."""
    name = to_ros_type(type_name)
    if name is None:
        return None
    for suffix in ("_Request", "_Response"):
        if name.endswith(suffix):
            return name[: -len(suffix)]
    return None


def parse_user_data(data: bytes) -> dict[str, str]:
    """Parse USER_DATA of the form ``key=value;key=value;`` (rmw ``parse_key_value``)."""
    entries = {}
    for item in data.decode("utf-8", errors="replace").split(";"):
        key, equals, value = item.partition("=")
        if equals and key.strip():
            entries[key.strip()] = value.strip("\0 ")
    return entries


def format_endpoint_id(guid: bytes) -> str:
    """Format the id that links the reader and the writer of a client or service.

    The format is rmw_cyclonedds_cpp's.
    """
    first_byte, *other_bytes = guid
    return f"{first_byte:2x}" + "".join(f".{byte:x}" for byte in other_bytes)
