"""Find the parts of parameter files whose plugin was replaced. The other values of such a part belong to its plugin."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.files.parameters.value_changes import ValueChange
from linkwright.review.files.parameters.yaml_values import YamlValue

_CLASS_KEYS = ("plugin", "type")
_CLASS = re.compile(r"\w+(?:(?:/|::)\w+)+")
_SEPARATOR = re.compile(r"/|::")
_MAX_REMOVED_NAMES = 10
"""The maximum number of names of removed parameters, which nothing reads any more."""
_MIN_CHANGES = 2


def find_replaced_classes(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> frozenset[str]:
    """Return the paths of the parts that name another class in the new version.

    Args:
        old: the old values by path.
        new: the new values by path.
    """
    names = (name for name, value in new.items() if name in old and _is_replaced(name, old[name].text, value.text))
    return frozenset(name.rpartition(".")[0] for name in names)


def is_below_any(name: str, parts: Collection[str]) -> bool:
    """Return whether a value is inside one of some parts."""
    return any(name.startswith(f"{part}.") for part in parts)


def join_replaced_classes(changes: Iterable[ValueChange]) -> Iterator[ValueChange]:
    """Yield the changes with the added and removed values of replaced classes in the line of the class.

    Breaking changes keep their own lines.
    """
    known = list(changes)
    replaced = [change for change in known if change.kind == "changed" and _is_replaced(change.name, *change.values)]
    owners = {change.name.rpartition(".")[0]: change for change in replaced}
    joined: dict[str, list[ValueChange]] = {part: [] for part in owners}
    for change in known:
        part = max((part for part in owners if change.name.startswith(f"{part}.")), key=len, default=None)
        if part is not None and change.kind != "changed" and change.reason is None:
            joined[part].append(change)
    joined = {part: parts for part, parts in joined.items() if len(parts) >= _MIN_CHANGES}
    left_out = {id(change) for parts in joined.values() for change in parts}
    notes = {id(owners[part]): _describe_parts(part, parts) for part, parts in joined.items()}
    for change in known:
        if id(change) not in left_out:
            yield replace(change, note=notes[id(change)]) if id(change) in notes else change


def _is_replaced(name: str, old: str, new: str) -> bool:
    """Return whether a value is a class, and another one than before. Its package and its notation may change."""
    part, _, key = name.rpartition(".")
    is_class = bool(part) and key in _CLASS_KEYS and all(map(_CLASS.fullmatch, (old, new)))
    return is_class and _SEPARATOR.split(old)[-1] != _SEPARATOR.split(new)[-1]


def _describe_parts(part: str, changes: Sequence[ValueChange]) -> Phrase:
    """Return the added parameters of the new class and the removed parameters of the old one."""
    removed = [change.name.removeprefix(f"{part}.") for change in changes if change.kind == "removed"]
    added: list[str] = []
    for change in changes:
        name = change.name.removeprefix(f"{part}.")
        if change.kind == "added":
            is_group = len(change.values) > 1
            added += [f"{name}.{value}" if is_group else f"{name} {value}" for value in change.values]
    added_items, removed_items = joined_first(added, MAX_NAMES), joined_first(removed, _MAX_REMOVED_NAMES)
    if added and removed:
        return phrase("parameters added: {added}; removed: {removed}", added=added_items, removed=removed_items)
    if added:
        return phrase("parameters added: {items}", items=added_items)
    return phrase("parameters removed: {items}", items=removed_items)
