"""Merge equal changed values, and summarize many changes in a list."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.list_changes import change_text
from linkwright.review.merging import merge_reasons, name_edit

_ITEM = re.compile(r"(?P<list>[^\[]*)\[(?:old )?\d+\]")
"""The path of a list item without a name."""
_NAME = re.compile(r"[~/]?[A-Za-z_][\w./:-]*")
"""A value that is the name of a topic, a frame or a file, for example."""
_MIN_SIBLINGS = 4
"""The minimum number of sibling parts that gain or lose values with the same name in one line."""
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
    """

    name: str
    kind: Literal["changed", "added", "removed"]
    values: tuple[str, ...]
    location: Location
    reason: Phrase | None = None

    @property
    def sentence(self) -> Phrase:
        """The change in one line."""
        if self.kind == "changed":
            return change_text(self.name, *self.values)
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
        return leaf, self.kind, self.values, None if self.reason is None else str(self.reason)

    @property
    def sibling_key(self) -> Hashable | None:
        """A key that is equal for values of one name that sibling parts add or remove.

        None for other values.
        """
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
    for change in changes:
        item = None if change.reason is not None else _ITEM.match(change.name)
        if item is not None:
            lists.setdefault(item["list"], []).append(change)
        else:
            groups.setdefault(change.key, []).append(change)
    sibling_groups: dict[Hashable, list[ValueChange]] = {}
    for group in groups.values():
        sibling_groups.setdefault(group[0].sibling_key, []).extend(group)
    for group in groups.values():
        siblings = sibling_groups[group[0].sibling_key]
        if group[0].sibling_key is None or len({change.key for change in siblings}) < _MIN_SIBLINGS:
            yield _merge_group(group)
        elif group[0] is siblings[0]:
            yield _merge_siblings(siblings)
    for name, group in lists.items():
        yield from (
            [_merge_group([change]) for change in group]
            if len(group) <= _MAX_ITEM_CHANGES
            else [_summarize_list(name, group)]
        )


def _merge_group(group: Sequence[ValueChange]) -> Change:
    first = group[0]
    effect = Effect.CHANGED if first.reason is None else Effect.BREAKING
    reason = merge_reasons(change.reason for change in group)
    is_equal = all(change.values == first.values for change in group)
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
    items = [str(replace(change, name=change.name.removeprefix(name)).sentence) for change in group]
    items_text = joined(items[:MAX_NAMES], "; ")
    if len(items) > MAX_NAMES:
        items_text = phrase("{names} and {count} more", names=items_text, count=len(items) - MAX_NAMES)
    text = phrase("list {name}: {changes}: {items}", name=name, changes=counts_text, items=items_text)
    return Change(text, location=group[0].location)
