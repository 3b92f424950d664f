"""Equal changes of several links, joints or extensions in one line."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable
from dataclasses import replace

from linkwright.review.changes import Change, Location

_PART = re.compile(r"(?P<part>(?:joint|gpio|sensor) \S+) (?P<rest>.+)")
"""A property of hardware of ros2_control below one of its joints, GPIOs or sensors."""


def merged(changes: Iterable[Change]) -> list[Change]:
    """Return changes in which equal changes of several links, joints or extensions are one.

    Breaking changes stay apart, because the reason of each of them contains a name.
    """
    for key, names in ((_content, _names), (_content_of_part, _part_names)):
        groups: dict[Hashable, list[Change]] = {}
        for number, change in enumerate(changes):
            content = None if change.reason is not None or not change.name else key(change)
            groups.setdefault(number if content is None else (content, change.cases), []).append(change)
        changes = [group[0] if len(group) == 1 else _as_one(group, names) for group in groups.values()]
    return list(changes)


def _content(change: Change) -> Hashable:
    return change.content


def _names(change: Change) -> tuple[str, ...]:
    return change.name, *change.other_names


def _content_of_part(change: Change) -> Hashable | None:
    """Return a key that is equal for the same change of other joints of the same hardware; None for other changes."""
    part = _PART.fullmatch(change.property_name)
    if part is None or change.other_names:
        return None
    return change.name, part["rest"], change.values


def _part_names(change: Change) -> tuple[str, ...]:
    part = _PART.fullmatch(change.property_name)
    return (change.name,) if part is None else (part["part"],)


def _as_one(changes: list[Change], names_of: Callable[[Change], tuple[str, ...]]) -> Change:
    first = changes[0]
    names = dict.fromkeys(name for change in changes for name in names_of(change))
    for name in names_of(first)[:1]:
        del names[name]
    locations: dict[Location, None] = {}
    for change in changes[1:]:
        if change.location is not None and change.location != first.location:
            locations[change.location] = None
    return replace(first, other_names=tuple(names), other_locations=tuple(locations))
