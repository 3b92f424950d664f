"""Pair removed and added names that call the same function."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.review.sources.names import SourceName, SourceNames


def pair_by_callback(
    removed: Sequence[SourceName], added: Sequence[SourceName], old_names: SourceNames, new_names: SourceNames
) -> list[tuple[SourceName, SourceName]]:
    """Return the pairs of a removed and an added name that call the same function.

    The function gets the messages, requests or goals.

    Args:
        removed: the names that only the old version has.
        added: the names that only the new version has.
        old_names: all names of the old version.
        new_names: all names of the new version.
    """
    old, new = (
        {(kind, name): function for function, (kind, name) in names.callbacks.items()}
        for names in (old_names, new_names)
    )
    functions = {function: item for item in added if (function := new.get((item.kind, item.name))) is not None}
    pairs = ((item, functions.get(old.get((item.kind, item.name), ""))) for item in removed)
    return [(item, other) for item, other in pairs if other is not None]
