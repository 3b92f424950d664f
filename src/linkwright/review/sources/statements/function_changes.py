"""Merge the changes of many functions that other files can call into one line for each kind of change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import Detail, SourceName, SourceNames
from linkwright.review.sources.python.signatures import parse_signature
from linkwright.review.sources.reasons import make_member_reason

_MAX_CHANGES = 3
"""The largest number of changes of a kind that have lines of their own."""


class NameChange(NamedTuple):
    """A change of a name that both versions have.

    Attributes:
        item: the name in the new version.
        text: the change.
        reason: the reason why the change is breaking, or None.
        detail: the property that changed; None for the type, which of a function in C++ is its arguments.
    """

    item: SourceName
    text: Phrase
    reason: Phrase | None
    detail: Detail | None = None


def find_ignored_reason(item: SourceName, old: SourceNames, new: SourceNames) -> Phrase | None:
    """Return the reason why a Python function that ignores further keyword arguments is breaking; None if it is not.

    It is if such a function has lost a parameter.

    Args:
        item: the function or class in the new version.
        old: the names in the old source.
        new: the names in the new source.
    """
    before = next((other for other in old.of_kind(item.kind) if other.name == item.name), None)
    if before is None or item.name not in old.ignoring_keywords & new.ignoring_keywords:
        return None
    signatures = [parse_signature(dict(other.details).get(Detail.ARGUMENTS, "")) for other in (before, item)]
    names = [() if signature is None else (*signature.positional, *signature.keywords) for signature in signatures]
    lost = [name for name in names[0] if name not in names[1]]
    if not lost or len(names[1]) >= len(names[0]):
        return None
    return phrase("'{name}' ignores {arguments} now", name=item.name, arguments=joined_first(lost, MAX_NAMES))


def find_field_reason(item: SourceName, old: SourceNames) -> Phrase | None:
    """Return the reason why a data class in Python that has lost fields is breaking; None if it has not.

    Args:
        item: the class in the new version.
        old: the names in the old source.
    """
    before = next((other for other in old.of_kind(item.kind) if other.name == item.name), None)
    if before is None or item.name not in old.data_classes:
        return None
    signatures = [parse_signature(dict(other.details).get(Detail.ARGUMENTS, "")) for other in (before, item)]
    names = [() if signature is None else signature.positional for signature in signatures]
    lost = [f"{item.name}.{name}" for name in names[0] if name not in names[1]]
    return make_member_reason(lost) if lost and None not in signatures else None


def merge_function_changes(changes: Sequence[NameChange], *, is_python: bool) -> Iterator[NameChange]:
    """Yield the changes of functions. More than three of one kind are merged into the first of them."""
    for kind in dict.fromkeys(map(_find_kind, changes)):
        same_kind = [change for change in changes if _find_kind(change) is kind]
        if len(same_kind) > _MAX_CHANGES and kind in (Detail.ARGUMENTS, Detail.RESULT, Detail.CONSTANT):
            yield _merge(same_kind, kind, is_python=is_python)
        else:
            yield from same_kind


def _find_kind(change: NameChange) -> Detail:
    return Detail.ARGUMENTS if change.detail is None else change.detail


def _merge(changes: Sequence[NameChange], kind: Detail, *, is_python: bool) -> NameChange:
    names = joined_first(dict.fromkeys(change.item.name for change in changes), MAX_NAMES)
    if kind is Detail.CONSTANT:
        text = phrase("functions that are no longer const: {names}", names=names)
        reason = phrase("code that calls them on constant objects does not build")
    elif kind is Detail.RESULT:
        text = phrase("functions with other results: {names}", names=names)
        reason = phrase("code that uses their old results does not build")
    else:
        text = phrase("functions with other arguments: {names}", names=names)
        reason = phrase("code that calls them with the old arguments does not build")
        if is_python:
            reason = phrase("programs that call them with the old arguments fail")
    is_breaking = any(change.reason is not None for change in changes)
    return NameChange(changes[0].item, text, reason if is_breaking else None, kind)
