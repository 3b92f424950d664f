"""Bytes as a row of decisions, from which a grammar makes a document.

A coverage-guided fuzzer changes bytes; when each byte decides one thing, a small change of the bytes is a small change
of the document.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

_T = TypeVar("_T")


class Choices:
    """Takes decisions from bytes; once they are used up, every decision is for the first alternative."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    @property
    def left(self) -> int:
        """Return the number of remaining bytes."""
        return len(self._data) - self._at

    def number(self, below: int) -> int:
        """Return a number from 0 up to a bound."""
        if self._at >= len(self._data):
            return 0
        value = self._data[self._at]
        self._at += 1
        return value % below

    def pick(self, alternatives: Sequence[_T]) -> _T:
        """Return one of some alternatives; the first one should be the simplest."""
        return alternatives[self.number(len(alternatives))]

    def chance(self, of: int) -> bool:
        """True in one of so many cases, and never when the bytes are used up."""
        return self.number(of) == of - 1

    def rest(self) -> bytes:
        """Return all remaining bytes."""
        taken = self._data[self._at :]
        self._at = len(self._data)
        return taken
