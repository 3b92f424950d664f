"""Find mappings of YAML files whose keys end in numbers, such as ``filter3``, and that have other numbers now."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise

from linkwright.diagnostics import phrase
from linkwright.review.changes import Change, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.names import index_parts, list_part_paths
from linkwright.review.files.parameters.renamed_parts import rename_parts
from linkwright.review.files.parameters.yaml_values import YamlValue

_NUMBERED = re.compile(r"(?P<stem>.*[^\d.])\d+")
"""The path of a mapping whose key ends in a number."""
_DIGITS = "0123456789"
_MIN_EQUAL = 2
"""The minimum number of mappings with equal values and another number by which new numbers are recognized."""
_Contents = dict[str, tuple[tuple[str, str], ...]]
"""The names and values in mappings, by path."""


def _find_renumbered_parts(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the new paths of numbered mappings that follow each other as before, by old path.

    An old mapping that is gone, but whose number another one has now, gets a path that no other mapping has.

    Args:
        old: the old values by path.
        new: the new values by path.
    """
    renumbered: dict[str, str] = {}
    new_groups = _group_numbered(new)
    for stem, parts in _group_numbered(old).items():
        renumbered |= _match(parts, new_groups.get(stem, {}))
    inner = {part for part in renumbered if not renumbered.keys().isdisjoint(list_part_paths(part)[:-1])}
    return {part: name for part, name in renumbered.items() if part not in inner}


def report_renumbered_parts(
    pair: FilePair, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]
) -> dict[str, YamlValue]:
    """Report the mappings with new numbers, a line for each group; return the old values with the new paths."""
    renumbered = _find_renumbered_parts(old, new)
    groups: dict[str, list[tuple[str, str]]] = {}
    first_values = index_parts(new)
    for part, name in renumbered.items():
        if name in first_values:
            groups.setdefault(part.rstrip(_DIGITS), []).append((part, name))
    for (part, name), *others in groups.values():
        value = new[first_values[name]]
        text = phrase("{old} renamed to {name}", old=part, name=name)
        other_names = tuple(f"{_get_key(other)} -> {_get_key(other_name)}" for other, other_name in others)
        location = Location(pair.new_path, value.line, value.column)
        pair.changes.append(Change(text, location=location, other_names=other_names))
    return rename_parts(old, renumbered)


def _get_key(part: str) -> str:
    return part.rpartition(".")[2]


def _group_numbered(values: Mapping[str, YamlValue]) -> dict[str, _Contents]:
    """Return the numbered mappings of at least two values, in their order, by their path without the number."""
    parts: dict[str, list[tuple[str, str]]] = {}
    for name, value in values.items():
        for part in list_part_paths(name)[:-1]:
            if _NUMBERED.fullmatch(part):
                parts.setdefault(part, []).append((name.removeprefix(part), value.text))
    groups: dict[str, _Contents] = {}
    for part, items in parts.items():
        if len(items) > 1:
            groups.setdefault(part.rstrip(_DIGITS), {})[part] = tuple(items)
    return groups


def _match(old: _Contents, new: _Contents) -> dict[str, str]:
    """Return the new paths of the mappings of a group.

    Mappings with equal values keep their order, or else a number may be the name of a thing. A changed mapping is the
    one that follows the same mapping in both versions.
    """
    places = {items: part for part, items in new.items()}
    pairs = {part: places[items] for part, items in old.items() if items in places}
    if len(places) < len(new) or len(set(old.values())) < len(old) or _are_rearranged(list(pairs.values()), list(new)):
        return {}
    if sum(part != new_part for part, new_part in pairs.items()) < _MIN_EQUAL:
        return {}
    followers = dict(pairwise(("", *new)))
    taken = set(pairs.values())
    for previous, part in pairwise(("", *old)):
        follower = followers.get(pairs.get(previous, previous))
        if part not in pairs and follower is not None and follower not in taken:
            pairs[part] = follower
            taken.add(follower)
    lost = {part: f"{part} (old)" for part in old if part not in pairs and part in taken}
    return {part: name for part, name in (pairs | lost).items() if part != name}


def _are_rearranged(parts: list[str], order: list[str]) -> bool:
    indexes = [order.index(part) for part in parts]
    return indexes != sorted(indexes)
