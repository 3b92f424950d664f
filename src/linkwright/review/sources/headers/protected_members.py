"""Compare the protected members and private virtual functions of a C++ header, which derived classes use or define."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import phrase
from linkwright.review.sources.cpp.types import is_convertible
from linkwright.review.sources.details import accepts_all, format_names, format_overload_change
from linkwright.review.sources.names import YES, Detail, NameKind, SourceName, SourceNames
from linkwright.review.sources.namespaces import HeaderChange

_OR = " or "
_VIRTUAL = (Detail.REQUIRED, YES)
"""The detail of a private function that derived classes must define."""
_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)


def compare_protected(old: SourceNames, new: SourceNames) -> Iterator[HeaderChange]:
    """Yield the changes to protected members of classes that both versions of a header have."""
    for names, others, is_old in ((new, old, False), (old, new, True)):
        lost = _find_lost(names, others)
        for is_virtual in (False, True):
            items = [item for item in lost if (_VIRTUAL in item.details) is is_virtual]
            if items:
                yield _make_list(items, is_virtual=is_virtual, is_old=is_old)
    before = _join_types(old.protected)
    for item in _join_types(new.protected).values():
        other = before.get((item.kind, item.name))
        if other is None:
            continue
        resolved = old.resolve_aliases(other.type), new.resolve_aliases(item.type)
        if resolved[0] != resolved[1]:
            if other.type == item.type:  # the header gives the name to another type
                other, item = replace(other, type=resolved[0]), replace(item, type=resolved[1])
            yield _compare_types(other, item)


def _make_list(items: Sequence[SourceName], *, is_virtual: bool, is_old: bool) -> HeaderChange:
    """Return the change for members that only one version has."""
    names = format_names(items)
    if is_virtual:
        removed = phrase("private virtual functions removed: {names}", names=names)
        added = phrase("private virtual functions added: {names}", names=names)
        reason = phrase("classes that derive from the class do not build")
        return HeaderChange(removed if is_old else added, items[0].span, reason, is_old=is_old)
    if not is_old:
        return HeaderChange(phrase("protected members added: {names}", names=names), items[0].span)
    reason = phrase("classes that derive from the class and use the members do not build")
    return HeaderChange(phrase("protected members removed: {names}", names=names), items[0].span, reason, is_old=True)


def _join_types(items: Sequence[SourceName]) -> dict[tuple[NameKind, str], SourceName]:
    """Return the members by kind and name. One that branches of the preprocessor declare has the types of all."""
    joined: dict[tuple[NameKind, str], SourceName] = {}
    for item in items:
        key = item.kind, item.name
        types = {*joined[key].type.split(_OR), item.type} if key in joined else {item.type}
        joined[key] = replace(joined.get(key, item), type=_OR.join(sorted(types)))
    return joined


def _find_lost(old: SourceNames, new: SourceNames) -> list[SourceName]:
    """Return the protected members that derived classes can no longer use.

    Members of a lost class are left out, as are those that another class of the header has, such as a base class.
    """
    classes = {item.name for item in new.of_kind(NameKind.CLASS)} | new.hidden_classes
    public = [item for item in new.names if item.kind in _KINDS]
    names = {item.name for item in (*public, *new.protected)} | new.overrides
    usable = {name.rpartition("::")[2] for name in names}
    lost = {item.name: item for item in old.protected if item.name.rpartition("::")[2] not in usable}
    return [item for item in lost.values() if item.name.split("::")[-2] in classes]


def _compare_types(old: SourceName, new: SourceName) -> HeaderChange:
    """Return the change of the type of a member, or of the parameters of a function."""
    if new.kind is not NameKind.FUNCTION:
        text = phrase("protected member '{name}': type {old} -> {new}", name=new.name, old=old.type, new=new.type)
        reason = phrase("classes that derive from the class and use it as '{type}' do not build", type=old.type)
        return HeaderChange(text, new.span, None if is_convertible(old.type, new.type) else reason)
    change = format_overload_change(new.name, old.type, new.type)
    is_virtual = _VIRTUAL in new.details
    text = phrase("private {change}", change=change) if is_virtual else phrase("protected {change}", change=change)
    reason = phrase("classes that derive from the class and call or define '{name}' do not build", name=new.name)
    return HeaderChange(text, new.span, None if accepts_all(old.type, new.type) else reason)
