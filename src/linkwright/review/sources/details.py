"""Compare the properties of a name that both versions of a source have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import Phrase, joined, joined_first, phrase, quoted
from linkwright.review.breaking import quote_first
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.cpp.calls import GRAPH_KINDS
from linkwright.review.sources.cpp.types import accepts_type, can_use_result, is_convertible, is_same_type
from linkwright.review.sources.cpp.variable_types import normalize_read_type, rejects_values
from linkwright.review.sources.names import NO, YES, Detail, NameKind, SourceName
from linkwright.review.sources.python.signatures import NOTHING, parse_signature
from linkwright.review.sources.qos import find_depth, find_qos_reason, list_policies, normalize_qos
from linkwright.review.texts.list_changes import nested_list_items

_MIN_KEPT_ARGUMENTS = 6
"""The minimum number of arguments in both versions of a list of which only the others are shown."""
_KNOWN_IN_BOTH = (
    *(Detail.QOS, Detail.READ_AS, Detail.ARGUMENTS, Detail.RESULT, Detail.RETURNED),
    *(Detail.RETURNED_COUNT, Detail.BASES, Detail.CREATED_IN),
)
"""The properties that are compared only if both versions tell them."""
_CLIENT_KINDS = (NameKind.CLIENT, NameKind.ACTION_CLIENT)
_QOS = re.compile(r"[\w:.]*(?:QoS|qos_profile|QOS)\w*\s*(?:[({].*)?", re.DOTALL)
_SERVICES_DEFAULT = re.compile(
    r"(?:rclcpp::)?ServicesQoS\s*[({]\s*[)}](?:\.get_rmw_qos_profile\(\))?|(?:[\w.]+\.)?(?:rmw_)?qos_profile_services_default"
)
_DEFAULT_QOS = "default"
_MAX_ARGUMENT_CHARACTERS = 80
"""The maximum number of characters of shown arguments of an added function or class."""
_RENAME = "{kind} {old} renamed to {new}"
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


def format_added_names(items: Sequence[SourceName]) -> Phrase:
    """Return added names with their types, and the QoS of topics if it differs from the default, up to a limit."""
    return joined_first(map(_format_added_name, items), MAX_NAMES)


def _format_added_name(item: SourceName) -> Phrase | str:
    policies = list_policies(item) if item.kind in (NameKind.PUBLISHER, NameKind.SUBSCRIPTION) else []
    text = format_name(replace(item, type=", ".join(filter(None, [item.type, *policies]))))
    parameter = dict(item.details).get(Detail.GIVEN_BY)
    return text if parameter is None else phrase("{name} from parameter '{parameter}'", name=text, parameter=parameter)


def format_rename(old: SourceName, new: SourceName) -> Phrase:
    """Return the change of a name."""
    return phrase("{kind} {old} renamed to {new}", kind=new.kind.title, old=format_name(old), new=format_name(new))


def format_computed(item: SourceName, expression: str, choices: Sequence[str]) -> Phrase:
    """Return the change of a name that an expression computes now, with the texts that the expression may have."""
    values = {"kind": item.kind.title, "name": format_name(item), "new": expression}
    if not choices:
        return phrase("{kind} {name} has a computed name now: {new}", **values)
    texts = joined(map(quoted, choices), last=" or ")
    return phrase("{kind} {name} has a computed name now: {new}, which is {texts}", **values, texts=texts)


def is_rename(sentence: Phrase) -> bool:
    """Return whether a sentence is the change of a name."""
    return sentence.template == _RENAME


def compare_computed(
    old: SourceName, new: SourceName, defaults: Sequence[str]
) -> Iterator[tuple[Phrase, Phrase | None, Detail | None]]:
    """Yield the changes to a name that the same expression computes, as `compare_details` does.

    Args:
        old: the old name.
        new: the new name.
        defaults: the name that the expression has by default in each version; empty if it is unknown.
    """
    name = defaults[0] if len(set(defaults)) == 1 else ""
    if name:
        old, new = replace(old, name=name), replace(new, name=name)
    yield from compare_details(old, new, is_computed=not name)


def compare_details(
    old: SourceName, new: SourceName, *, is_computed: bool = False, has_other_class: bool = False
) -> Iterator[tuple[Phrase, Phrase | None, Detail | None]]:
    """Yield the changes to a name, each with the reason why it is breaking or None, and the property that changed.

    The property is None if the type changed.

    Args:
        old: the old name.
        new: the new name.
        is_computed: whether the name is the text of an expression, which others do not know.
        has_other_class: whether a type is another class with the same name.
    """
    if not new.has_type_of(old):
        for text, reason in _compare_types(old, new, is_computed=is_computed, has_other_class=has_other_class):
            yield text, reason, None
    old_details, new_details = dict(old.details), dict(new.details)
    for detail in Detail:
        before, after = old_details.get(detail), new_details.get(detail)
        sides = (before, old_details), (after, new_details)
        if before == after or detail is Detail.UNDEFINED or (detail in _KNOWN_IN_BOTH and None in (before, after)):
            continue
        if detail is Detail.DEFAULT:
            yield from _compare_missing_defaults(old, new)
            continue
        if detail is Detail.VALUE_TYPE and _shows_type(old, new) and before is None:
            continue  # the line about the default shows the type
        if detail is Detail.VALUE_TYPE and new.kind is NameKind.PARAMETER and not _has_other_type(old, new):
            continue
        if detail is Detail.QOS and normalize_qos(before or "") == normalize_qos(after or ""):
            continue
        if detail is Detail.QUEUE and None in (before, after):  # a depth is a QoS in ROS 2
            before, after = (item or find_depth(side.get(Detail.QOS, "")) for item, side in sides)
            if before == after or None in (before, after):
                continue
        if detail is Detail.READ_AS and normalize_read_type(before or "") == normalize_read_type(after or ""):
            continue
        if detail is Detail.CONSTANT and after is not None:
            continue  # calls that built still build
        if detail is Detail.RESULT and is_same_type(before or "", after or ""):
            continue
        if detail is Detail.RETURNED and after != NOTHING:
            continue  # another value of any type, which callers may expect or not
        missing = NO if detail in (Detail.LATCH, Detail.REQUIRED, Detail.CONSTANT) else "-"
        missing = (
            phrase("none") if detail in (Detail.MINIMUM, Detail.MAXIMUM) else missing
        )  # not the sign of a negative limit
        text = phrase(
            "{kind} '{name}': {property} {old} -> {new}",
            kind=new.kind.title,
            name=new.name,
            property=detail.title,
            old=before or missing,
            new=after or missing,
        )
        if detail is Detail.ARGUMENTS:
            text = _format_argument_change(new, before or "", after or "") or text
        yield text, _find_detail_reason(new, detail, before, after), detail


def _format_argument_change(item: SourceName, old: str, new: str) -> Phrase | None:
    """Return which arguments of a long list were added and removed; None if the list is short or has another order."""
    old_items, new_items = (nested_list_items(f"[{text[1:-1]}]") for text in (old, new))
    kept = [argument for argument in old_items if argument in new_items]
    if len(kept) < _MIN_KEPT_ARGUMENTS or kept != [argument for argument in new_items if argument in old_items]:
        return None
    added = ", ".join(argument for argument in new_items if argument not in old_items)
    removed = ", ".join(argument for argument in old_items if argument not in new_items)
    name = phrase("{kind} '{name}'", kind=item.kind.title, name=item.name)
    if not removed:
        return phrase("{name}: arguments added: {added}", name=name, added=added)
    if not added:
        return phrase("{name}: arguments removed: {removed}", name=name, removed=removed)
    return phrase("{name}: arguments {removed} -> {added}", name=name, removed=removed, added=added)


def _shows_type(old: SourceName, new: SourceName) -> bool:
    """Return whether only the new version of a parameter has a default, which shows its type."""
    return (Detail.DEFAULT, NO) in old.details and (Detail.DEFAULT, NO) not in new.details


def _has_other_type(old: SourceName, new: SourceName) -> bool:
    """Return whether two versions of a parameter certainly have different types."""
    types = [dict(item.details).get(Detail.VALUE_TYPE) for item in (old, new)]
    if None in types:  # a declaration without a default has a type only if it states one
        return (Detail.DEFAULT, NO) in old.details and (Detail.DEFAULT, NO) in new.details
    kinds = [normalize_read_type(text or "") for text in types]
    return kinds[0] != kinds[1] or (kinds[0] == "list" and "list" not in types)


def _compare_missing_defaults(old: SourceName, new: SourceName) -> Iterator[tuple[Phrase, Phrase | None, Detail]]:
    """Yield the literal default of a parameter that only one version has."""
    before, after = ("-" if (Detail.DEFAULT, NO) in item.details else item.type for item in (old, new))
    if before and after:
        text = phrase(
            "{kind} '{name}': default {old} -> {new}", kind=new.kind.title, name=new.name, old=before, new=after
        )
        yield text, None, Detail.DEFAULT


def _compare_types(
    old: SourceName, new: SourceName, *, is_computed: bool, has_other_class: bool
) -> Iterator[tuple[Phrase, Phrase | None]]:
    if new.kind is NameKind.FUNCTION:
        reason: Phrase | None = phrase("code that calls '{name}' with the old arguments does not build", name=new.name)
        if (Detail.REQUIRED, YES) in old.details:
            reason = phrase("classes that derive from the class and do not define it do not build")
        elif accepts_all(old.type, new.type) and not has_other_class:
            reason = None
        yield format_overload_change(new.name, old.type, new.type), reason
    elif new.kind in (NameKind.PARAMETER, NameKind.HARDWARE_PARAMETER, NameKind.OPTION, NameKind.ELEMENT):
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
        if new.kind is not NameKind.MEMBER:
            yield text, _make_type_reason(new, is_computed=is_computed)
        elif is_convertible(old.type, new.type):
            yield text, None
        else:
            yield text, phrase("code that uses it as '{type}' does not build", type=old.type)


def make_scope_reason(old: SourceName, new: SourceName) -> Phrase:
    """Return the reason why a name that becomes absolute or relative is breaking, maybe with another type."""
    if old.type and new.type and old.type != new.type and new.kind in GRAPH_KINDS:
        return _make_type_reason(replace(new, name=old.name), is_computed=False)
    return phrase("if the node has a namespace, programs that use the name '{name}' do not find it", name=old.name)


def _make_type_reason(item: SourceName, *, is_computed: bool) -> Phrase:
    """Return the reason why another type of messages is breaking."""
    if item.kind in _CLIENT_KINDS:
        if is_computed:
            return phrase("servers with the old type do not answer")
        return phrase("servers of '{name}' with the old type do not answer", name=item.name)
    if is_computed:
        return phrase("programs that use the name with the old type get nothing")
    return phrase("programs that use '{name}' with the old type get nothing", name=item.name)


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


def has_same_parameters(old: str, new: str) -> bool:
    """Return whether the overloads of a function have the same types, though one version may leave out namespaces."""
    overloads = [[_split_overloads(text) for text in types.split("; ")] for types in (old, new)]
    return [len(overload) for overload in overloads[0]] == [len(overload) for overload in overloads[1]] and all(
        is_same_type(*types) for pair in zip(*overloads, strict=True) for types in zip(*pair, strict=True)
    )


def _split_overloads(text: str) -> list[str]:
    return re.split(r", (?![^<]*>)", text) if text else []


def _accepts(old: list[str], new: list[str]) -> bool:
    required = [parameter for parameter in old if not parameter.endswith(_DEFAULT)]
    types = [[parameter.removesuffix(_DEFAULT) for parameter in parameters] for parameters in (old, new)]
    accepts_types = len(new) >= len(old) and all(map(accepts_type, *types))
    return accepts_types and all(parameter.endswith(_DEFAULT) for parameter in new[len(required) :])


def _find_detail_reason(name: SourceName, detail: Detail, before: str | None, after: str | None) -> Phrase | None:
    """Return the reason why a changed property is breaking, or None if it is not."""
    old, new = before or "", after or ""
    if detail is Detail.QOS:
        return find_qos_reason(name, old, new)
    if detail is Detail.RESULT:
        reason = phrase("code that uses the result as '{type}' does not build", type=old)
        return None if can_use_result(old, new) else reason
    if detail is Detail.RETURNED:
        return phrase("programs that use the result get None")
    if detail is Detail.RETURNED_COUNT:
        return phrase("programs that unpack {count} values fail", count=old)
    if detail is Detail.BASES:
        lost = sorted(set(old.split(", ")) - set(new.split(", ")))
        reason = phrase("programs that load the class as '{type}' do not find it", type=", ".join(lost))
        return reason if lost else None
    if detail is Detail.CONSTANT:
        return phrase("code that calls '{name}' on constant objects does not build", name=name.name)
    if detail is Detail.VALUE_TYPE and name.kind is NameKind.PARAMETER and before and after:
        return phrase("values of the old type are rejected")
    if detail in (Detail.MINIMUM, Detail.MAXIMUM) and Detail.LEVEL not in dict(name.details):
        return _find_limit_reason(detail, before, after)
    if detail is Detail.READ_AS and rejects_values(old, new):
        return phrase("values of the old type are not read")
    if detail is Detail.REQUIRED and name.kind is NameKind.FUNCTION:
        return phrase("classes that derive from the class and do not define it do not build") if after else None
    if detail is Detail.REQUIRED and after:
        return make_required_reason(name.kind, [name.name])
    if detail is Detail.ARGUMENTS:
        old_signature, new_signature = parse_signature(old), parse_signature(new)
        is_accepted = old_signature is None or new_signature is None or new_signature.accepts_calls_of(old_signature)
        return (
            None if is_accepted else phrase("programs that call '{name}' with the old arguments fail", name=name.name)
        )
    if detail is Detail.SHORT_FORM:
        lost = sorted(set(old.split(", ")) - {*new.split(", "), ""})
        return phrase("callers that pass {names} get an error", names=quote_first(lost)) if lost else None
    if detail is Detail.LATCH and before:
        return phrase("subscribers that start later do not get the last message")
    return None


def _find_limit_reason(detail: Detail, before: str | None, after: str | None) -> Phrase | None:
    """Return the reason why another limit of a parameter of ROS 2 is breaking; None if it rejects no more values.

    dynamic_reconfigure has levels, and sets a value to the limit instead.
    """
    if after is None:
        return None
    limits = _read_number(before or ""), _read_number(after)
    if before is not None and None in limits:
        return None  # a constant whose value is not known here
    old, new = limits[0] or 0.0, limits[1] or 0.0
    if detail is Detail.MINIMUM and (before is None or new > old):
        return phrase("values below {limit} are rejected", limit=after)
    if detail is Detail.MAXIMUM and (before is None or new < old):
        return phrase("values above {limit} are rejected", limit=after)
    return None


def _read_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def make_required_reason(kind: NameKind, names: Sequence[str]) -> Phrase:
    """Return the reason why an option or parameter without a default is breaking."""
    text = quote_first(names)
    if kind in (NameKind.PARAMETER, NameKind.YAML_KEY):
        return phrase("the program fails where {names} is not set", names=text)
    if kind is NameKind.HARDWARE_PARAMETER:
        return phrase("the hardware fails where the description does not give {names}", names=text)
    if kind is NameKind.HARDWARE_ELEMENT:
        return phrase("the hardware fails where the description does not have {names}", names=text)
    return phrase("callers that do not pass {names} get an error", names=text)


def find_required_reason(items: Sequence[SourceName]) -> Phrase | None:
    """Return the reason why added names are breaking, or None if none of them is required."""
    names = [item.name for item in items if (Detail.REQUIRED, YES) in item.details]
    undefined = [item.name for item in items if (Detail.UNDEFINED, YES) in item.details]
    if not names and undefined:
        return phrase("where {names} is not set, its variable has no value", names=quote_first(undefined))
    if not names:
        return None
    if items[0].kind is NameKind.FUNCTION:
        return phrase("classes that derive from the class and do not define it do not build")
    return make_required_reason(items[0].kind, names)


def read_service_qos(text: str | None) -> tuple[tuple[Detail, str], ...]:
    """Return the QoS of a service or its client as details; empty if the text is another expression.

    Args:
        text: the argument as written; None if there is none, for the default QoS.
    """
    if text is None or _SERVICES_DEFAULT.fullmatch(text):
        return ((Detail.QOS, _DEFAULT_QOS),)
    return ((Detail.QOS, text),) if _QOS.fullmatch(text) else ()
