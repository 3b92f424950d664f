"""Stands in for ``rclpy.task``."""

from linkwright.graph.executors import Task
from linkwright.graph.future import Future

__all__ = ["Future", "Task"]
