"""Regular expressions from files and pages, with a limit on the time that a search takes."""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from regex import Pattern

_SECONDS = 0.5
"""The time that a search may take; names and usual expressions take microseconds."""

_LEAST = 0.001
"""Seconds for each of many names, though the others took all the time."""

_MOST_CHARACTERS = 2000


class ExpressionError(ValueError):
    """A text is not a valid regular expression; the message is the reason."""


class TooCostlyError(ExpressionError):
    """A search took too long."""


class Expression:
    """A regular expression, to be found in names (decision 0020).

    Args:
        text: in the language of the library ``regex``: that of Python's `re`, and all that ECMAScript's has in common
            with it.

    Raises:
        ExpressionError: the text is not an expression.
    """

    def __init__(self, text: str) -> None:
        import regex  # few files have expressions

        if len(text) > _MOST_CHARACTERS:
            raise ExpressionError(f"it has {len(text)} characters, more than {_MOST_CHARACTERS}")
        try:
            self._pattern: Pattern[str] = regex.compile(text)
        except (regex.error, OverflowError, RecursionError) as error:
            raise ExpressionError(str(error)) from None

    def matches(self, text: str) -> bool:
        """Whether the expression matches the whole text, as with `regex_match` of C++.

        Raises:
            TooCostlyError: the search takes too long.
        """
        try:
            return self._pattern.fullmatch(text, timeout=_SECONDS) is not None
        except TimeoutError:
            raise TooCostlyError("it takes too long to find") from None

    def among(self, names: Iterable[str]) -> set[str]:
        """Those names in which the expression is found, as with `regex_search` of C++.

        Raises:
            TooCostlyError: the search takes too long, for all of them together.
        """
        end = time.monotonic() + _SECONDS
        try:
            return {name for name in names if self._pattern.search(name, timeout=max(end - time.monotonic(), _LEAST))}
        except TimeoutError:
            raise TooCostlyError("it takes too long to find") from None
