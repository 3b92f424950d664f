"""Stands in for ``rclpy.lifecycle.publisher``."""

from linkwright.graph.lifecycle.entities import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
