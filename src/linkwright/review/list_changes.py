"""Write changed values in one line: both values, or the added and removed items of lists."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.word_changes import compare_words

EMPTY = "''"
"""An empty value as users write it."""
_LONG_LIST = 4
"""The maximum number of items of lists that are shown in full, unless they are too long."""
_LONG_VALUE = 200
"""The maximum number of characters of a value that is shown in full."""
_LONG_NAME = 120
"""The maximum number of characters of a list item that is shown in full."""
_CONTEXT = 20
"""The number of characters that are shown on both sides of a difference."""


def change_text(name: Phrase | str, old: str, new: str) -> Phrase:
    """Return the change in a value in one line.

    Args:
        name: the name of the value.
        old: the old value. A list has the form ``[a, b]``.
        new: the new value.
    """
    words = compare_words(old, new) if max(len(old), len(new)) > _LONG_VALUE else None
    if words is not None:
        return phrase("{parameter}: {changes}", parameter=name, changes=words)
    old_items, new_items = _split_nested_list(old), _split_nested_list(new)
    are_lists = all(value.startswith("[") and items != [value] for value, items in ((old, old_items), (new, new_items)))
    are_names = are_lists and all(len(item) <= _LONG_NAME for item in (*old_items, *new_items))
    is_cut = are_names and max(len(old), len(new)) > _LONG_VALUE
    old, new = differing_excerpts(old, new)
    added, removed = set(new_items) - set(old_items), set(old_items) - set(new_items)
    is_set = len(set(old_items)) == len(old_items) and len(set(new_items)) == len(new_items)
    is_short = min(len(old_items), len(new_items)) <= _LONG_LIST and not is_cut
    if is_short or not is_set or not (added or removed):
        return phrase("{parameter} {old} -> {new}", parameter=name, old=old, new=new)
    added_text = ", ".join(item for item in new_items if item in added)
    removed_text = ", ".join(item for item in old_items if item in removed)
    if not removed:
        return phrase("{parameter}: {items} added", parameter=name, items=added_text)
    if not added:
        return phrase("{parameter}: {items} removed", parameter=name, items=removed_text)
    return phrase(
        "{parameter}: {added} added, {removed} removed", parameter=name, added=added_text, removed=removed_text
    )


def shorten(text: str, limit: int) -> str:
    """Return a text, cut after a whole item if it is longer than a number of characters."""
    if len(text) <= limit:
        return text
    item_end, word_end = text.rfind(", ", limit // 2, limit), text.rfind(" ", limit // 2, limit)
    if item_end > 0:
        return f"{text[:item_end]}, ..."
    return f"{text[:word_end]} ..." if word_end > 0 else f"{text[:limit]}..."


def differing_excerpts(old: str, new: str) -> tuple[str, str]:
    """Return two values, or only their differing parts if they are long."""
    if max(len(old), len(new)) <= _LONG_VALUE:
        return old, new
    common = min(len(old), len(new))
    start = next((index for index in range(common) if old[index] != new[index]), common)
    max_end = common - start
    end = next((index for index in range(max_end) if old[-1 - index] != new[-1 - index]), max_end)
    return _cut_excerpt(old, start, len(old) - end), _cut_excerpt(new, start, len(new) - end)


def _cut_excerpt(text: str, start: int, end: int) -> str:
    """Return a part of a text with some context.

    The result starts at the beginning of a word if possible.
    """
    first = max(0, start - _CONTEXT)
    first = text.rfind(" ", max(0, first - _CONTEXT), first) + 1 or first
    last = min(len(text), end + _CONTEXT, first + _LONG_VALUE)
    near = text.find(" ", last, last + _CONTEXT)
    last = near if near >= 0 else last
    return f"{'... ' if first else ''}{text[first:last]}{' ...' if last < len(text) else ''}"


def list_items(text: str) -> list[str]:
    """Return the items of a flat list, or the value itself."""
    is_list = text.startswith("[") and text.endswith("]")
    content = text[1:-1] if is_list else text
    if not is_list or set(content) & set("[]{}"):
        return [text]
    return [item.strip() for item in _split_at_commas(content) if item.strip()]


def _split_nested_list(text: str) -> list[str]:
    """Return the items of a list, which may contain lists, or the value itself."""
    if not (text.startswith("[") and text.endswith("]")):
        return [text]
    return [item.strip() for item in _split_at_commas(text[1:-1], "([{", ")]}") if item.strip()]


def _split_at_commas(text: str, opening: str = "(", closing: str = ")") -> list[str]:
    """Split a text at the commas outside of parentheses."""
    parts, start, depth = [], 0, 0
    for index, character in enumerate(text):
        depth += (character in opening) - (character in closing)
        if character == "," and depth <= 0:
            parts.append(text[start:index])
            start = index + 1
    return [*parts, text[start:]]
