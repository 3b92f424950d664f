"""Names of ROS types on the wire, which are the same over DDS and over Zenoh."""

from __future__ import annotations

import re

_TYPE = re.compile(r"(?P<package>\w+)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+)_")


def dds_type(type_name: str) -> str:
    """The name on the wire of a ROS type: ``std_msgs/msg/Header`` becomes ``std_msgs::msg::dds_::Header_``."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(type_name: str) -> str | None:
    """The ROS name of a message type on the wire; None when it is not written in ROS's way."""
    match = _TYPE.fullmatch(type_name)
    return f"{match['package']}/{match['kind']}/{match['name']}" if match else None
