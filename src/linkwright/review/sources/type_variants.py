"""Compare the types of topics that a source uses with several types under one name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from linkwright.review.sources.names import NameKind, SourceName, SourceNames

_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION)
_MIN_TYPES = 2


class TypeVariants:
    """The types of the publishers or subscriptions in both versions of a source.

    A publisher or subscription with a second type under the same name, such as one in each branch of an ``if``
    statement, is another one.

    Args:
        kind: the kind of the names.
        old: the names in the old source.
        new: the names in the new source.

    Attributes:
        removed: the variants of names of both versions that only the old version has.
        added: the variants of names of both versions that only the new version has.
    """

    def __init__(self, kind: NameKind, old: SourceNames, new: SourceNames) -> None:
        self.removed: list[SourceName] = []
        self.added: list[SourceName] = []
        self._kept: set[str] = set()
        if kind not in _KINDS:
            return
        before, after = (_group_by_type(kind, names) for names in (old, new))
        for name in before.keys() & after.keys():
            sides = before[name], after[name]
            if max(map(len, sides)) < _MIN_TYPES or sides[0].keys().isdisjoint(sides[1]):
                continue
            self._kept.add(name)
            self.removed += _show_default((item for type_, item in sides[0].items() if type_ not in sides[1]), old)
            self.added += _show_default((item for type_, item in sides[1].items() if type_ not in sides[0]), new)

    def align(self, old: SourceName, new: SourceName) -> SourceName:
        """Return an old name with the type of the new one, if both versions have the name with a common type."""
        return replace(old, type=new.type, full_type=new.full_type) if new.name in self._kept else old


def _group_by_type(kind: NameKind, names: SourceNames) -> dict[str, dict[str, SourceName]]:
    """Return the literal and computed names of a kind by name and type."""
    groups: dict[str, dict[str, SourceName]] = {}
    for item in (*names.typed_names, *names.expressions):
        if item.kind is kind and item.type:
            groups.setdefault(item.name, {}).setdefault(item.type, item)
    return groups


def _show_default(items: Iterable[SourceName], names: SourceNames) -> list[SourceName]:
    """Return names in the order of the source; a computed one has the name by default if that is known."""
    ordered = sorted(items, key=lambda item: item.span.line)
    return [replace(item, name=names.defaults.get(item.name, item.name)) for item in ordered]
