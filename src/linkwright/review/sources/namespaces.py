"""Compare the namespaces of a C++ header."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase, quoted_names
from linkwright.review.breaking import quote_first
from linkwright.review.files.build.facts import list_names
from linkwright.review.sources.names import HEADER_SUFFIXES, NameKind, SourceNames
from linkwright.review.versions import Version


class HeaderChange(NamedTuple):
    """A change to the interface of a header.

    Attributes:
        text: the change in one line.
        span: the location.
        reason: why the change is breaking, or None.
        is_old: whether the location is in the old version.
    """

    text: Phrase
    span: Span
    reason: Phrase | None = None
    is_old: bool = False


def compare_namespaces(
    old: SourceNames, new: SourceNames, is_left: Callable[[str], bool] = lambda _: False
) -> Iterator[HeaderChange]:
    """Yield the namespaces that a header no longer has. A namespace that replaces the only lost one is a new name.

    If other headers still have the lost one, only the functions and classes of this header are in another namespace.

    Args:
        old: the names in the old version.
        new: the names in the new version.
        is_left: whether another header of the package still has a namespace. Such a namespace is not lost.
    """
    lost, added = ([name for name in side if name not in other] for side, other in (
        (old.namespaces, new.namespaces), (new.namespaces, old.namespaces),
    ))  # fmt: skip
    left = [name for name in lost if is_left(name)]
    if len(lost) == len(added) == len(left) == len(old.namespaces) == len(new.namespaces) == 1:
        yield from _find_moved_names(old, new, lost[0], added[0])
    lost = [name for name in lost if name not in left]
    if not lost:
        return
    names = quoted_names(lost)
    reason = phrase("code of other packages that uses {names} does not build", names=names)
    if len(lost) == len(added) == 1:
        text = phrase("namespace '{old}' renamed to '{new}'", old=lost[0], new=added[0])
        yield HeaderChange(text, new.namespaces[added[0]], reason)
    else:
        yield HeaderChange(
            phrase("namespaces removed: {names}", names=names), old.namespaces[lost[0]], reason, is_old=True
        )


def _find_moved_names(old_names: SourceNames, new_names: SourceNames, old: str, new: str) -> Iterator[HeaderChange]:
    """Yield a line about the functions and classes that are in another namespace now."""
    kinds = (NameKind.CLASS, NameKind.FUNCTION)
    before = {(item.kind, item.name) for item in old_names.names if item.kind in kinds}
    moved = [item for item in new_names.names if (item.kind, item.name) in before and "::" not in item.name]
    if moved:
        names = [item.name for item in moved]
        text = phrase("{names} moved from namespace '{old}' to '{new}'", names=list_names(names), old=old, new=new)
        used = quote_first(f"{old}::{name}" for name in names)
        yield HeaderChange(
            text, moved[0].span, phrase("code of other packages that uses {names} does not build", names=used)
        )


def has_namespace(version: Version, path: str, name: str) -> bool:
    """Return whether another header in the package of a header opens a namespace.

    Args:
        version: the version of the repository.
        path: the path of the header.
        name: the name of the namespace as written.
    """
    pattern = re.compile(rf"^[ \t]*(?:inline\s+)?namespace\s+{re.escape(name)}\s*\{{", re.MULTILINE)
    paths = version.paths(HEADER_SUFFIXES, version.package_of(path) or "")
    return any(pattern.search(version.text(other)) for other in paths if other != path)
