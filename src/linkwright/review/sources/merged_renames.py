"""Merge the renames of a source whose names are edited alike into one line."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from dataclasses import replace

from linkwright.review.changes import Change
from linkwright.review.sources.details import is_rename
from linkwright.review.sources.names import NameKind
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.merging import name_edit
from linkwright.review.texts.name_words import split_name

_SEPARATE_KINDS = tuple(
    str(kind.title) for kind in (NameKind.FRAME, NameKind.MESSAGE_FRAME, NameKind.FRAME_LOOKUP, NameKind.NODE)
)
"""The kinds of names that keep a line each, because other files are searched for them."""

_QUOTED = re.compile(r"'([^']+)'")
_NOTATION = "notation"


def merge_renames(changes: Sequence[Change]) -> list[Change]:
    """Return the changes to a source, with one line for the names of a kind that are edited alike."""
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        groups.setdefault(_make_key(change) or number, []).append(change)
    return [group[0] if len(group) == 1 else _join(group) for group in groups.values()]


def _make_key(change: Change) -> Hashable | None:
    """Return a key that is equal for renames by the same edit or to the same notation; None for other changes."""
    arguments = change.sentence.arguments
    if not is_rename(change.sentence) or str(arguments["kind"]) in _SEPARATE_KINDS:
        return None
    reason = None if change.reason is None else change.reason.template
    names = str(arguments["old"]), str(arguments["new"])
    return str(arguments["kind"]), reason, _NOTATION if _have_same_words(*names) else name_edit(*names)


def _have_same_words(old: str, new: str) -> bool:
    """Return whether two names differ only in their notation, such as ``setSpeed`` and ``set_speed``."""
    matches = _QUOTED.match(old), _QUOTED.match(new)
    words = [split_name(match[1]) for match in matches if match is not None]
    return len(words) == len(matches) and words[0] == words[1]


def _join(changes: Sequence[Change]) -> Change:
    names = tuple(_format_pair(change) for change in changes[1:])
    locations = tuple(change.location for change in changes[1:] if change.location is not None)
    reason = merge_reasons(change.reason for change in changes)
    return replace(changes[0], reason=reason, other_names=names, other_locations=locations)


def _format_pair(change: Change) -> str:
    old, new = (str(change.sentence.arguments[name]).replace("'", "") for name in ("old", "new"))
    return f"{old} -> {new}"
