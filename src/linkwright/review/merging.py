"""Equal changes of several links, joints or extensions in one line."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import replace

from linkwright.review.changes import Change, Location


def merged(changes: Iterable[Change]) -> list[Change]:
    """Return changes in which equal changes of several links, joints or extensions are one.

    Breaking changes stay apart, because the reason of each of them contains a name.
    """
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        is_alone = change.reason is not None or not change.name
        groups.setdefault(number if is_alone else (change.content, change.cases), []).append(change)
    return [group[0] if len(group) == 1 else _as_one(group) for group in groups.values()]


def _as_one(changes: list[Change]) -> Change:
    first = changes[0]
    names = dict.fromkeys(name for change in changes for name in (change.name, *change.other_names))
    names.pop(first.name, None)
    locations: dict[Location, None] = {}
    for change in changes[1:]:
        if change.location is not None and change.location != first.location:
            locations[change.location] = None
    return replace(first, other_names=tuple(names), other_locations=tuple(locations))
