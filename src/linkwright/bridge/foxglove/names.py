"""Filter topics, services and parameters by foxglove_bridge's lists of regular expressions."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph.names.expressions import Expression, ExpressionError, TooCostlyError

_MAX_CACHED = 10_000
"""The maximum number of cached decisions, because clients may ask for any number of names."""


class NameFilter:
    """A filter of names.

    One of its regular expressions must match the full name. An expression that takes too long is not used again.

    Args:
        parameter: the name of the parameter with the expressions, for log messages.
        expressions: the regular expressions.

    Raises:
        LinkwrightError: NODE701, one of them is not a regular expression.
    """

    def __init__(self, parameter: str, expressions: Sequence[str]) -> None:
        self._expressions = [_parse_expression(parameter, expression) for expression in expressions]
        self._decisions: dict[str, bool] = {}

    def accepts(self, name: str) -> bool:
        """Return whether one of the expressions matches a name."""
        decision = self._decisions.get(name)
        if decision is None:
            if len(self._decisions) == _MAX_CACHED:
                self._decisions.clear()
            decision = self._decisions[name] = any(
                self._matches(expression, name) for expression in tuple(self._expressions)
            )
        return decision

    def _matches(self, expression: Expression, name: str) -> bool:
        try:
            return expression.matches(name)
        except TooCostlyError:
            self._expressions.remove(expression)
            return False


def _parse_expression(parameter: str, expression: str) -> Expression:
    try:
        return Expression(expression)
    except ExpressionError as error:
        message = phrase(
            "parameter '{parameter}': '{expression}' is not a regular expression: {error}",
            parameter=parameter,
            expression=expression,
            error=foreign(error),
        )
        raise LinkwrightError(Diagnostic("NODE701", message)) from None
