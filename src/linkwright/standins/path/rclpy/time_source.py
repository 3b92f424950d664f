"""Stands in for ``rclpy.time_source``."""

from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.time_source import CLOCK_TOPIC, USE_SIM_TIME_NAME, TimeSource

__all__ = ["CLOCK_TOPIC", "USE_SIM_TIME_NAME", "TimeSource"]
