"""Stands in for ``launch.conditions.evaluate_condition_expression_impl``."""

from linkwright.launch.conditions import evaluate_condition_expression
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["evaluate_condition_expression"]
