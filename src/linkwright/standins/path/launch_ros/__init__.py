"""Stands in for ``launch_ros``."""

from launch_ros import (
    actions,
    descriptions,
    event_handlers,
    events,
    parameter_descriptions,
    parameters_type,
    remap_rule_type,
    substitutions,
    utilities,
)

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "parameters_type",
    "remap_rule_type",
    "substitutions",
    "utilities",
]
