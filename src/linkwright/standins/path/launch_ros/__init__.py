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
from linkwright.standins.imported_names import submodules_of

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

__getattr__ = submodules_of(__name__)
