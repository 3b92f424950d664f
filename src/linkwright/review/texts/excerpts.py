"""Shorten long texts: keep what differs between two texts, or the beginning and the end of one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import NamedTuple

LONG_VALUE = 200
"""The maximum number of characters of a value that is shown in full."""
_CONTEXT = 20
"""The number of characters that are shown on both sides of a difference."""
_MAX_WORD = 40
"""The number of characters in which the boundary of a word is searched."""
_MIN_OMITTED = 12
"""The minimum number of characters that an ellipsis replaces."""
_MAX_DIFFERENCE = 400
"""The maximum number of characters of one difference that are shown."""
_MAX_EXCERPT = 900
"""The number of characters after which no further difference is shown."""
_MAX_TOKENS = 3000
_SEPARATORS = (", ", "; ", "，", "；", "、")
"""The separators of items, in English and Chinese."""
_FRAME = re.compile(r"([#*=~+_-])\1{7,}|(?<!\S)[#*|](?!\S)")
"""A line of one character, as around a warning, or such a character alone."""
_TOKEN = re.compile(r"\w+|\s+|[^\w\s]")


class _Part(NamedTuple):
    """A part of two texts: the old and the new text, which are equal for a common part."""

    old: str
    new: str

    @property
    def is_common(self) -> bool:
        return self.old == self.new


def shorten(text: str, limit: int) -> str:
    """Return a text, cut after a whole item or word if it is longer than a number of characters."""
    if len(text) <= limit:
        return text
    end, separator = max((text.rfind(separator, limit // 2, limit), separator) for separator in _SEPARATORS)
    if end > 0:
        return f"{text[:end]}{separator.rstrip()} ..."
    end = text.rfind(" ", limit // 2, limit)
    return f"{text[:end]} ..." if end > 0 else f"{text[:limit]}..."


def shorten_middle(text: str, limit: int) -> str:
    """Return a text with its beginning and its end, if it is longer than a number of characters.

    Frames of characters around a long text are left out.
    """
    if len(text) > limit:
        text = " ".join(_FRAME.sub(" ", text).split())
    if len(text) <= limit:
        return text
    length = limit // 2
    result = f"{_cut_end(text, length)} ... {_cut_start(text, length)}"
    return result if len(result) < len(text) else text


def differing_excerpts(old: str, new: str, limit: int = LONG_VALUE) -> tuple[str, str]:
    """Return two values, or only their differing parts with some context if one is long.

    Every difference is shown, except in texts with very many of them.

    Args:
        old: the old value.
        new: the new value.
        limit: the maximum number of characters of a value that is shown in full.
    """
    if max(len(old), len(new)) <= limit:
        return old, new
    parts = [inner for part in _split(old, new) for inner in _split_long(part)]
    excerpts = ["", ""]
    for index, part in enumerate(parts):
        if max(map(len, excerpts)) > _MAX_EXCERPT:
            excerpts = [f"{text} ..." for text in excerpts]
            break
        if not part.is_common:
            excerpts = [
                text + shorten_middle(piece, _MAX_DIFFERENCE) for text, piece in zip(excerpts, part, strict=True)
            ]
        else:
            common = _omit_middle(part.old, is_first=index == 0, is_last=index == len(parts) - 1)
            excerpts = [text + common for text in excerpts]
    return excerpts[0].strip(), excerpts[1].strip()


def _split(old: str, new: str) -> Iterator[_Part]:
    """Yield the parts of two texts, common and differing ones in turn."""
    old_tokens, new_tokens = _TOKEN.findall(old), _TOKEN.findall(new)
    if max(len(old_tokens), len(new_tokens)) > _MAX_TOKENS:
        yield from _split_once(old, new)
        return
    pending = _Part("", "")
    operations = SequenceMatcher(None, old_tokens, new_tokens, autojunk=False).get_opcodes()
    for number, (kind, a, b, c, d) in enumerate(operations):
        part = _Part("".join(old_tokens[a:b]), "".join(new_tokens[c:d]))
        is_inside = 0 < number < len(operations) - 1
        if kind == "equal" and not (is_inside and len(part.old) < 2 * _CONTEXT + _MIN_OMITTED):
            if pending.old or pending.new:
                yield pending
            yield part
            pending = _Part("", "")
        else:
            pending = _Part(pending.old + part.old, pending.new + part.new)
    if pending.old or pending.new:
        yield pending


def _split_long(part: _Part) -> Iterator[_Part]:
    """Yield a part, or the parts of a long difference whose beginning or end is common."""
    if part.is_common or max(map(len, part)) <= _MAX_DIFFERENCE:
        yield part
    else:
        yield from (inner for inner in _split_once(*part) if any(inner))


def _split_once(old: str, new: str) -> Iterator[_Part]:
    """Yield the common beginning, the rest and the common end of two texts."""
    common = min(len(old), len(new))
    start = next((index for index in range(common) if old[index] != new[index]), common)
    max_end = common - start
    end = next((index for index in range(max_end) if old[-1 - index] != new[-1 - index]), max_end)
    yield _Part(old[:start], new[:start])
    yield _Part(old[start : len(old) - end], new[start : len(new) - end])
    yield _Part(old[len(old) - end :], new[len(new) - end :])


def _omit_middle(text: str, *, is_first: bool, is_last: bool) -> str:
    """Return a common part with the context of the differences before and after it."""
    before = "" if is_first else _cut_end(text, _CONTEXT)
    after = "" if is_last else _cut_start(text, _CONTEXT)
    if len(before) + len(after) + _MIN_OMITTED > len(text):
        return text
    return f"{before} ... {after}"


def _cut_end(text: str, length: int) -> str:
    """Return the beginning of a text, at least a number of characters, to the end of a word if possible."""
    ends = range(length, min(len(text), length + _MAX_WORD))
    near_ends = ends[:_CONTEXT]
    end = next((end for end in near_ends if text[end] == " "), None) or next(
        (end for end in ends if not _is_in_word(text, end)), length
    )
    return text[:end].rstrip()


def _cut_start(text: str, length: int) -> str:
    """Return the end of a text, at least a number of characters, from the start of a word if possible."""
    first = max(0, len(text) - length)
    starts = range(first, max(0, first - _MAX_WORD), -1)
    near_starts = starts[:_CONTEXT]
    start = next((start for start in near_starts if text[start - 1] == " "), None) or next(
        (start for start in starts if not _is_in_word(text, start)), first
    )
    return text[start:].lstrip()


def _is_in_word(text: str, index: int) -> bool:
    """Return whether the characters before and at an index belong to one word."""
    return all(character.isalnum() or character == "_" for character in text[index - 1 : index + 1])
