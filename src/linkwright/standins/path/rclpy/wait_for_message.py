"""Stands in for ``rclpy.wait_for_message``."""

from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.waiting import wait_for_message

__all__ = ["wait_for_message"]
