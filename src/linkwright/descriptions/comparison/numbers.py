"""Normalize texts, so that equal numbers have the same form."""

from __future__ import annotations

import math

from linkwright.loading.deferred import lazy_pattern

_NUMBER = lazy_pattern(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


def normalize_numbers(text: str) -> str:
    """Return a text with single spaces and normalized numbers.

    For example, ``1.0`` becomes ``1``, and ``-0`` becomes ``0``.
    """
    return " ".join(map(_normalize_word, text.split()))


def _normalize_word(word: str) -> str:
    if not _NUMBER.fullmatch(word):
        return word
    number = float(word)
    return repr(number + 0.0) if math.isfinite(number) else word
