"""Pair removed and added names that call the same function."""

from __future__ import annotations

import re
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
    functions = {
        function: item for item in added if (function := _find_function(item, new_names, old_names)) is not None
    }
    pairs = ((item, functions.get(_find_function(item, old_names, new_names) or "")) for item in removed)
    return [(item, other) for item, other in pairs if other is not None]


def _find_function(item: SourceName, names: SourceNames, others: SourceNames) -> str | None:
    """Return the function that a name calls, or None.

    Its class is left out if only one function of each version has the name, because classes are renamed.
    """
    calling = [function for function, callback in names.callbacks.items() if callback == (item.kind, item.name)]
    if not calling:
        return None
    short = _get_short_name(calling[-1])
    is_unique = all(sum(_get_short_name(name) == short for name in side.callbacks) == 1 for side in (names, others))
    return short if is_unique else calling[-1]


def _get_short_name(function: str) -> str:
    return re.split(r"\.|::", function)[-1]
