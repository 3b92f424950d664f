"""Conditions on actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import Place, error_at, located
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_TRUE = ("true", "1")
_FALSE = ("false", "0")


class InvalidConditionExpressionError(RuntimeError):
    """The expression of a condition is neither true nor false."""


class Condition:
    """Decides when an action is visited whether it runs.

    Args:
        predicate: called with the launch context.
    """

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate
        self.place = Place.of_caller()

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether the action runs."""
        if self._predicate is None:
            return True
        try:
            return self._predicate(context)
        except LinkwrightError as error:
            raise located(error, self.place) from error
        except InvalidConditionExpressionError as error:
            raise error_at(self.place, "LAUNCH127", str(error)) from error


class IfCondition(Condition):
    """The action runs if the expression is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, expression))


class UnlessCondition(Condition):
    """The action runs if the expression is false."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: not evaluate_condition_expression(context, expression))


class LaunchConfigurationEquals(Condition):
    """The action runs if a launch configuration has a value; None asks whether it is unset."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        super().__init__(predicate=_equals(launch_configuration_name, expected_value))


class LaunchConfigurationNotEquals(Condition):
    """The action runs if a launch configuration has another value; None asks whether it is set."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        equals = _equals(launch_configuration_name, expected_value)
        super().__init__(predicate=lambda context: not equals(context))


def _equals(name: str, expected: SomeSubstitutionsType | None) -> Callable[[LaunchContext], bool]:
    wanted = None if expected is None else normalize_to_list_of_substitutions(expected)

    def evaluate(context: LaunchContext) -> bool:
        value = context.launch_configurations.get(name)
        if value is None or wanted is None:
            return value is None and wanted is None
        return bool(value == perform_substitutions(context, wanted))

    return evaluate


def evaluate_condition_expression(context: LaunchContext, expression: Any) -> bool:
    """The truth of an expression: ``true`` or ``1``, ``false`` or ``0``, in upper or lower case.

    Raises:
        InvalidConditionExpressionError: for any other text.
    """
    text = perform_substitutions(context, normalize_to_list_of_substitutions(expression))
    folded = text.strip().lower()
    if folded in _TRUE:
        return True
    if folded in _FALSE:
        return False
    raise InvalidConditionExpressionError(
        f"the condition is '{text}', which is neither 'true' or '1' nor 'false' or '0'"
    )
