"""Convert the names of ROS types to and from their names on the wire, for DDS and Zenoh."""

from __future__ import annotations

import re

_TYPE = re.compile(r"(?P<package>\w+)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+)_")


def to_wire_type(type_name: str) -> str:
    """Return the name of a ROS type on the wire.

    For example, ``std_msgs/msg/Header`` becomes ``std_msgs::msg::dds_::Header_``.
    """
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def to_ros_type(type_name: str) -> str | None:
    """Return the ROS name of a type on the wire, or None if the type is not a ROS type."""
    match = _TYPE.fullmatch(type_name)
    return f"{match['package']}/{match['kind']}/{match['name']}" if match else None
