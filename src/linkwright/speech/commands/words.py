"""Split texts into words, normalised across engines: case, punctuation, blanks between Chinese characters."""

from __future__ import annotations

import re
import unicodedata

Words = tuple[str, ...]
"""The words of a text: a number in digits, a word, or one Chinese character each."""

_HAN = "\u3007\u3400-\u4dbf\u4e00-\u9fff"
_WORD = re.compile(rf"\d+(?:\.\d+)?|[{_HAN}]|(?:(?![{_HAN}])[^\W\d_])+(?:['’][^\W\d_]+)*|°")


def words_of(text: str) -> Words:
    """Split a text into words.

    For example, ``Turn left, 90°!`` becomes turn, left, 90, °, and ``左转 九十度`` becomes 左, 转, 九, 十, 度.
    """
    return tuple(_WORD.findall(unicodedata.normalize("NFKC", text).lower().replace("’", "'")))


def has_words(words: Words, wanted: Words) -> bool:
    """Return whether a text contains the wanted words in this order without gaps."""
    length = len(wanted)
    return any(words[at : at + length] == wanted for at in range(len(words) - length + 1))
