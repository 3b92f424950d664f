"""Compare long texts word by word, such as command lines and the topics of a recording."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from difflib import SequenceMatcher

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.changes import MAX_NAMES

_MIN_WORDS = 4
_MAX_WORDS = 2000
_MAX_WORD_LENGTH = 120
"""The maximum number of characters of a word that is shown in full."""
_MIN_COMMON_SHARE = 0.5
"""The minimum share of common words of texts that are compared word by word."""


def compare_words(old: str, new: str) -> Phrase | None:
    """Return the replaced, added and removed words of a text.

    The result is None for texts that are not lists of words.

    Args:
        old: the old text.
        new: the new text.
    """
    old_words, new_words = _split_words(old), _split_words(new)
    if not (_are_comparable(old_words) and _are_comparable(new_words)):
        return None
    added, removed = Counter(new_words) - Counter(old_words), Counter(old_words) - Counter(new_words)
    count = max(len(old_words), len(new_words))
    if not (added or removed) or count - max(added.total(), removed.total()) < count * _MIN_COMMON_SHARE:
        return None
    pairs = []
    for kind, a, b, c, d in SequenceMatcher(None, old_words, new_words, autojunk=False).get_opcodes():
        if kind == "replace" and b - a == d - c:
            pairs += [(x, y) for x, y in zip(old_words[a:b], new_words[c:d], strict=True) if removed[x] and added[y]]
    for old_word, new_word in pairs:
        removed[old_word] -= 1
        added[new_word] -= 1
    texts = [phrase("{old} -> {new}", old=before, new=after) for before, after in dict.fromkeys(pairs)]
    parts = [joined_first(texts, MAX_NAMES)] if texts else []
    if added.total():
        parts.append(phrase("{items} added", items=_join_words(added, new_words)))
    if removed.total():
        parts.append(phrase("{items} removed", items=_join_words(removed, old_words)))
    return joined(parts, "; ")


def _join_words(counts: Counter[str], words: Iterable[str]) -> Phrase:
    return joined_first([word for word in dict.fromkeys(words) if counts[word] > 0], MAX_NAMES)


def _are_comparable(words: Sequence[str]) -> bool:
    """Return whether words are mostly not numeric, and contain no nested lists or code."""
    named = [word for word in words if any(map(str.isalpha, word))]
    is_short = all(len(word) <= _MAX_WORD_LENGTH for word in words)
    return _MIN_WORDS <= len(words) <= _MAX_WORDS and is_short and 2 * len(named) > len(words)


def _split_words(text: str) -> list[str]:
    """Return the words of a text.

    A substitution is not split. The result is empty for a list in brackets.
    """
    if text.startswith(("[", "{")):
        return []
    words, start, depth = [], 0, 0
    for index, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if character.isspace() and depth <= 0:
            words.append(text[start:index])
            start = index + 1
    return [word for word in [*words, text[start:]] if word]
