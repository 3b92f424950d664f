"""Stands in for ``rclpy.impl.logging_severity``."""

from linkwright.graph.log.logger import LogLevel as LoggingSeverity

__all__ = ["LoggingSeverity"]
