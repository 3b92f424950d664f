"""Stands in for ``launch.conditions.invalid_condition_expression_error``."""

from linkwright.launch.conditions import InvalidConditionExpressionError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["InvalidConditionExpressionError"]
