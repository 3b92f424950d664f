"""Stands in for ``rclpy.lifecycle.publisher``."""

from linkwright.graph.lifecycle.entities import LifecyclePublisher
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["LifecyclePublisher"]
