"""Merge the renames of a source whose names are edited alike into one line."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace

from linkwright.review.changes import Change
from linkwright.review.merging import merge_reasons, name_edit
from linkwright.review.sources.details import is_rename
from linkwright.review.sources.names import NameKind

_SEPARATE_KINDS = tuple(
    str(kind.title) for kind in (NameKind.FRAME, NameKind.MESSAGE_FRAME, NameKind.FRAME_LOOKUP, NameKind.NODE)
)
"""The kinds of names that keep a line each, because other files are searched for them."""


def merge_renames(changes: Sequence[Change]) -> list[Change]:
    """Return the changes to a source, with one line for the names of a kind that are edited alike."""
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        groups.setdefault(_make_key(change) or number, []).append(change)
    return [group[0] if len(group) == 1 else _join(group) for group in groups.values()]


def _make_key(change: Change) -> Hashable | None:
    """Return a key that is equal for renames by the same edit; None for other changes."""
    arguments = change.sentence.arguments
    if not is_rename(change.sentence) or str(arguments["kind"]) in _SEPARATE_KINDS:
        return None
    reason = None if change.reason is None else change.reason.template
    return str(arguments["kind"]), reason, name_edit(str(arguments["old"]), str(arguments["new"]))


def _join(changes: Sequence[Change]) -> Change:
    names = tuple(_format_pair(change) for change in changes[1:])
    locations = tuple(change.location for change in changes[1:] if change.location is not None)
    reason = merge_reasons(change.reason for change in changes)
    return replace(changes[0], reason=reason, other_names=names, other_locations=locations)


def _format_pair(change: Change) -> str:
    old, new = (str(change.sentence.arguments[name]).replace("'", "") for name in ("old", "new"))
    return f"{old} -> {new}"
