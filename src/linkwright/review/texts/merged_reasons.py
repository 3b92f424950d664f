"""Merge the reasons of breaking changes that share a line."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Phrase, phrase


def merge_reasons(reasons: Iterable[Phrase | None]) -> Phrase | None:
    """Return one reason for breaking changes whose reasons differ only in names.

    The result is None if the changes are not breaking.
    """
    distinct = list({str(reason): reason for reason in reasons}.values())
    first = distinct[0]
    return first if first is None or len(distinct) == 1 else phrase("{reason}; likewise for the others", reason=first)
