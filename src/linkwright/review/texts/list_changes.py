"""Write changed values in one line: both values, or the added and removed items of lists."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.texts.excerpts import LONG_VALUE, differing_excerpts
from linkwright.review.texts.word_changes import compare_words

EMPTY = "''"
"""An empty value as users write it."""
_LONG_LIST = 4
"""The maximum number of items of lists that are shown in full, unless they are too long."""
_MANY_NUMBERS = 16
"""The maximum number of items of lists that a reader can compare."""
_MAX_CHANGED_ITEMS = 8
"""The maximum number of changed items of a long list that are shown alone."""
_OPTION = re.compile(r"--?[A-Za-z][\w-]*")
"""An option of a command line, such as ``-z``."""
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"(?:\$\((?:[^()]|\([^()]*\))*\)|\S)+")
"""A word of a line, in which a substitution such as ``$(var side)`` may have blanks."""
_LONG_NAME = 120
"""The maximum number of characters of a list item that is shown in full."""


def change_text(name: Phrase | str, old: str, new: str) -> Phrase:
    """Return the change in a value in one line.

    Args:
        name: the name of the value.
        old: the old value. A list has the form ``[a, b]``.
        new: the new value.
    """
    words = compare_words(old, new) if max(len(old), len(new)) > LONG_VALUE else None
    if words is not None:
        return phrase("{parameter}: {changes}", parameter=name, changes=words)
    old_items, new_items = nested_list_items(old), nested_list_items(new)
    are_lists = all(value.startswith("[") and items != [value] for value, items in ((old, old_items), (new, new_items)))
    are_names = are_lists and all(len(item) <= _LONG_NAME for item in (*old_items, *new_items))
    is_cut = are_names and max(len(old), len(new)) > LONG_VALUE
    old, new = differing_excerpts(old, new)
    added, removed = set(new_items) - set(old_items), set(old_items) - set(new_items)
    is_set = len(set(old_items)) == len(old_items) and len(set(new_items)) == len(new_items)
    is_short = min(len(old_items), len(new_items)) <= _LONG_LIST and not is_cut
    has_order = are_lists and all(map(_NUMBER.fullmatch, (*old_items, *new_items)))
    if is_short or has_order or not is_set or not (added or removed):
        is_long = is_cut or min(len(old_items), len(new_items)) > _MANY_NUMBERS
        changes = _find_changed_items(old_items, new_items) if is_long else []
        if changes:
            return phrase("{parameter}: {changes}", parameter=name, changes=joined(changes))
        return phrase("{parameter} {old} -> {new}", parameter=name, old=old, new=new)
    option_change = _find_changed_option(old_items, new_items)
    if option_change is not None:
        return phrase("{parameter}: {changes}", parameter=name, changes=option_change)
    added_text = ", ".join(item for item in new_items if item in added)
    removed_text = ", ".join(item for item in old_items if item in removed)
    if not removed:
        return phrase("{parameter}: {items} added", parameter=name, items=added_text)
    if not added:
        return phrase("{parameter}: {items} removed", parameter=name, items=removed_text)
    return phrase(
        "{parameter}: {added} added, {removed} removed", parameter=name, added=added_text, removed=removed_text
    )


def _find_changed_option(old: list[str], new: list[str]) -> str | None:
    """Return the option of a command line whose value is the only difference, with both values, or None."""
    changed = _find_changed_numbers(old, new)
    number = changed[0] if len(changed) == 1 else 0
    is_option = number > 0 and _OPTION.fullmatch(new[number - 1]) and not _OPTION.fullmatch(new[number])
    return f"{new[number - 1]} {old[number]} -> {new[number]}" if is_option else None


def _find_changed_items(old: list[str], new: list[str]) -> list[str]:
    """Return the items that differ between two lists of the same length; none if there are many."""
    changed = _find_changed_numbers(old, new)
    if len(changed) > _MAX_CHANGED_ITEMS:
        return []
    return [f"[{number}] {old[number]} -> {new[number]}" for number in changed]


def _find_changed_numbers(old: list[str], new: list[str]) -> list[int]:
    """Return the indexes of the items that differ between two lists of the same length; none for other lists."""
    return [number for number, item in enumerate(new) if len(old) == len(new) and item != old[number]]


def list_items(text: str) -> list[str]:
    """Return the items of a flat list, or the value itself."""
    is_list = text.startswith("[") and text.endswith("]")
    content = text[1:-1] if is_list else text
    if not is_list or set(content) & set("[]{}"):
        return [text]
    return [item.strip() for item in _split_at_commas(content) if item.strip()]


def split_command(text: str) -> list[str]:
    """Return the words of a command line, which is the text of a flat list or of a line."""
    return list_items(text) if text.startswith("[") else _WORD.findall(text)


def nested_list_items(text: str) -> list[str]:
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
