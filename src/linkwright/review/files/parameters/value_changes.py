"""Merge equal changed values, and summarize many changes in a list."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.files.parameters.value_vectors import Component, describe_items, find_component
from linkwright.review.texts.list_changes import change_text
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.merging import name_edit

_ITEM = re.compile(r"(?P<list>[^\[]*)\[(?:old )?\d+\]")
"""The path of a list item without a name."""
_ITEM_NAME = re.compile(r"(?P<list>.+)\[(?P<label>[^\[\]]+)\]\.(?P<key>\w+)")
"""The path of a value directly in a list item."""
_INDEX = re.compile(r"\[(\d+)\]")
_NUMBER = re.compile(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?")
_NAME = re.compile(r"[~/]?[A-Za-z_][\w./:-]*")
"""A value that is the name of a topic, a frame or a file, for example."""
_MIN_EQUAL_COMPONENTS = 3
"""The minimum number of components with equal changes that are listed by name only."""
_MIN_SIBLINGS = 4
"""The minimum number of sibling parts that gain or lose values with the same name in one line."""
_MAX_LISTED_VALUES = 10
"""The maximum number of added or removed values in a line."""
_MAX_LISTED_CHARACTERS = 40
"""The maximum number of characters of a value that is listed with others."""
_MAX_ITEM_CHANGES = 6
"""The maximum number of changed list items that are shown separately."""


@dataclass(frozen=True)
class ValueChange:
    """A value, or a part with several values, that differs.

    Attributes:
        name: the path of the value or the part.
        kind: whether the value is added, removed or changed.
        values: both values of a change; the value of an addition or removal; or the values of a part, with their names.
        location: the location of the value.
        reason: why the change is breaking; None if it is not.
        note: the consequences of a changed value; None if there are none.
    """

    name: str
    kind: Literal["changed", "added", "removed"]
    values: tuple[str, ...]
    location: Location
    reason: Phrase | None = None
    note: Phrase | None = None

    @property
    def sentence(self) -> Phrase:
        """The change in one line."""
        if self.kind == "changed":
            text = describe_items(self.name, *self.values) or change_text(self.name, *self.values)
            return text if self.note is None else phrase("{change}; {note}", change=text, note=self.note)
        if len(self.values) == 1:
            part = phrase("{parameter} {value}", parameter=self.name, value=self.values[0])
            return phrase("{part} added", part=part) if self.kind == "added" else phrase("{part} removed", part=part)
        items = joined_first(self.values, MAX_NAMES)
        if self.kind == "added":
            return phrase("{parameter} added: {items}", parameter=self.name, items=items)
        return phrase("{parameter} removed: {items}", parameter=self.name, items=items)

    @property
    def key(self) -> Hashable:
        """A key that is equal for equal changes to values with the same name in different parts.

        Names with the same edit, such as a new prefix of topics, are equal changes.
        """
        edit = self._edit
        if edit is not None:
            return self.kind, edit, None if self.reason is None else self.reason.template
        leaf = self.name.rpartition(".")[2]
        return leaf, self.kind, self.values, str(self.note), None if self.reason is None else str(self.reason)

    @property
    def sibling_key(self) -> Hashable | None:
        """A key that is equal for values of one name that sibling parts add or remove, and for names of list items.

        None for other values.
        """
        item = _ITEM_NAME.fullmatch(self.name)
        if item is not None and self.kind != "changed" and self.values == (item["label"],) and self.reason is None:
            return self.kind, item["list"], item["key"], None  # the names of the items
        parent, *inner_names = self.name.rsplit(".", 2)
        if self.kind == "changed" or len(inner_names) < 2:
            return None
        return self.kind, parent, inner_names[1], None if self.reason is None else str(self.reason)

    @property
    def _edit(self) -> Hashable | None:
        """The replaced part of a changed name and its replacement; None for other values."""
        if self.kind != "changed" or not all(map(_NAME.fullmatch, self.values)):
            return None
        old, new = self.values
        has_common = old[:1] == new[:1] or old[-1:] == new[-1:]
        return name_edit(old, new) if has_common else None


def merge_values(changes: Iterable[ValueChange]) -> Iterator[Change]:
    """Yield the changes in a file, with equal changes and long lists merged.

    Breaking changes are not merged into summaries of lists.
    """
    lists: dict[str, list[ValueChange]] = {}
    groups: dict[Hashable, list[ValueChange]] = {}
    singles: list[ValueChange] = []
    for change in changes:
        item = None if change.reason is not None else _ITEM.match(change.name)
        if item is not None:
            lists.setdefault(item["list"], []).append(change)
        else:
            singles.append(change)
            groups.setdefault(change.key, []).append(change)
    vectors = _find_vectors(singles)
    rest = [single for group in groups.values() if (single := [item for item in group if id(item) not in vectors])]
    sibling_groups: dict[Hashable, list[ValueChange]] = {}
    for group in rest:
        sibling_groups.setdefault(group[0].sibling_key, []).extend(group)
    lines: dict[int, Change] = {}
    for alike in _group_equal_vectors(vectors.values()):
        lines[id(alike[0][0][1])] = _join_components(alike)
    lone: list[ValueChange] = []
    for group in rest:
        siblings = sibling_groups[group[0].sibling_key]
        if group[0].sibling_key is not None and len({change.key for change in siblings}) >= _MIN_SIBLINGS:
            lines.update([(id(group[0]), _merge_siblings(siblings))] if group[0] is siblings[0] else [])
        elif len(group) == 1:
            lone += group
        else:
            lines[id(group[0])] = _merge_group(group)
    for together in _group_by_parent(lone):
        is_group = len(together) == 1 or len(together[0].values) > 1
        lines[id(together[0])] = _merge_group(together) if is_group else _list_values(together)
    yield from (lines[id(change)] for group in groups.values() for change in group if id(change) in lines)
    for name, group in lists.items():
        yield from (
            [_merge_group([change]) for change in group]
            if len(group) <= _MAX_ITEM_CHANGES
            else [_summarize_list(name, group)]
        )


_Vector = list[tuple[Component, ValueChange]]
"""The changed components of one pose, matrix or other group of numbers, each with its change."""


def _group_by_parent(changes: Iterable[ValueChange]) -> Iterator[list[ValueChange]]:
    """Yield the changes.

    Parts with equal values that one part gains or loses are together, and so are many single values.
    """
    groups: dict[Hashable, list[ValueChange]] = {}
    for change in changes:
        is_short = len(change.values) == 1 and len(change.values[0]) <= _MAX_LISTED_CHARACTERS
        is_value = change.kind != "changed" and is_short and change.reason is None is change.note
        is_part = change.kind != "changed" and len(change.values) > 1 and change.reason is None is change.note
        parent = change.name.rpartition(".")[0]
        key = (change.kind, parent, change.values if is_part else ()) if is_value or is_part else id(change)
        groups.setdefault(key, []).append(change)
    for group in groups.values():
        if len(group[0].values) > 1:
            yield group
            continue
        size = _MAX_LISTED_VALUES if len(group) >= _MIN_SIBLINGS else 1
        yield from (group[start : start + size] for start in range(0, len(group), size))


def _list_values(changes: Sequence[ValueChange]) -> Change:
    """Return one line about values that a part gains or loses."""
    parent = changes[0].name.rpartition(".")[0]
    items = joined([f"{change.name.rpartition('.')[2]} {change.values[0]}" for change in changes])
    text = items if not parent else phrase("{parameter}: {changes}", parameter=parent, changes=items)
    is_added = changes[0].kind == "added"
    text = phrase("{part} added", part=text) if is_added else phrase("{part} removed", part=text)
    return Change(text, location=changes[0].location)


def _find_vectors(changes: Iterable[ValueChange]) -> dict[int, _Vector]:
    """Return the groups in which several numbers change, by the identity of the change of each number."""
    vectors: dict[Hashable, _Vector] = {}
    for change in changes:
        component = find_component(change.name)
        is_number = change.kind == "changed" and all(map(_NUMBER.fullmatch, change.values))
        if component is not None and is_number and change.reason is None and change.note is None:
            vectors.setdefault((component.parent, component.family), []).append((component, change))
    return {id(change): vector for vector in vectors.values() if len(vector) > 1 for _, change in vector}


def _group_equal_vectors(vectors: Iterable[_Vector]) -> list[list[_Vector]]:
    """Return lists of different groups that change alike."""
    alike: dict[Hashable, dict[int, _Vector]] = {}
    for vector in vectors:
        key = tuple((component.name, change.values) for component, change in vector)
        alike.setdefault(key, {})[id(vector)] = vector
    return [list(group.values()) for group in alike.values()]


def _join_components(vectors: Sequence[_Vector]) -> Change:
    """Return one line about groups that change alike."""
    first, *others = vectors
    location = first[0][1].location
    locations = tuple(vector[0][1].location for vector in others)
    if len(first) >= _MIN_EQUAL_COMPONENTS and len({change.values for _, change in first}) == 1:
        names = [change.name for vector in vectors for _, change in vector]
        return Change(first[0][1].sentence, Effect.CHANGED, None, location, (), tuple(names[1:]), locations)
    text = joined([replace(change, name=component.name).sentence for component, change in first])
    if first[0][0].parent:
        text = phrase("{parameter}: {changes}", parameter=first[0][0].parent, changes=text)
    names = [vector[0][0].parent for vector in others]
    return Change(text, Effect.CHANGED, None, location, (), tuple(names), locations)


def _merge_group(group: Sequence[ValueChange]) -> Change:
    first = group[0]
    effect = Effect.CHANGED if first.reason is None else Effect.BREAKING
    reason = merge_reasons(change.reason for change in group)
    is_equal = all((change.values, str(change.note)) == (first.values, str(first.note)) for change in group)
    names = tuple(change.name if is_equal else str(change.sentence) for change in group[1:])
    locations = tuple(change.location for change in group[1:])
    return Change(first.sentence, effect, reason, first.location, (), names, locations)


def _merge_siblings(group: Sequence[ValueChange]) -> Change:
    first = group[0]
    text = phrase("{parameter} removed", parameter=first.name)
    if first.kind == "added":
        text = phrase("{parameter} added", parameter=first.name)
    names, locations = tuple(change.name for change in group[1:]), tuple(change.location for change in group[1:])
    effect = Effect.CHANGED if first.reason is None else Effect.BREAKING
    return Change(text, effect, first.reason, first.location, (), names, locations)


def _summarize_list(name: str, group: Sequence[ValueChange]) -> Change:
    counts = [sum(change.kind == kind for change in group) for kind in ("changed", "added", "removed")]
    texts = (
        counted("{count} value changed", "{count} values changed", counts[0]),
        counted("{count} part added", "{count} parts added", counts[1]),
        counted("{count} part removed", "{count} parts removed", counts[2]),
    )
    counts_text = joined([text for text, count in zip(texts, counts, strict=True) if count])
    items = [str(change.sentence) for change in _merge_items(name, group)]
    shown = count_shown(len(items), MAX_NAMES)
    items_text = joined(items[:shown], "; ")
    if len(items) > shown:
        items_text = phrase("{names} and {count} more", names=items_text, count=len(items) - shown)
    text = phrase("list {name}: {changes}: {items}", name=name, changes=counts_text, items=items_text)
    return Change(text, location=group[0].location)


def _merge_items(name: str, group: Sequence[ValueChange]) -> list[ValueChange]:
    """Return the changes with the path in the list as their name, and equal changes of several items merged."""
    merged: dict[Hashable, list[tuple[int, ValueChange]]] = {}
    for number, change in enumerate(group):
        own = replace(change, name=change.name.removeprefix(name))
        index = _INDEX.match(own.name)
        key = number if index is None else (own.name[index.end() :], own.kind, own.values)
        merged.setdefault(key, []).append((-1 if index is None else int(index[1]), own))
    result = []
    for indexes, changes in (zip(*items, strict=True) for items in merged.values()):
        rest = changes[0].name.partition("]")[2]
        name = changes[0].name if len(changes) == 1 else f"[{_format_indexes(indexes)}]{rest}"
        result.append(replace(changes[0], name=name))
    return result


def _format_indexes(indexes: Iterable[int]) -> str:
    """Return numbers in a short form, such as ``0..3, 7``."""
    runs: list[list[int]] = []
    for index in sorted(indexes):
        if runs and index == runs[-1][-1] + 1:
            runs[-1].append(index)
        else:
            runs.append([index])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}..{run[-1]}" for run in runs)
