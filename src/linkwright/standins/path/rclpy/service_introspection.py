"""Stands in for ``rclpy.service_introspection``."""

from linkwright.graph.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
