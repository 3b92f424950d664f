"""Stands in for ``rclpy.lifecycle.publisher``."""

from linkwright.graph.lifecycle_entities import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
