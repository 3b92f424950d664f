"""Divide a report into sections that list changes of shared files and equal changes of several files once."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from linkwright.diagnostics import Diagnostic, Phrase, counted, joined_first, phrase, quoted_names
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.changes import Change, Effect, Review, Subject
from linkwright.review.other_files import group_files

_MAX_NAMES = 24
"""The maximum number of other links or joints that a line names."""
_MAX_BREAKING_NAMES = 12
"""The maximum number of other links or joints in a line about a breaking change. Users may search for them."""
_MAX_PATHS = 4
"""The maximum number of other files that a line names."""
_MAX_NAMED_CASES = 1
"""The maximum number of argument sets that a line names."""

_MAX_ARGUMENTS = 4
"""The maximum number of arguments of an argument set that a line names."""
_ARGUMENT = re.compile(r" (?=[\w.-]+:=)")
"""The space between two arguments in the name of an argument set."""


@dataclass(frozen=True)
class Section:
    """A subject in a report.

    Attributes:
        subject: the reviewed file.
        changes: its changes, breaking changes first, without the changes listed in an earlier section.
        repeated: the number of changes that an earlier section lists, by the path of its subject.
        alike: the paths of other subjects of the same kind with the same changes. They have no section.
    """

    subject: Subject
    changes: Sequence[Change]
    repeated: Sequence[tuple[str, int]]
    alike: list[str] = field(default_factory=list)


def sections_of(review: Review) -> list[Section]:
    """Return the sections of a report.

    A macro that several descriptions include causes the same change in each of them, perhaps with other names. An edit
    of many launch files, parameter files or manifests often causes the same changes in each of them.
    """
    sections: list[Section] = []
    with_contents: dict[Hashable, Section] = {}
    for section in _make_sections(review):
        first = with_contents.setdefault(_comparison_key(section), section)
        if first is section:
            sections.append(section)
        else:
            first.alike.append(section.subject.path)
    return sections


def _comparison_key(section: Section) -> Hashable:
    """Return a key that is equal for sections with the same changes and nothing else."""
    subject = section.subject
    if section.repeated or subject.problems or subject.images or subject.paths or subject.scene:
        return subject.path
    if _has_contents(section):
        return subject.path
    figures = ((str(figure.name), figure.old, figure.new) for figure in subject.figures)
    return subject.kind, *(_text_key(change) for change in section.changes), *figures


def _has_contents(section: Section) -> bool:
    """Return whether a section summarizes a file that only one version has. Similar files may differ in the rest."""
    is_lone = None in (section.subject.old_path, section.subject.new_path)
    return is_lone and (
        len(section.changes) > 1 or any("items" in change.sentence.arguments for change in section.changes)
    )


def _text_key(change: Change) -> Hashable:
    return change.effect, str(sentence_of(change)), str(change.reason), change.cases


def _make_sections(review: Review) -> Iterator[Section]:
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
        changes = _merge_places(changes)
        changes.sort(key=lambda change: change.effect is not Effect.BREAKING)
        yield Section(subject, changes, list(repeated.items()))


def _merge_places(changes: Sequence[Change]) -> list[Change]:
    """Return the changes, with equal sentences about several places of a file merged."""
    groups: dict[Hashable, list[Change]] = {}
    for change in changes:
        groups.setdefault(_text_key(change), []).append(change)
    return [_join_places(group) for group in groups.values()]


def _join_places(changes: Sequence[Change]) -> Change:
    others = [location for change in changes[1:] for location in (change.location, *change.other_locations) if location]
    return replace(changes[0], other_locations=(*changes[0].other_locations, *others)) if others else changes[0]


def breaking_changes(review: Review) -> list[tuple[list[str], Change]]:
    """Return the breaking changes with the paths of their subjects. Equal changes of several subjects are merged."""
    groups: dict[Hashable, tuple[dict[str, None], Change]] = {}
    for subject, change in review.breaking_changes:
        groups.setdefault(_text_key(change), ({}, change))[0][subject.path] = None
    return [(list(paths), change) for paths, change in groups.values()]


def sentence_of(change: Change) -> Phrase:
    """Return a change in one line, with the other links or joints that it applies to, or the number of places."""
    names = change.other_names
    if not names and change.other_locations:
        return _with_count(change.sentence, 1 + len(change.other_locations))
    if not names:
        return change.sentence
    limit = _MAX_BREAKING_NAMES if change.effect is Effect.BREAKING else _MAX_NAMES
    listed = quoted_names(names[:limit])
    if len(names) <= limit:
        return phrase("{change}; also {names}", change=change.sentence, names=listed)
    more = len(names) - limit
    return phrase("{change}; also {names} and {count} more", change=change.sentence, names=listed, count=more)


def cases_text(change: Change, subject: Subject) -> Phrase | None:
    """Return the argument sets with which a change occurs, or None if it occurs with all of them."""
    if not change.cases:
        return None
    cause = _common_cause(change.cases, subject.cases)
    if cause is not None:
        return cause
    names = [_distinct_values(name, subject.cases or change.cases) for name in change.cases]
    if names == [""]:
        return phrase("with the default arguments")
    if len(names) <= _MAX_NAMED_CASES:
        return phrase("with {arguments}", arguments=", ".join(names))
    return phrase("with {count} of {total} argument sets", count=len(names), total=len(subject.cases))


def _common_cause(cases: Sequence[str], all_cases: Sequence[str]) -> Phrase | None:
    """Return the argument that all sets with a change have and no other set has, or vice versa.

    Returns None unless there is exactly one such argument. An argument is preferred that the other sets have with
    other values.
    """
    words = [set(_ARGUMENT.split(case)) - {""} for case in cases]
    others = [set(_ARGUMENT.split(case)) - {""} for case in all_cases if case not in cases]
    if not others:
        return None
    cause = _find_common_argument(words, others)
    if cause is not None:
        return phrase("with {arguments}", arguments=cause)
    cause = _find_common_argument(others, words)
    return None if cause is None else phrase("without {arguments}", arguments=cause)


def _find_common_argument(sets: Sequence[set[str]], others: Sequence[set[str]]) -> str | None:
    """Return the argument that all sets have and no other set has, or None unless there is exactly one."""
    causes = sorted(set.intersection(*sets) - set().union(*others))
    named = [cause for cause in causes if all(_has_argument(other, cause) for other in others)]
    found = named or causes
    return found[0] if len(found) == 1 else None


def _has_argument(words: set[str], cause: str) -> bool:
    return any(word.startswith(cause.partition(":=")[0] + ":=") for word in words)


def _distinct_values(name: str, cases: Sequence[str]) -> str:
    """Return the values that distinguish an argument set from the first set, or the first set from the others."""
    words = [set(_ARGUMENT.split(case)) for case in cases]
    others = set.intersection(*words) if name == cases[0] else words[0]
    distinct = [word for word in _ARGUMENT.split(name) if word not in others]
    return " ".join([*distinct[:_MAX_ARGUMENTS], *(["..."] if len(distinct) > _MAX_ARGUMENTS else [])]) or name


def repeated_text(path: str, count: int) -> Phrase:
    """Return the line for changes that an earlier section lists."""
    return counted(
        "the same change in a shared file as in {path}",
        "the same {count} changes in shared files as in {path}",
        count,
        path=path,
    )


def group_findings(findings: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the findings. Equal findings in a file are merged, with their number in the message."""
    groups: dict[Hashable, list[Diagnostic]] = {}
    for finding in findings:
        file = None if finding.span is None else finding.span.file
        groups.setdefault((finding.code, file, str(finding.message)), []).append(finding)
    return [
        first if not others else first.with_changes(message=_with_count(as_phrase(first.message), 1 + len(others)))
        for first, *others in groups.values()
    ]


