"""Stands in for ``rclpy.time_source``."""

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"

__all__ = ["CLOCK_TOPIC", "USE_SIM_TIME_NAME"]
