"""The message classes that Linkwright uses by name, with stubs in ``wellknown.pyi``."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.messages.classes import get_message

Time = get_message("builtin_interfaces/msg/Time")
Duration = get_message("builtin_interfaces/msg/Duration")
Header = get_message("std_msgs/msg/Header")
String = get_message("std_msgs/msg/String")
Quaternion = get_message("geometry_msgs/msg/Quaternion")
Transform = get_message("geometry_msgs/msg/Transform")
TransformStamped = get_message("geometry_msgs/msg/TransformStamped")
Vector3 = get_message("geometry_msgs/msg/Vector3")
JointState = get_message("sensor_msgs/msg/JointState")

FloatSequence = Sequence[float]
"""Numbers for a float64[] field: any sequence of floats.

For many numbers, this is a numpy array.
"""
