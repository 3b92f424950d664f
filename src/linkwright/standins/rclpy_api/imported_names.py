"""What the modules of ``rclpy`` have besides what they define, because they import it themselves.

Editors that complete imports, and programs written by example, take ``Duration`` from ``rclpy.time``, ``GoalStatus``
from ``rclpy.action.client``, ``Future`` from ``rclpy.executors`` and ``Optional`` from ``rclpy.node``.
"""

from __future__ import annotations

from linkwright.standins.imported_names import imported_from

_MODULES = (
    "rclpy.node",
    "rclpy.callback_groups",
    "rclpy.clock",
    "rclpy.duration",
    "rclpy.time",
    "rclpy.task",
    "rclpy.qos",
    "rclpy.qos_overriding_options",
    "rclpy.parameter",
    "rclpy.exceptions",
    "rclpy.executors",
    "rclpy.context",
    "rclpy.event_handler",
    "rclpy.guard_condition",
    "rclpy.logging",
    "rclpy.parameter_service",
    "rclpy.service_introspection",
    "rclpy.topic_endpoint_info",
    "rclpy.time_source",
    "rclpy.type_support",
    "rclpy.utilities",
    "rclpy.waitable",
    "rclpy.expand_topic_name",
    "rclpy.validate_full_topic_name",
    "rclpy.validate_namespace",
    "rclpy.validate_node_name",
    "rclpy.validate_parameter_name",
    "rclpy.validate_topic_name",
    "rclpy.lifecycle",
    "rclpy.impl.rcutils_logger",
    "rclpy._rclpy_pybind11",
    "rclpy.constants",
    "typing",
    "enum",
)
_INTERFACES = (
    "action_msgs.msg",
    "action_msgs.srv",
    "unique_identifier_msgs.msg",
    "rcl_interfaces.msg",
    "rcl_interfaces.srv",
)

imported_there = imported_from(_MODULES, "rclpy", interfaces=_INTERFACES)
"""The ``__getattr__`` of a module of rclpy: what the module of ROS imports itself, it offers as well."""
