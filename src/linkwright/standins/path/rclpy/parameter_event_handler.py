"""Stands in for ``rclpy.parameter_event_handler``."""

from linkwright.graph.parameters.events import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]
