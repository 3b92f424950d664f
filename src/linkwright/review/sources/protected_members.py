"""Find the protected members that the classes of a C++ header lost."""

from __future__ import annotations

from linkwright.review.sources.names import NameKind, SourceName, SourceNames

_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)


def find_lost_protected(old: SourceNames, new: SourceNames) -> list[SourceName]:
    """Return the protected members that derived classes can no longer use.

    Members of a lost class are left out, as are those that another class of the header has, such as a base class.
    """
    classes = {item.name for item in new.of_kind(NameKind.CLASS)} | new.hidden_classes
    public = [item for item in new.names if item.kind in _KINDS]
    usable = {item.name.rpartition("::")[2] for item in (*public, *new.protected)} | new.overrides
    lost = {item.name: item for item in old.protected if item.name.rpartition("::")[2] not in usable}
    return [item for item in lost.values() if item.name.split("::")[-2] in classes]
