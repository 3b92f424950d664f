"""Stands in for ``rclpy.qos_overriding_options``."""

from rcl_interfaces.msg import SetParametersResult as QosCallbackResult

from linkwright.graph.parameters.qos_overrides import InvalidQosOverridesError, QoSOverridingOptions
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.qos import declare_qos_parameters as _declare_qos_parameters

_declare_qos_parameteres = _declare_qos_parameters

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QosCallbackResult"]
