"""Stands in for ``rclpy.experimental.events_executor``."""

from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor as EventsExecutor

__all__ = ["EventsExecutor"]
