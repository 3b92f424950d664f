"""Evaluate conditions in ``if(...)`` and ``while(...)`` to true, false or unknown."""

from __future__ import annotations

import re
from collections.abc import Callable, MutableMapping, Sequence

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.packages.readers.cmake_syntax import is_open

_NUMBER = lazy_pattern(r"[+-]?\d+(\.\d*)?")
TRUE_CONSTANTS = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE_CONSTANTS = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"})
_ORDER_TESTS: dict[str, Callable[[int], bool]] = {
    "EQUAL": lambda sign: sign == 0,
    "LESS": lambda sign: sign < 0,
    "GREATER": lambda sign: sign > 0,
    "LESS_EQUAL": lambda sign: sign <= 0,
    "GREATER_EQUAL": lambda sign: sign >= 0,
}
_BINARY_OPERATORS = frozenset({"MATCHES", "IN_LIST"}) | {
    f"{kind}{order}" for kind in ("", "STR", "VERSION_") for order in _ORDER_TESTS
}
_MAX_TOKENS = 200
_SEARCH_TIMEOUT_S = 0.2
"""The maximum time in seconds to match a regular expression, because it may come from an untrusted file."""


@dataclass(frozen=True, slots=True)
class Word:
    """A word of a condition.

    Attributes:
        text: the text with known variables substituted.
        is_quoted: whether the word is quoted.
    """

    text: str
    is_quoted: bool = False

    @property
    def keyword(self) -> str:
        """The text of the word as an operator, or an empty string if it is quoted."""
        return "" if self.is_quoted else self.text


@dataclass(slots=True)
class Condition:
    """A condition to evaluate.

    Args:
        words: the words of the condition.
        variables: the known variables; ``MATCHES`` sets ``CMAKE_MATCH_...`` in them.
        path_exists: called with an operator and a path; returns whether the path exists or, for ``IS_DIRECTORY``, is a
            folder; returns None if that is not known.
    """

    words: Sequence[Word]
    variables: MutableMapping[str, str]
    path_exists: Callable[[str, str], bool | None]
    _index: int = 0

    def evaluate(self) -> bool | None:
        """Return whether the condition is true, or None if that is not known."""
        if len(self.words) > _MAX_TOKENS:
            return None
        result = self._evaluate_or()
        return result if self._index == len(self.words) else None

    def _accept(self, *keywords: str) -> bool:
        if self._index < len(self.words) and self.words[self._index].keyword in keywords:
            self._index += 1
            return True
        return False

    def _evaluate_or(self) -> bool | None:
        result = self._evaluate_and()
        while self._accept("OR"):
            other = self._evaluate_and()
            result = True if result or other else None if None in (result, other) else False
        return result

    def _evaluate_and(self) -> bool | None:
        result = self._evaluate_not()
        while self._accept("AND"):
            other = self._evaluate_not()
            result = False if False in (result, other) else None if None in (result, other) else True
        return result

    def _evaluate_not(self) -> bool | None:
        if self._accept("NOT"):
            result = self._evaluate_not()
            return None if result is None else not result
        return self._evaluate_test()

    def _evaluate_test(self) -> bool | None:
        if self._accept("("):
            result = self._evaluate_or()
            return result if self._accept(")") else None
        if self._index >= len(self.words):
            return None
        word = self.words[self._index]
        self._index += 1
        if word.keyword in ("EXISTS", "IS_DIRECTORY", "DEFINED", "COMMAND", "TARGET", "POLICY", "IS_ABSOLUTE"):
            return self._evaluate_unary(word.text)
        if self._index < len(self.words) and self.words[self._index].keyword in _BINARY_OPERATORS:
            operator = self.words[self._index].text
            self._index += 1
            return self._evaluate_binary(word, operator)
        return self._evaluate_word(word)

    def _evaluate_unary(self, operator: str) -> bool | None:
        if self._index >= len(self.words):
            return None
        subject = self.words[self._index].text
        self._index += 1
        if is_open(subject):
            return None
        if operator == "DEFINED":
            return True if subject in self.variables else None
        return self.path_exists(operator, subject) if operator in ("EXISTS", "IS_DIRECTORY") else None

    def _evaluate_binary(self, left: Word, operator: str) -> bool | None:
        if self._index >= len(self.words):
            return None
        right = self.words[self._index]
        self._index += 1
        value = self._get_value(left)
        if operator == "IN_LIST":
            items = self.variables.get(right.text)
            return None if items is None or is_open(items + value) else value in items.split(";")
        other = right.text if operator == "MATCHES" else self._get_value(right)
        if is_open(value) or is_open(other):
            return None
        if operator == "MATCHES":
            return self._matches(value, other)
        kind = next((kind for kind in ("STR", "VERSION_") if operator.startswith(kind)), "")
        sign = _compare(kind, value, other)
        return None if sign is None else _ORDER_TESTS[operator.removeprefix(kind)](sign)

    def _matches(self, text: str, pattern: str) -> bool | None:
        matches = find_matches(pattern, text)
        if matches is None:
            return None
        if matches:
            groups = [matches[0][0], *matches[0][1]]
            self.variables.update({f"CMAKE_MATCH_{index}": group for index, group in enumerate(groups)})
        return bool(matches)

    def _get_value(self, word: Word) -> str:
        return word.text if word.is_quoted else self.variables.get(word.text, word.text)

    def _evaluate_word(self, word: Word) -> bool | None:
        if is_open(word.text):
            return None
        constant = _evaluate_constant(word.text)
        if constant is not None or word.is_quoted:
            return bool(constant)
        value = self.variables.get(word.text)
        if value is None or is_open(value):
            return None
        return _evaluate_constant(value) is not False


def find_matches(pattern: str, text: str) -> list[tuple[str, list[str]]] | None:
    """Return all matches of a CMake regular expression, each with its groups.

    The result is None if the expression is not valid or takes too long to match.
    """
    import regex

    try:
        matches = regex.finditer(pattern, text, timeout=_SEARCH_TIMEOUT_S)
        return [(match[0], [group or "" for group in match.groups()]) for match in matches]
    except (regex.error, TimeoutError, RecursionError):
        return None


def _evaluate_constant(text: str) -> bool | None:
    upper = text.upper()
    if upper in TRUE_CONSTANTS or (_NUMBER.fullmatch(upper) and float(upper)):
        return True
    if upper in _FALSE_CONSTANTS or upper.endswith("-NOTFOUND") or _NUMBER.fullmatch(upper):
        return False
    return None


def _compare(kind: str, left: str, right: str) -> int | None:
    if kind == "STR":
        return (left > right) - (left < right)
    if kind == "VERSION_":
        versions = [[int(part) for part in re.findall(r"\d+", text)] for text in (left, right)]
        max_length = max(len(parts) for parts in versions)
        first, second = ([*parts, *[0] * (max_length - len(parts))] for parts in versions)
        return (first > second) - (first < second)
    if not _NUMBER.fullmatch(left) or not _NUMBER.fullmatch(right):
        return None
    return (float(left) > float(right)) - (float(left) < float(right))
