"""Stands in for ``rclpy.impl.logging_severity``."""

from linkwright.graph.log import LogLevel as LoggingSeverity

__all__ = ["LoggingSeverity"]
