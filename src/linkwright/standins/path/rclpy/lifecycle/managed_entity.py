"""Stands in for ``rclpy.lifecycle.managed_entity``."""

from linkwright.graph.lifecycle.entities import ManagedEntity, SimpleManagedEntity
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
