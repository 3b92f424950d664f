"""Decide whether the removal of a topic, service or action with a computed name is breaking."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.changed_sources import ChangedSources
from linkwright.review.sources.name_patterns import make_expression_pattern
from linkwright.review.sources.names import NameKind, SourceName
from linkwright.review.sources.unchanged_sources import get_counterpart, make_user_reason

_OFFERED_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.ACTION)


def find_lost_pattern_reason(
    items: Sequence[SourceName], old: ChangedSources, new: ChangedSources, path: str
) -> Phrase | None:
    """Return the reason why the removal of computed names is breaking.

    The result is None if the sources have an added name of the same kind and type, which may replace each of them.

    Args:
        items: the removed expressions, all of the same kind.
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        path: the path of the source.
    """
    lost = [
        item
        for item in items
        if item.kind in _OFFERED_KINDS and item.type and new.list_similar(item) <= old.list_similar(item) - {item.name}
    ]
    reasons = (reason for item in lost for reason in _find_user_reasons(item, new, path))
    general = phrase("programs that use the {kind} do not find it", kind=items[0].kind.title)
    return next(reasons, general) if lost else None


def _find_user_reasons(item: SourceName, new: ChangedSources, path: str) -> Iterator[Phrase]:
    """Yield a reason for each source of the package that uses the other end of a computed name by a literal name."""
    pattern, kind = make_expression_pattern(item.name), get_counterpart(item.kind)
    for user_path, names in new.list_sources(path, item.type) if pattern is not None and kind is not None else ():
        for user in names.of_kind(kind) if kind is not None else ():
            if pattern is not None and user.has_type_of(item) and re.fullmatch(pattern, user.name):
                yield make_user_reason(item.kind, user_path, user.name)
