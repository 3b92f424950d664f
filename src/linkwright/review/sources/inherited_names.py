"""Find names that a class of C++ inherits from classes of the repository."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.review.sources.changed_sources import get_comparison_name
from linkwright.review.sources.names import NameKind, SourceName, SourceNames


def drop_inherited(items: dict[str, SourceName], inherited: Sequence[SourceNames]) -> dict[str, SourceName]:
    """Return the names, by the ones by which they are compared, that no source of a base class has."""
    known = {(item.kind, get_comparison_name(item)) for names in inherited for item in names.names}
    return {name: item for name, item in items.items() if (item.kind, name) not in known}


def list_new_expressions(
    kind: NameKind, sources: Sequence[SourceNames], old: Sequence[SourceName]
) -> Iterator[SourceName]:
    """Yield the computed names of a kind in sources of base classes that an old source does not have."""
    known = {item.name for item in old}
    expressions = (item for names in sources for item in names.expressions)
    return (item for item in expressions if item.kind is kind and item.name not in known)
