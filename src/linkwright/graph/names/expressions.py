"""Regular expressions from files and pages, with a time limit for each search."""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from regex import Pattern

_TIME_LIMIT_S = 0.5
"""The time limit of a search, in seconds. A usual expression takes microseconds on a name."""

_MIN_TIME_S = 0.001
"""The minimum time for each name, in seconds, even if the search in earlier names took all of the time limit."""

_MAX_CHARACTERS = 2000


class ExpressionError(ValueError):
    """Raised when a text is not a valid regular expression.

    The message is the reason.
    """


class TooCostlyError(ExpressionError):
    """Raised when a search exceeds the time limit."""


class Expression:
    """A regular expression for names (decision 0020).

    Args:
        text: the expression, in the syntax of the library ``regex``, which extends Python's `re`. Expressions that
            are valid in both `re` and ECMAScript work unchanged.

    Raises:
        ExpressionError: the text is too long, or is not a valid expression.
    """

    def __init__(self, text: str) -> None:
        import regex  # few files have expressions

        if len(text) > _MAX_CHARACTERS:
            raise ExpressionError(f"it has {len(text)} characters, more than {_MAX_CHARACTERS}")
        try:
            self._pattern: Pattern[str] = regex.compile(text)
        except (regex.error, OverflowError, RecursionError) as error:
            raise ExpressionError(str(error)) from None

    def matches(self, text: str) -> bool:
        """Return whether the expression matches the entire text, as C++'s `regex_match` does.

        Raises:
            TooCostlyError: the search takes too long.
        """
        try:
            return self._pattern.fullmatch(text, timeout=_TIME_LIMIT_S) is not None
        except TimeoutError:
            raise TooCostlyError("the search takes too long") from None

    def found_in(self, names: Iterable[str]) -> set[str]:
        """Return the names that contain a match, as C++'s `regex_search` finds it.

        Raises:
            TooCostlyError: the search takes too long in total.
        """
        deadline_s = time.monotonic() + _TIME_LIMIT_S
        try:
            return {
                name
                for name in names
                if self._pattern.search(name, timeout=max(deadline_s - time.monotonic(), _MIN_TIME_S))
            }
        except TimeoutError:
            raise TooCostlyError("the search takes too long") from None
