"""Which topics, services and parameters are offered, by foxglove_bridge's lists of regular expressions."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError


class NameFilter:
    """Names that match one of some expressions as a whole, as ECMAScript's `regex_match`.

    Args:
        parameter: whose value they are, for messages.
        expressions: of them.

    Raises:
        LinkwrightError: NODE701, one is no regular expression.
    """

    def __init__(self, parameter: str, expressions: Sequence[str]) -> None:
        self._patterns = [_compiled(parameter, expression) for expression in expressions]

    def accepts(self, name: str) -> bool:
        """Whether a name is wanted."""
        return any(pattern.fullmatch(name) for pattern in self._patterns)


def _compiled(parameter: str, expression: str) -> re.Pattern[str]:
    try:
        return re.compile(expression)
    except re.error as error:
        message = f"parameter '{parameter}': '{expression}' is no regular expression: {error}"
        raise LinkwrightError(Diagnostic("NODE701", message)) from None
