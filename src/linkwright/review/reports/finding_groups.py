"""Merge the findings of a report that say the same about several things of a file."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Phrase, joined_first, phrase, quoted
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.reports.sentences import add_count

_MIN_ALIKE = 3
"""The minimum number of findings of a file, alike except for a name, that are one line."""
_MAX_NAMES = 12
"""The maximum number of other names in such a line."""


def group_findings(findings: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the findings, with equal and alike findings in a file merged.

    The message of equal findings contains their number, and that of alike findings the other names.
    """
    merged = (_merge_equal(group) for group in _group(findings, _make_equal_key))
    return [item for group in _group(list(merged), _make_alike_key) for item in _merge_alike(group)]


def _group(findings: Sequence[Diagnostic], make_key: Callable[[Diagnostic], str]) -> list[list[Diagnostic]]:
    groups: dict[Hashable, list[Diagnostic]] = {}
    for finding in findings:
        file = None if finding.span is None else finding.span.file
        groups.setdefault((finding.code, finding.severity, file, make_key(finding)), []).append(finding)
    return list(groups.values())


def _make_equal_key(finding: Diagnostic) -> str:
    return str(finding.message)


def _make_alike_key(finding: Diagnostic) -> str:
    return as_phrase(finding.message).template


def _merge_equal(group: Sequence[Diagnostic]) -> Diagnostic:
    first = group[0]
    return first if len(group) == 1 else first.with_changes(message=add_count(as_phrase(first.message), len(group)))


def _merge_alike(group: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield one finding for those whose messages differ in one argument, or all of them."""
    messages = [as_phrase(finding.message) for finding in group]
    differing = [name for name in messages[0].arguments if len({_read(message, name) for message in messages}) > 1]
    if len(group) < _MIN_ALIKE or len(differing) != 1:
        yield from group
        return
    names = joined_first((quoted(_read(message, differing[0])) for message in messages[1:]), _MAX_NAMES)
    yield group[0].with_changes(message=phrase("{change}; also {names}", change=messages[0], names=names))


def _read(message: Phrase, name: str) -> str:
    return str(message.arguments.get(name, ""))
