"""Find the texts with which a source newly says that something is deprecated."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.texts.excerpts import shorten_middle

_TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'')
_MARK = re.compile(r"\bdepr(?:ec|ic|eci)at|\bwill be removed\b|\bno longer supported\b", re.IGNORECASE)
_ATTRIBUTE = re.compile(r"\[\[\s*deprecated\s*\(\s*(?P<text>\"(?:\\.|[^\"\\\n])*\")")
_MAX_TEXTS = 4
_MAX_CHARACTERS = 160


def find_deprecations(old: str, new: str, *, is_cpp: bool) -> Iterator[tuple[Phrase, int]]:
    """Yield a sentence with the new texts about deprecated things, and the line of the first one.

    Args:
        old: the old source.
        new: the new source.
        is_cpp: whether they are sources of C++.
    """
    if _MARK.search(new) is None and "[[deprecated" not in new:
        return
    before, after = (dict(_list_texts(blank_comments(text) if is_cpp else text)) for text in (old, new))
    added = [text for text in after if text not in before]
    if added:
        shown = joined_first([shorten_middle(text, _MAX_CHARACTERS) for text in added], _MAX_TEXTS)
        line = new.count("\n", 0, after[added[0]]) + 1
        yield phrase("new texts about deprecated things: {texts}", texts=shown), line


def _list_texts(source: str) -> Iterator[tuple[str, int]]:
    """Yield the texts about deprecated things, each with its offset."""
    attributes = {match.start("text") for match in _ATTRIBUTE.finditer(source)}
    for match in _TEXT.finditer(source):
        if match.start() in attributes or _MARK.search(match[0]):
            yield f"'{match[0][1:-1]}'", match.start()
