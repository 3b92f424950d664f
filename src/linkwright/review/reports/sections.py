"""The sections of a report, in which a change of a shared file is listed once."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, counted, phrase, quoted_names
from linkwright.review.changes import Change, Effect, Review, Subject

_MAX_NAMES = 3
"""The number of other links or joints that a line names."""
_MAX_NAMED_CASES = 1
"""The number of argument sets that a line names."""

_ARGUMENT = re.compile(r" (?=[\w.-]+:=)")
"""The space between two arguments in the name of an argument set."""


@dataclass(frozen=True)
class Section:
    """A subject in a report.

    Attributes:
        subject: the subject.
        changes: its changes, breaking ones first, without those that an earlier section lists.
        repeated: the number of changes that an earlier section lists, by the path of its subject.
    """

    subject: Subject
    changes: Sequence[Change]
    repeated: Sequence[tuple[str, int]]


def sections_of(review: Review) -> Iterator[Section]:
    """Yield the sections of a report.

    A macro that several descriptions include makes the same change in each of them, perhaps with other names.
    """
    listed: dict[Hashable, str] = {}
    for subject in review.subjects:
        changes = []
        repeated: Counter[str] = Counter()
        for change in subject.changes:
            first = listed.setdefault(change.identity, subject.path) if change.location else subject.path
            if first != subject.path:
                repeated[first] += 1
                continue
            changes.append(change)
        changes.sort(key=lambda change: change.effect is not Effect.BREAKING)
        yield Section(subject, changes, list(repeated.items()))


def sentence_of(change: Change) -> Phrase:
    """Return a change in one line, with the other links or joints to which it applies."""
    names = change.other_names
    if not names:
        return change.sentence
    listed = quoted_names(names[:_MAX_NAMES])
    if len(names) <= _MAX_NAMES:
        return phrase("{change}; also {names}", change=change.sentence, names=listed)
    more = len(names) - _MAX_NAMES
    return phrase("{change}; also {names} and {count} more", change=change.sentence, names=listed, count=more)


def cases_text(change: Change, subject: Subject) -> Phrase | None:
    """Return with which argument sets a change occurs, or None if it occurs with all of them."""
    if not change.cases:
        return None
    names = [_distinct_values(name, subject.cases or change.cases) or "-" for name in change.cases]
    if len(names) <= _MAX_NAMED_CASES:
        return phrase("with {arguments}", arguments=", ".join(names))
    return phrase("with {count} of {total} argument sets", count=len(names), total=len(subject.cases))


def _distinct_values(name: str, cases: Sequence[str]) -> str:
    """Return the values of an argument set that the first set does not have, or those that only the first set has."""
    words = [set(_ARGUMENT.split(case)) for case in cases]
    others = set.intersection(*words) if name == cases[0] else words[0]
    return " ".join(word for word in _ARGUMENT.split(name) if word not in others) or name


def repeated_text(path: str, count: int) -> Phrase:
    """Return the line for changes that an earlier section lists."""
    return counted(
        "the same change in a shared file as in {path}",
        "the same {count} changes in shared files as in {path}",
        count,
        path=path,
    )


def summary(review: Review) -> Phrase:
    """Return the number of changes and findings in one line."""
    breaking = len(review.breaking_changes)
    total = sum(len(section.changes) for section in sections_of(review))
    return phrase(
        "{breaking}, {changes}, {findings}, {fixed}",
        breaking=counted("{count} breaking change", "{count} breaking changes", breaking),
        changes=counted("{count} change", "{count} changes", total),
        findings=counted("{count} new finding", "{count} new findings", len(review.new_findings)),
        fixed=counted("{count} fixed", "{count} fixed", len(review.fixed_findings)),
    )
