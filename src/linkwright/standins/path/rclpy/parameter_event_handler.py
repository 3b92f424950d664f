"""Stands in for ``rclpy.parameter_event_handler``."""

from linkwright.graph.parameters.events import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]
