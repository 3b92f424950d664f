"""Compare the properties of a name that both versions of a source have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import NO, Detail, NameKind, SourceName
from linkwright.review.sources.signatures import parse_signature

_CLIENT_KINDS = (NameKind.CLIENT, NameKind.ACTION_CLIENT)
_BEST_EFFORT = re.compile(r"best_?effort|sensor_?data", re.IGNORECASE)
_TRANSIENT = re.compile(r"transient_?local|latching", re.IGNORECASE)
_MAX_ARGUMENT_CHARACTERS = 80
"""The maximum number of characters of shown arguments of an added function or class."""
_DEFAULT = " = ..."
"""The end of the text of a function parameter with a default."""


def format_name(item: SourceName) -> str:
    """Return a name with its type, default or arguments."""
    arguments = dict(item.details).get(Detail.ARGUMENTS, "()")
    if arguments != "()" and len(arguments) <= _MAX_ARGUMENT_CHARACTERS:
        return f"'{item.name}' {arguments}"
    return f"'{item.name}' ({item.type})" if item.type else f"'{item.name}'"


def format_names(items: Sequence[SourceName]) -> Phrase:
    """Return the names with their types, up to a limit."""
    return joined_first(map(format_name, items), MAX_NAMES)


def compare_details(old: SourceName, new: SourceName) -> Iterator[tuple[Phrase, Phrase | None]]:
    """Yield the changes to a name, each with the reason why it is breaking or None."""
    if not new.has_type_of(old):
        yield from _compare_types(old, new)
    old_details, new_details = dict(old.details), dict(new.details)
    for detail in Detail:
        before, after = old_details.get(detail), new_details.get(detail)
        if before == after or (detail in (Detail.QOS, Detail.ARGUMENTS) and None in (before, after)):
            continue
        missing = NO if detail in (Detail.LATCH, Detail.REQUIRED) else "-"
        text = phrase(
            "{kind} '{name}': {property} {old} -> {new}",
            kind=new.kind.title,
            name=new.name,
            property=detail.title,
            old=before or missing,
            new=after or missing,
        )
        yield text, _find_detail_reason(new, detail, before, after)


def _compare_types(old: SourceName, new: SourceName) -> Iterator[tuple[Phrase, Phrase | None]]:
    if new.kind is NameKind.FUNCTION:
        reason = phrase("code that calls '{name}' with the old arguments does not build", name=new.name)
        yield (
            format_overload_change(new.name, old.type, new.type),
            None if accepts_all(old.type, new.type) else reason,
        )
    elif new.kind in (NameKind.PARAMETER, NameKind.OPTION, NameKind.ELEMENT):
        text = phrase(
            "{kind} '{name}': default {old} -> {new}",
            kind=new.kind.title,
            name=new.name,
            old=old.type or "-",
            new=new.type or "-",
        )
        if old.type and new.type:
            yield text, None
    elif old.type and new.type:
        types = (old.type, new.type) if old.type != new.type else (old.full_type, new.full_type)
        text = phrase(
            "{kind} '{name}': type {old} -> {new}", kind=new.kind.title, name=new.name, old=types[0], new=types[1]
        )
        reason = phrase("programs that use '{name}' with the old type get nothing", name=new.name)
        yield text, None if new.kind is NameKind.MEMBER else reason


def format_overload_change(name: str, old: str, new: str) -> Phrase:
    """Return the change to the parameters of a function.

    Only overloads that one version lacks are shown.
    """
    overloads = old.split("; "), new.split("; ")
    removed, added = (
        " | ".join(f"({overload})" for overload in own if overload not in other)
        for own, other in (overloads, overloads[::-1])
    )
    if not removed:
        return phrase("function '{name}': overloads {overloads} added", name=name, overloads=added)
    if not added:
        return phrase("function '{name}': overloads {overloads} removed", name=name, overloads=removed)
    return phrase("function '{name}': {old} -> {new}", name=name, old=removed, new=added)


def accepts_all(old: str, new: str) -> bool:
    """Return whether new overloads of a function accept the arguments of all old overloads."""
    overloads = [_split_overloads(text) for text in new.split("; ")]
    return all(any(_accepts(_split_overloads(text), overload) for overload in overloads) for text in old.split("; "))


def _split_overloads(text: str) -> list[str]:
    return re.split(r", (?![^<]*>)", text) if text else []


def _accepts(old: list[str], new: list[str]) -> bool:
    required = [parameter for parameter in old if not parameter.endswith(_DEFAULT)]
    types = [parameter.removesuffix(_DEFAULT) for parameter in old]
    has_equal_types = [parameter.removesuffix(_DEFAULT) for parameter in new[: len(types)]] == types
    return has_equal_types and all(parameter.endswith(_DEFAULT) for parameter in new[len(required) :])


def _find_detail_reason(name: SourceName, detail: Detail, before: str | None, after: str | None) -> Phrase | None:
    """Return the reason why a changed property is breaking, or None if it is not."""
    old, new = before or "", after or ""
    if detail is Detail.QOS:
        return _find_qos_reason(name, old, new)
    if detail is Detail.VALUE_TYPE and name.kind is NameKind.PARAMETER and before and after:
        return phrase("values of the old type are rejected")
    if detail is Detail.REQUIRED and name.kind is NameKind.FUNCTION:
        return phrase("classes that derive from the class and do not define it do not build") if after else None
    if detail is Detail.REQUIRED and after:
        return make_required_reason(name.kind, name.name)
    if detail is Detail.ARGUMENTS:
        old_signature, new_signature = parse_signature(old), parse_signature(new)
        is_accepted = old_signature is None or new_signature is None or new_signature.accepts_calls_of(old_signature)
        return (
            None if is_accepted else phrase("programs that call '{name}' with the old arguments fail", name=name.name)
        )
    if detail is Detail.LATCH and before:
        return phrase("subscribers that start later do not get the last message")
    return None


def make_required_reason(kind: NameKind, names: Phrase | str) -> Phrase:
    """Return the reason why an option or parameter without a default is breaking."""
    if kind is NameKind.PARAMETER:
        return phrase("the program fails where '{name}' is not set", name=names)
    return phrase("callers that do not pass '{name}' get an error", name=names)


def _find_qos_reason(name: SourceName, old: str, new: str) -> Phrase | None:
    """Return the reason why a different QoS is breaking, or None.

    A subscription needs what the publisher offers.
    """
    was_best_effort, is_best_effort = (_BEST_EFFORT.search(text) is not None for text in (old, new))
    was_transient, is_transient = (_TRANSIENT.search(text) is not None for text in (old, new))
    if name.kind is NameKind.PUBLISHER:
        if is_best_effort and not was_best_effort:
            return phrase("subscriptions that ask for reliable messages get nothing")
        if was_transient and not is_transient:
            return phrase("subscriptions that ask for messages from before their start get nothing")
    if name.kind is NameKind.SUBSCRIPTION:
        if was_best_effort and not is_best_effort:
            return phrase("the node gets nothing from publishers that send with best effort")
        if is_transient and not was_transient:
            return phrase("the node gets nothing from publishers that keep no messages")
    return None
