"""Stands in for ``rclpy.qos_overriding_options``."""

from linkwright.graph.parameter_qos import InvalidQosOverridesError, QoSOverridingOptions

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions"]
