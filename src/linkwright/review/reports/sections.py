"""Divide a report into sections that list changes to shared files and equal changes to several files only once."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

from linkwright.diagnostics import Phrase, counted, joined, phrase
from linkwright.review.changes import Change, Effect, Review, Subject, SubjectKind
from linkwright.review.reports.sentences import Repeat, format_change
from linkwright.review.texts.merged_reasons import merge_reasons

_ORDER = {kind: number for number, kind in enumerate(SubjectKind)}
_MIN_REPEATED = 2
"""The minimum number of changes that a section replaces by the path of another section with the same changes."""
_MIN_UNCLEAR = 4
"""The minimum number of such changes if the other section has several more, so that they are only counted."""
_MIN_CODE_SECTIONS = 3
"""The minimum number of sources with only other code that share a section."""
_MIN_NAMES = 3
"""The minimum number of sentences that differ only in a name and are merged."""


_WORD = re.compile(r"[^\W_]*[^\W\d_][^\W_]*")
"""A word in a path with at least one letter."""
_TextKey = tuple[Effect, str, str, tuple[str, ...]]
"""The effect of a change, its sentence, its reason and its argument sets."""


@dataclass(frozen=True)
class Section:
    """A subject in a report.

    Attributes:
        subject: the reviewed file.
        changes: its changes, breaking changes first, without the changes listed in an earlier section.
        repeated: the changes that earlier sections list.
        alike: the paths of other subjects of the same kind with the same changes, perhaps with another name. They have
            no section.
    """

    subject: Subject
    changes: Sequence[Change]
    repeated: Sequence[Repeat]
    alike: list[str | Phrase] = field(default_factory=list)

    @property
    def has_only_code(self) -> bool:
        """Whether the section only names functions with other code."""
        subject = self.subject
        return not (self.repeated or subject.figures or subject.problems) and all(
            change.is_code for change in self.changes
        )


def divide_report(review: Review) -> list[Section]:
    """Return the sections of a report: robots first, and sources of which only the code changed last.

    A macro that several descriptions include causes the same change in each of them, perhaps with other names. An edit
    of many launch files, parameter files or manifests often causes the same changes in each of them.
    """
    folded = _fold_repeats(_divide_unfolded(review))
    return sorted(folded, key=lambda section: section.has_only_code)


def _divide_unfolded(review: Review) -> list[Section]:
    """Return the sections, also those that only repeat changes of shared files."""
    sections: list[Section] = []
    firsts: dict[Hashable, tuple[Section, tuple[str, str] | None]] = {}
    by_form: dict[Hashable, list[Section]] = {}
    for section in _make_sections(review):
        key, path = _make_comparison_key(section), section.subject.path
        if key not in firsts:
            is_alone = key == path or len(section.changes) < _MIN_REPEATED
            forms = [] if is_alone else by_form.setdefault(_make_form_key(section), [])
            renamed = ((other, names) for other in forms if (names := _find_renaming(other, section)) is not None)
            firsts[key] = next(renamed, (section, None))
            if firsts[key][0] is section:
                sections.append(section)
                forms.append(section)
                continue
        first, names = firsts[key]
        first.alike.append(
            path
            if names is None
            else phrase("{path} (with '{new}' instead of '{old}')", path=path, old=names[0], new=names[1])
        )
    return list(_replace_repeated(sections))


def _make_form_key(section: Section) -> Hashable:
    """Return a key that is equal for sections whose changes may differ only in names."""
    return section.subject.kind, *((change.effect, change.sentence.template) for change in section.changes)


def _find_renaming(first: Section, section: Section) -> tuple[str, str] | None:
    """Return the words of the paths whose replacement makes the changes of both sections equal, or None.

    Files for several robots often have the name of the robot in their path and in the names of their parts.
    """
    if first.subject.figures or section.subject.figures:
        return None
    old_words, new_words = (
        {word for name in _WORD.findall(item.subject.path) for word in (name, name.rstrip("0123456789")) if word}
        for item in (first, section)
    )
    old_keys, new_keys = (list(map(_make_text_key, item.changes)) for item in (first, section))
    pairs = product(sorted(old_words - new_words, key=len), sorted(new_words - old_words, key=len))
    return next((pair for pair in pairs if [_replace_name(key, *pair) for key in old_keys] == new_keys), None)


def _replace_name(key: _TextKey, old: str, new: str) -> _TextKey:
    effect, text, reason, cases = key
    return effect, text.replace(old, new), reason.replace(old, new), tuple(case.replace(old, new) for case in cases)


def separate_code(sections: Sequence[Section]) -> tuple[list[Section], list[Section]]:
    """Return the sections, and those that only name functions with other code if there are several."""
    code = [section for section in sections if section.has_only_code]
    if len(code) < _MIN_CODE_SECTIONS:
        return list(sections), []
    return [section for section in sections if not section.has_only_code], code


def _make_comparison_key(section: Section) -> Hashable:
    """Return a key that is equal for sections with the same changes and nothing else."""
    subject = section.subject
    if section.repeated or subject.problems or subject.images or subject.paths or subject.scene:
        return subject.path
    if _has_contents(subject, section.changes):
        return subject.path
    return subject.kind, *(_make_text_key(change) for change in section.changes), *_list_figures(section)


def _has_contents(subject: Subject, changes: Sequence[Change]) -> bool:
    """Return whether changes summarize a file that only one version has.

    Files with equal summaries may differ in what a summary omits.
    """
    is_lone = None in (subject.old_path, subject.new_path)
    return is_lone and (len(changes) > 1 or any("items" in change.sentence.arguments for change in changes))


def _make_text_key(change: Change) -> _TextKey:
    return change.effect, str(format_change(change)), str(change.reason), change.cases


def _make_sections(review: Review) -> Iterator[Section]:
    listed: dict[Hashable, tuple[str, Change]] = {}
    for subject in sorted(review.subjects, key=lambda subject: _ORDER[subject.kind]):
        changes = []
        repeated: dict[str, Repeat] = {}
        for change in subject.changes:
            first, same = subject.path, change
            if change.location is not None:
                first, same = listed.setdefault(change.identity, (subject.path, change))
            more_names = _find_more_names(same, change)
            if first == subject.path or more_names is None:
                changes.append(change)
                continue
            repeat = repeated.get(first, Repeat(first, 0, True))
            names = tuple(dict.fromkeys([*repeat.more_names, *more_names]))
            repeated[first] = repeat._replace(change_count=repeat.change_count + 1, more_names=names)
        changes = _merge_alike(subject, changes)
        changes.sort(key=lambda change: (change.effect is not Effect.BREAKING, change.is_code))
        yield Section(subject, changes, list(repeated.values()))


def _find_more_names(first: Change, change: Change) -> list[str] | None:
    """Return the names that a repeated change has and the first one lacks; None if too little is the same.

    Changes with as many names have other names for the same parts.
    """
    if len(change.other_names) <= len(first.other_names):
        return []
    first_names, names = first.other_names, change.other_names
    if first.name in names:
        first_names, names = (first.name, *first_names), (change.name, *names)
    return [name for name in names if name not in first_names] if set(first_names) <= set(names) else None


def _replace_repeated(sections: Sequence[Section]) -> Iterator[Section]:
    """Yield the sections. Changes that an earlier section about a file of the same kind lists are only counted.

    Breaking changes are listed in each section, and so is a change that is the only one in common.
    """
    listed: dict[Hashable, str] = {}
    by_path: dict[str, Section] = {}
    for section in sections:
        subject = section.subject
        by_path[subject.path] = section
        first_paths = [
            None
            if change.is_code or change.effect is Effect.BREAKING or _has_contents(subject, section.changes)
            else listed.setdefault((subject.kind, _make_text_key(change)), subject.path)
            for change in section.changes
        ]
        counts = Counter(path for path in first_paths if path is not None and path != subject.path)
        candidates = (_make_repeat(by_path[path], section, count) for path, count in counts.items())
        repeats = [repeat for repeat in candidates if _is_clear(repeat)]
        repeated = {repeat.path for repeat in repeats}
        changes = [change for change, path in zip(section.changes, first_paths, strict=True) if path not in repeated]
        yield replace(section, changes=changes, repeated=[*section.repeated, *repeats])


def _make_repeat(first: Section, section: Section, count: int) -> Repeat:
    """Return the changes that a section has in common with an earlier one."""
    total = sum(map(_is_repeatable, first.changes))
    return Repeat(first.subject.path, count, False, missing=_list_missing(first, section), total=total)


def _is_clear(repeat: Repeat) -> bool:
    """Return whether a line about repeated changes tells which they are, or takes the place of many lines."""
    if repeat.change_count < _MIN_REPEATED:
        return False
    return not repeat.missing or repeat.names_missing or repeat.change_count >= _MIN_UNCLEAR


def _is_repeatable(change: Change) -> bool:
    return change.effect is not Effect.BREAKING and not change.is_code


def _list_missing(first: Section, section: Section) -> tuple[Phrase, ...]:
    """Return the changes of an earlier section that another one lacks.

    Breaking changes are listed in each section, and so are other changes of the same parameter.
    """
    keys = {_make_text_key(change) for change in section.changes}
    parameters = {change.sentence.arguments.get("parameter") for change in section.changes} - {None}
    return tuple(
        change.sentence
        for change in first.changes
        if _is_repeatable(change) and _make_text_key(change) not in keys
        if change.sentence.arguments.get("parameter") not in parameters
    )


def _fold_repeats(sections: Iterable[Section]) -> list[Section]:
    """Return the sections. Those that only repeat all changes of an earlier section follow it as alike."""
    folded: list[Section] = []
    by_path: dict[str, Section] = {}
    for section in sections:
        subject = section.subject
        first = by_path.get(section.repeated[0].path) if len(section.repeated) == 1 else None
        has_more = section.changes or section.alike or subject.problems
        if (
            first is None
            or has_more
            or subject.images
            or subject.scene
            or first.repeated
            or _list_figures(first) != _list_figures(section)
            or first.subject.kind is not subject.kind
            or section.repeated[0].change_count != len(first.changes)
            or section.repeated[0].more_names
        ):
            folded.append(section)
            by_path[subject.path] = section
        else:
            first.alike.append(subject.path)
    return folded


def _list_figures(section: Section) -> list[tuple[str, str, str, str]]:
    return [(str(figure.name), figure.old, figure.new, figure.arguments) for figure in section.subject.figures]


def _merge_alike(subject: Subject, changes: Sequence[Change]) -> list[Change]:
    """Return the changes to a subject, with those that have the same cause in one line."""
    merged = _merge_names(_merge_locations(changes))
    is_removed_source = subject.kind is SubjectKind.SOURCE and subject.new_path is None
    return _merge_removed_names(merged) if is_removed_source else merged


def _merge_removed_names(changes: Sequence[Change]) -> list[Change]:
    """Return the changes to a removed source, with the names of all kinds that it offered in one breaking line."""
    removed = [change for change in changes if change.effect is Effect.BREAKING and _lists_removed_names(change)]
    if len(removed) < _MIN_REPEATED:
        return list(changes)
    reasons = list(dict.fromkeys(change.reason for change in removed if change.reason is not None))
    shown = list({reason.template: reason for reason in reversed(reasons)}.values())[::-1]
    reason = joined(shown, "; ")
    if len(shown) < len(reasons):
        reason = phrase("{reason}; likewise for the others", reason=reason)
    sentence = joined([change.sentence for change in removed], "; ")
    return [replace(removed[0], sentence=sentence, reason=reason), *(it for it in changes if it not in removed)]


def _lists_removed_names(change: Change) -> bool:
    return change.sentence.template == "{kind} removed: {names}"


def _merge_locations(changes: Sequence[Change]) -> list[Change]:
    """Return the changes, with equal sentences about several locations in a file merged."""
    groups: dict[Hashable, list[Change]] = {}
    for change in changes:
        groups.setdefault(_make_text_key(change), []).append(change)
    return [_join_locations(group) for group in groups.values()]


def _join_locations(changes: Sequence[Change]) -> Change:
    others = [location for change in changes[1:] for location in (change.location, *change.other_locations) if location]
    return replace(changes[0], other_locations=(*changes[0].other_locations, *others)) if others else changes[0]


def _merge_names(changes: Sequence[Change]) -> list[Change]:
    """Return the changes, with sentences that differ only in a name merged, such as those about removed arguments."""
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        groups.setdefault(_make_name_key(change) or number, []).append(change)
    merged: list[Change] = []
    for group in groups.values():
        merged += [_join_names(group)] if len(group) >= _MIN_NAMES else group
    return merged


def _make_name_key(change: Change) -> Hashable | None:
    """Return a key that is equal for sentences that differ only in their name. None for sentences without a name."""
    arguments = change.sentence.arguments
    name = arguments.get("name")
    if change.other_names or change.other_locations or not isinstance(name, str) or not name:
        return None
    others = tuple((key, str(value)) for key, value in arguments.items() if key != "name")
    reason = None if change.reason is None else str(change.reason).replace(f"'{name}'", "''")
    return change.effect, change.sentence.template, others, reason, change.cases


def _join_names(changes: Sequence[Change]) -> Change:
    names = tuple(str(change.sentence.arguments["name"]) for change in changes[1:])
    locations = tuple(change.location for change in changes[1:] if change.location is not None)
    reason = merge_reasons(change.reason for change in changes)
    return replace(changes[0], other_names=names, other_locations=locations, reason=reason)


def merge_breaking_changes(review: Review) -> list[tuple[list[str], Change]]:
    """Return the breaking changes with the paths of their subjects, in the order of the sections.

    Equal changes to several subjects are merged, also if they occur with different arguments, or remove a part with
    other values.
    """
    groups: dict[Hashable, tuple[dict[str, None], list[Change]]] = {}
    for subject in sorted(review.subjects, key=lambda subject: _ORDER[subject.kind]):
        breaking = [change for change in subject.changes if change.effect is Effect.BREAKING]
        for change in _merge_alike(subject, breaking):
            paths, changes = groups.setdefault(_make_breaking_key(change), ({}, []))
            paths[subject.path] = None
            changes.append(change)
    return [(list(paths), _join_values(changes)) for paths, changes in groups.values()]


def _make_breaking_key(change: Change) -> Hashable:
    part = _find_removed_part(change)
    return (str(format_change(change)) if part is None else f"{part} removed"), str(change.reason)


def _find_removed_part(change: Change) -> str | None:
    """Return the name of a part that is removed with its values; None for other changes."""
    is_part = change.sentence.template.startswith("{parameter} removed") and not change.other_names
    return str(change.sentence.arguments["parameter"]) if is_part else None


def _join_values(changes: Sequence[Change]) -> Change:
    """Return one change for equal changes. Values in which they differ are left out."""
    first = changes[0]
    part = _find_removed_part(first)
    if part is None or len({str(change.sentence) for change in changes}) == 1:
        return first
    return replace(first, sentence=phrase("{parameter} removed", parameter=part))


def format_summary(review: Review) -> Phrase:
    """Return the number of changes and findings in one line.

    Other quantities of a file without other changes, such as the size of a mesh, count as one change.
    """
    breaking = total = 0
    for section in _divide_unfolded(review):
        count = 1 + len(section.alike)
        repeated = sum(repeat.change_count for repeat in section.repeated if not repeat.is_shared)
        has_only_figures = bool(section.subject.figures) and not section.subject.changes
        total += count * (len(section.changes) + repeated + has_only_figures)
        breaking += count * sum(change.effect is Effect.BREAKING for change in section.changes)
    if not (total or review.new_findings or review.fixed_findings):
        if review.file_states:
            return counted(
                "only {count} other file changed", "only {count} other files changed", len(review.other_files)
            )
        new = review.new_name or phrase("the working tree")
        return phrase("nothing that a review compares changed from {old} to {new}", old=review.old_name, new=new)
    return phrase(
        "{breaking}, {changes}, {findings}, {fixed}",
        breaking=counted("{count} breaking change", "{count} breaking changes", breaking),
        changes=counted("{count} change", "{count} changes", total),
        findings=counted("{count} new finding", "{count} new findings", len(review.new_findings)),
        fixed=counted("{count} fixed", "{count} fixed", len(review.fixed_findings)),
    )
