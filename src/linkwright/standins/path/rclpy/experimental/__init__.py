"""Stands in for ``rclpy.experimental``."""

from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor as EventsExecutor

__all__ = ["EventsExecutor"]
