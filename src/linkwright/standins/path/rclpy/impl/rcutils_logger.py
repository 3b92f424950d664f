"""Stands in for ``rclpy.impl.rcutils_logger``."""

from linkwright.graph.log.logger import Logger as RcutilsLogger

__all__ = ["RcutilsLogger"]