def _with_count(text: Phrase, count: int) -> Phrase:
    return phrase("{change} ({count} times)", change=text, count=count)


def paths_text(paths: Sequence[str]) -> Phrase:
    """Return paths in one line, with the number of the remaining ones."""
    return joined_first(paths, _MAX_PATHS)


def alike_text(section: Section) -> Phrase | None:
    """Return the line for other files with the same changes, or None if there are none."""
    if not section.alike:
        return None
    return counted(
        "the same in one more file: {paths}",
        "the same in {count} more files: {paths}",
        len(section.alike),
        paths=paths_text(section.alike),
    )


def summary_text(review: Review) -> Phrase:
    """Return the number of changes and findings in one line."""
    breaking = total = 0
    for section in sections_of(review):
        count = 1 + len(section.alike)
        total += count * len(section.changes)
        breaking += count * sum(change.effect is Effect.BREAKING for change in section.changes)
    return phrase(
        "{breaking}, {changes}, {findings}, {fixed}",
        breaking=counted("{count} breaking change", "{count} breaking changes", breaking),
        changes=counted("{count} change", "{count} changes", total),
        findings=counted("{count} new finding", "{count} new findings", len(review.new_findings)),
        fixed=counted("{count} fixed", "{count} fixed", len(review.fixed_findings)),
    )


def other_files(review: Review) -> list[tuple[str, Phrase | None]]:
    """Return the paths and states of the files that were not compared, with several files of a folder as one."""
    lines: list[tuple[str, Phrase | None]] = []
    for path, count, state in group_files(review.other_files, review.file_states):
        if count > 1 and state is not None:
            state = phrase("{count} files, {state}", count=count, state=state)
        lines.append((path, state))
    return lines
