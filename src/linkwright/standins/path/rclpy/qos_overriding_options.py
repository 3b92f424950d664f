"""Stands in for ``rclpy.qos_overriding_options``."""

from linkwright.graph.parameters.qos_overrides import InvalidQosOverridesError, QoSOverridingOptions

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions"]
