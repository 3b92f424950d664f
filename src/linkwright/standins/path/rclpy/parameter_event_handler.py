"""Stands in for ``rclpy.parameter_event_handler``."""

from linkwright.graph.parameter_events import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]
