"""What ``tf2_ros`` and ``tf2_geometry_msgs`` have besides what they define.

They are made of ``from ... import *``, so that what their modules import can be taken from them: many programs have
``TransformStamped`` from ``tf2_ros`` and ``PoseStamped`` from ``tf2_geometry_msgs``.
"""

from __future__ import annotations

from typing import Any

from linkwright.standins.imported_names import imported_from, submodules_of

_MODULES = (
    "rclpy.callback_groups",
    "rclpy.clock",
    "rclpy.duration",
    "rclpy.executors",
    "rclpy.node",
    "rclpy.qos",
    "rclpy.task",
    "rclpy.time",
    "rclpy.action.client",
    "tf2_ros.transform_listener",
    "typing",
)
_INTERFACES = ("geometry_msgs.msg", "tf2_msgs.msg", "tf2_msgs.srv", "tf2_msgs.action", "builtin_interfaces.msg")

_submodule = submodules_of("tf2_ros")
_imported = imported_from(_MODULES, "tf2_ros", interfaces=_INTERFACES)

imported_for_messages = imported_from(("rclpy.time",), "tf2_geometry_msgs", interfaces=("geometry_msgs.msg",))
"""The ``__getattr__`` of ``tf2_geometry_msgs`` and its module."""


def imported_there(name: str) -> Any:
    """The ``__getattr__`` of ``tf2_ros``.

    Raises:
        AttributeError: neither tf2_ros nor what it imports has such a name.
    """
    try:
        return _submodule(name)
    except AttributeError:
        return _imported(name)
