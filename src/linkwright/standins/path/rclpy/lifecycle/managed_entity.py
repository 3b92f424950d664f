"""Stands in for ``rclpy.lifecycle.managed_entity``."""

from linkwright.graph.lifecycle.entities import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
