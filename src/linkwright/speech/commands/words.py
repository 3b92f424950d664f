"""Texts as words, independent of case, punctuation and spaces between Chinese characters."""

from __future__ import annotations

import re
import unicodedata

Words = tuple[str, ...]
"""The words of a text. A word consists of letters, of digits, or of one Chinese character."""

_HAN = "\u3007\u3400-\u4dbf\u4e00-\u9fff"
_WORD_PATTERN = re.compile(rf"\d+(?:\.\d+)?|[{_HAN}]|(?:(?![{_HAN}])[^\W\d_])+(?:['’][^\W\d_]+)*|°")


def split_into_words(text: str) -> Words:
    """Split a text into words.

    For example, ``Turn left, 90°!`` becomes turn, left, 90, °, and ``左转 九十度`` becomes 左, 转, 九, 十, 度.
    """
    return tuple(_WORD_PATTERN.findall(unicodedata.normalize("NFKC", text).lower().replace("’", "'")))


def has_words(words: Words, sequence: Words) -> bool:
    """Return whether words contain a sequence of words without gaps."""
    length = len(sequence)
    return any(words[start : start + length] == sequence for start in range(len(words) - length + 1))
