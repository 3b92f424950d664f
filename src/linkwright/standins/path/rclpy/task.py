"""Stands in for ``rclpy.task``."""

from linkwright.graph.executors import Task
from linkwright.graph.future import Future
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["Future", "Task"]
