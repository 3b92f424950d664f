"""Normalize texts, so that equal numbers have the same form."""

from __future__ import annotations

import math

from linkwright.loading.deferred import lazy_pattern

_NUMBER = lazy_pattern(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

_DIGITS = 14
"""The number of digits to compare and to show. Sums of 64-bit numbers differ in the digits behind them."""
_MIN_REMOVED = 5
"""The minimum number of characters, such as zeros, that a rounded number saves. Others are shown as written."""


def normalize_numbers(text: str) -> str:
    """Return a text with single spaces and normalized numbers.

    For example, ``1.0`` becomes ``1``, ``-0`` becomes ``0``, and ``0.30000000000000004`` becomes ``0.3``.
    """
    return " ".join(map(_normalize_word, text.split()))


def round_numbers(text: str) -> str:
    """Return a text with single spaces, without the last digits of numbers that a computation has added."""
    pairs = ((word, _round_word(word) if len(word) > _DIGITS else word) for word in text.split())
    return " ".join(rounded if len(word) - len(rounded) >= _MIN_REMOVED else word for word, rounded in pairs)


def _normalize_word(word: str) -> str:
    if not _NUMBER.fullmatch(word):
        return word
    number = float(_round_word(word))
    return repr(number + 0.0) if math.isfinite(number) else word


def _round_word(word: str) -> str:
    return f"{float(word):.{_DIGITS}g}" if "." in word and _NUMBER.fullmatch(word) else word
