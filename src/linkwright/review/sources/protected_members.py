"""Compare the protected members of the classes of a C++ header, which derived classes use."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import phrase
from linkwright.review.sources.details import accepts_all, format_names, format_overload_change
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.sources.namespaces import HeaderChange

_OR = " or "
_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)


def compare_protected(old: SourceNames, new: SourceNames) -> Iterator[HeaderChange]:
    """Yield the changes to protected members of classes that both versions of a header have."""
    added, lost = _find_lost(new, old), _find_lost(old, new)
    if added:
        text = phrase("protected members added: {names}", names=format_names(added))
        yield HeaderChange(text, added[0].span)
    if lost:
        text = phrase("protected members removed: {names}", names=format_names(lost))
        reason = phrase("classes that derive from the class and use the members do not build")
        yield HeaderChange(text, lost[0].span, reason, is_old=True)
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
        return HeaderChange(text, new.span)
    text = phrase("protected {change}", change=format_overload_change(new.name, old.type, new.type))
    reason = phrase("classes that derive from the class and call or define '{name}' do not build", name=new.name)
    return HeaderChange(text, new.span, None if accepts_all(old.type, new.type) else reason)
