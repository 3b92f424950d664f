"""Stands in for ``launch.conditions.invalid_condition_expression_error``."""

from linkwright.launch.conditions import InvalidConditionExpressionError

__all__ = ["InvalidConditionExpressionError"]
