"""Compare the namespaces of a C++ header."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase, quoted_names
from linkwright.review.sources.names import SourceNames


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


def compare_namespaces(old: SourceNames, new: SourceNames) -> Iterator[HeaderChange]:
    """Yield the namespaces that a header no longer has. A namespace that replaces the only lost one is a new name."""
    lost, added = ([name for name in side if name not in other] for side, other in (
        (old.namespaces, new.namespaces), (new.namespaces, old.namespaces),
    ))  # fmt: skip
    if not lost:
        return
    names = quoted_names(lost)
    reason = phrase("code of other packages that uses '{name}' does not build", name=", ".join(lost))
    if len(lost) == len(added) == 1:
        text = phrase("namespace '{old}' renamed to '{new}'", old=lost[0], new=added[0])
        yield HeaderChange(text, new.namespaces[added[0]], reason)
    else:
        yield HeaderChange(
            phrase("namespaces removed: {names}", names=names), old.namespaces[lost[0]], reason, is_old=True
        )
