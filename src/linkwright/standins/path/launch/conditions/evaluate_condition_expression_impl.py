"""Stands in for ``launch.conditions.evaluate_condition_expression_impl``."""

from linkwright.launch.conditions import evaluate_condition_expression

__all__ = ["evaluate_condition_expression"]
