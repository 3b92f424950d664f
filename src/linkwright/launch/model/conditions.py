"""Conditions that determine whether actions run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.launch.errors.locations import Located, error_at, with_location
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_TRUE_TEXTS = ("true", "1")
_FALSE_TEXTS = ("false", "0")


class InvalidConditionExpressionError(Exception):
    """Raised when the expression of a condition is neither true nor false.

    Args:
        details: the text of the expression, the accepted true values and the accepted false values; or only a message.
    """

    def __init__(self, *details: Any) -> None:
        self.text = str(details[0]) if details else ""
        if len(details) > 1:
            accepted = f"true={list(details[1])}, false={list(details[2])}" if len(details) > 2 else str(details[1])
            super().__init__(f"invalid condition expression '{self.text}', expected one of: {accepted}")
        else:
            super().__init__(*details)


class Condition(Located):
    """A condition that decides at each visit of an action whether the action runs.

    Args:
        predicate: called with the launch context; returns whether the condition holds. By default, the condition never
            holds.
    """

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def describe(self) -> str:
        """Return a short text that describes the condition in listings."""
        return f"{type(self).__name__}()"

    def __str__(self) -> str:
        return self.describe()

    def _predicate_func(self, context: LaunchContext) -> bool:
        """Return the result of `evaluate`.

        Some launch files call this method under its private name in ROS.
        """
        return self.evaluate(context)

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the condition holds."""
        if self._predicate is None:
            return False
        try:
            return self._predicate(context)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        except InvalidConditionExpressionError as error:
            raise error_at(
                self.source_location, "LAUNCH127", _condition_message(error.text), ros_error=error
            ) from error


class _ExpressionCondition(Condition):
    """The base class of conditions that evaluate an expression."""

    def __init__(self, predicate_expression: Any, expected: bool) -> None:
        expression = normalize_to_list_of_substitutions(_to_text(predicate_expression))
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, expression) is expected)
        self._expression = expression

    def describe(self) -> str:
        """Return a text with the expression."""
        return f"{type(self).__name__}({describe(self._expression)})"


class IfCondition(_ExpressionCondition):
    """A condition that holds if an expression is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        super().__init__(predicate_expression, True)


class UnlessCondition(_ExpressionCondition):
    """A condition that holds if an expression is false."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        super().__init__(predicate_expression, False)


class LaunchConfigurationEquals(Condition):
    """A condition that holds if a launch configuration has the given value.

    The value None represents an unset launch configuration.
    """

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        super().__init__(predicate=_create_equality_predicate(launch_configuration_name, expected_value))


class LaunchConfigurationNotEquals(Condition):
    """A condition that holds unless a launch configuration has the given value.

    The value None represents an unset launch configuration.
    """

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        is_equal = _create_equality_predicate(launch_configuration_name, expected_value)
        super().__init__(predicate=lambda context: not is_equal(context))


def _create_equality_predicate(name: str, expected: SomeSubstitutionsType | None) -> Callable[[LaunchContext], bool]:
    expected_substitutions = None if expected is None else normalize_to_list_of_substitutions(expected)

    def evaluate(context: LaunchContext) -> bool:
        value = context.launch_configurations.get(name)
        if value is None or expected_substitutions is None:
            return value is None and expected_substitutions is None
        return bool(value == perform_substitutions(context, expected_substitutions))

    return evaluate


def evaluate_condition_expression(context: LaunchContext, expression: Any) -> bool:
    """Return the boolean value of an expression.

    The accepted texts are ``true``, ``1``, ``false`` and ``0``, in upper or lower case.

    Raises:
        InvalidConditionExpressionError: the expression evaluates to any other text.
    """
    text = perform_substitutions(context, normalize_to_list_of_substitutions(_to_text(expression)))
    normalized = text.strip().lower()
    if normalized in _TRUE_TEXTS:
        return True
    if normalized in _FALSE_TEXTS:
        return False
    raise InvalidConditionExpressionError(text, _TRUE_TEXTS, _FALSE_TEXTS)


def _to_text(expression: Any) -> Any:
    return str(expression).lower() if isinstance(expression, bool) else expression


def _condition_message(text: str) -> Phrase:
    return phrase("the condition evaluates to '{text}', but must be 'true', '1', 'false' or '0'", text=text)
