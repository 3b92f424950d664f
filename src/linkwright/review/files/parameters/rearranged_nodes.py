"""Arrange an old YAML document like the new one, whose list or entries only have other keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.files.parameters.yaml_lists import find_item_labels, format_content
from linkwright.review.files.parameters.yaml_values import find_item_name, is_structured_list

_MIN_ENTRIES = 3
"""The minimum number of entries with other keys."""
_MIN_SHARE = 0.5
"""The minimum share of the items of a moved list that the new list has."""


class Rearrangement(NamedTuple):
    """A change of the arrangement, with its place in the new document."""

    text: Phrase
    node: yaml.Node


def arrange_like(old: yaml.Node, new: yaml.Node) -> tuple[yaml.Node, list[Rearrangement]]:
    """Return an old document with the keys of the new one, and what differs in the arrangement.

    A list that is the root moves below the only list of the new root. Numbered entries of a mapping that have each
    other's contents get the new numbers.

    Args:
        old: the old document.
        new: the new document.
    """
    changes: list[Rearrangement] = []
    lists = [(key, value) for key, value in new.value if is_structured_list(value)] if _is_mapping(new) else []
    if is_structured_list(old) and len(lists) == 1 and _has_most_items(old, lists[0][1]):
        key, node = lists[0]
        changes.append(Rearrangement(phrase("the list moved to {name}", name=str(key.value)), node))
        old = yaml.MappingNode(old.tag, [(key, old)], old.start_mark, old.end_mark)
    return _exchange_keys(old, new, "", changes), changes


def _is_mapping(node: yaml.Node) -> bool:
    return isinstance(node, yaml.MappingNode)


def _has_most_items(old: yaml.Node, new: yaml.Node) -> bool:
    """Return whether a list has items like most of those of another one."""
    labels = find_item_labels(old, new)
    new_labels = {labels.get(id(item)) for item in new.value} - {None}
    return sum(labels.get(id(item)) in new_labels for item in old.value) >= _MIN_SHARE * len(old.value)


def _exchange_keys(old: yaml.Node, new: yaml.Node, path: str, changes: list[Rearrangement]) -> yaml.Node:
    """Return a mapping in which numbered entries with the contents of others have the numbers of these."""
    if not isinstance(old, yaml.MappingNode) or not isinstance(new, yaml.MappingNode):
        return old
    exchanged = _find_exchanged(old, new)
    if exchanged:
        names = [
            f"{find_item_name(value) or ''} {key.value} -> {exchanged[str(key.value)].value}".strip()
            for key, value in old.value
            if exchanged[str(key.value)].value != key.value
        ]
        entries = joined_first(names, MAX_NAMES)
        text = phrase("entries of {name} renumbered: {entries}", name=path, entries=entries)
        changes.append(Rearrangement(text, new))
        values = [(exchanged[str(key.value)], value) for key, value in old.value]
        return yaml.MappingNode(old.tag, values, old.start_mark, old.end_mark)
    new_values = {str(key.value): value for key, value in new.value}
    values = [
        (key, _exchange_keys(value, new_values[name], f"{path}.{name}".lstrip("."), changes))
        if (name := str(key.value)) in new_values
        else (key, value)
        for key, value in old.value
    ]
    return yaml.MappingNode(old.tag, values, old.start_mark, old.end_mark)


def _find_exchanged(old: yaml.MappingNode, new: yaml.MappingNode) -> Mapping[str, yaml.Node]:
    """Return the new key of each entry by its old one, if the same keys have each other's contents; else nothing."""
    entries = list(_read_entries(old)), list(_read_entries(new))
    if len(entries[0]) < _MIN_ENTRIES or {name for name, _, _ in entries[0]} != {name for name, _, _ in entries[1]}:
        return {}
    keys = {text: key for _, key, text in entries[1]}
    texts = [text for _, _, text in entries[0]]
    if len(keys) < len(texts) or set(texts) != keys.keys():
        return {}
    result = {name: keys[text] for name, _, text in entries[0]}
    return result if sum(str(key.value) != name for name, key in result.items()) >= _MIN_ENTRIES else {}


def _read_entries(node: yaml.MappingNode) -> Iterator[tuple[str, yaml.Node, str]]:
    """Yield the entries of a mapping of numbers to mappings: the name, the key and the contents as text."""
    if all(_is_mapping(value) and value.value and str(key.value).isdecimal() for key, value in node.value):
        texts: dict[int, str] = {}
        yield from ((str(key.value), key, format_content(value, texts)) for key, value in node.value)
