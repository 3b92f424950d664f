"""Write the sentences of a report: changes, argument sets, places, findings and other files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase, quoted, quoted_names
from linkwright.diagnostics.translation import localized
from linkwright.review.argument_sets import ARGUMENT, find_distinct_arguments
from linkwright.review.changes import Change, Effect, Figure, Location, Review, Subject, SubjectKind, ViewImages
from linkwright.review.other_files import group_files
from linkwright.review.texts.excerpts import shorten
from linkwright.review.texts.numbered_names import find_runs

_HASH = re.compile(r"\b[0-9a-f]{40}\b")
_HASH_CHARACTERS = 10
_MAX_NAMES = 24
"""The maximum number of other links or joints that a line names."""
_MAX_BREAKING_NAMES = 12
"""The maximum number of other links or joints in a line about a breaking change. Users may search for them."""
_MIN_KEYS = 3
"""The minimum number of keys in the path of a parameter of which other paths repeat all but one."""
_MAX_PATHS = 4
"""The maximum number of other files that a line names."""
_MAX_IMAGE_NOTES = 3
"""The maximum number of notes below images."""
_MAX_MISSING = 100
"""The maximum number of characters of a change that a file does not share with another."""
_MAX_NAMED_MISSING = 2
"""The maximum number of such changes that a line names. A reader does not take files with more of them for equal."""
_MAX_REPEATED_CASES = 40
"""The maximum number of characters of argument sets that several lines in succession repeat."""
_MAX_HEADING = 120
"""The maximum number of characters of a line, or of the start of a longer one, that is emphasized."""
_COLON = re.compile(r":(?= )|：")
_MAX_NAMED_CASES = 1
"""The maximum number of argument sets that a line names."""


def format_title(review: Review) -> Phrase:
    """Return the title of a report, with the first characters of the hashes of commits."""
    old, new = (
        _HASH.sub(lambda match: match[0][:_HASH_CHARACTERS], name) for name in (review.old_name, review.new_name)
    )
    return phrase("Robot review: {old} to {new}", old=old, new=new or localized(phrase("working tree")))


class Repeat(NamedTuple):
    """Changes that an earlier section lists.

    Attributes:
        path: the path of the subject of that section.
        change_count: the number of changes.
        is_shared: whether they are changes to files that both subjects include.
        more_names: the names of links, joints or parts that change here and not there.
        missing: the changes of that section that this one lacks.
        total: the number of changes of that section that are not breaking; 0 for changes in shared files.
    """

    path: str
    change_count: int
    is_shared: bool
    more_names: tuple[str, ...] = ()
    missing: tuple[Phrase, ...] = ()
    total: int = 0

    @property
    def names_missing(self) -> bool:
        """Whether the line names the changes that are missing."""
        return 0 < len(self.missing) <= min(_MAX_NAMED_MISSING, self.change_count - 1)


def get_path_state(subject: Subject) -> Phrase | None:
    """Return whether a source was added or removed; None for other files, whose changes tell it."""
    if subject.kind is not SubjectKind.SOURCE or None not in (subject.old_path, subject.new_path):
        return None
    return phrase("added") if subject.old_path is None else phrase("removed")


def format_change(change: Change) -> Phrase:
    """Return a change in one line, with the other links or joints, or the number of locations."""
    names: Sequence[str] = change.other_names
    if not names and change.other_locations:
        return add_count(change.sentence, 1 + len(change.other_locations))
    if not names:
        return change.sentence
    names = _shorten_paths(str(change.sentence.arguments.get("parameter", "")), names)
    is_breaking = change.effect is Effect.BREAKING
    limit = _MAX_BREAKING_NAMES if is_breaking else _MAX_NAMES
    shown = [[name] for name in names] if is_breaking else find_runs(names)
    more = sum(map(len, shown[limit:]))
    if more == 1:
        limit, more = len(shown), 0
    listed = joined(map(_quote_run, shown[:limit]))
    if not more:
        return phrase("{change}; also {names}", change=change.sentence, names=listed)
    return phrase("{change}; also {names} and {count} more", change=change.sentence, names=listed, count=more)


def split_heading(text: str) -> tuple[str, str]:
    """Return the start of a long line up to its last colon, and the rest, such as the contents of a removed file.

    The rest is empty if the whole line is short, or has no colon near its start.
    """
    if len(text) <= _MAX_HEADING:
        return text, ""
    ends = [match.end() for match in _COLON.finditer(text, 0, _MAX_HEADING)]
    return (text[: ends[-1]], text[ends[-1] :]) if ends else (text, "")


def _quote_run(names: Sequence[str]) -> Phrase:
    """Return a name, or the first and the last of names with consecutive numbers, in quotation marks."""
    first = quoted(names[0])
    return first if len(names) == 1 else phrase("{first} to {last}", first=first, last=quoted(names[-1]))


def _shorten_paths(first: str, names: Sequence[str]) -> Sequence[str]:
    """Return the names of other parameters, or what differs in them if it is the same key on the same level."""
    keys = first.split(".")
    paths = [name.split(".") for name in names]
    if len(keys) < _MIN_KEYS or any(" " in name for name in names) or {*map(len, paths)} != {len(keys)}:
        return names
    levels = {level for path in paths for level, key in enumerate(path) if key != keys[level]}
    return names if len(levels) != 1 else [path[min(levels)] for path in paths]


def format_cases(change: Change, subject: Subject) -> Phrase | None:
    """Return the argument sets with which a change occurs, or None for all argument sets."""
    if not change.cases:
        return None
    cause = _find_common_cause(change.cases, subject.cases)
    if cause is not None:
        return cause
    names = [find_distinct_arguments(name, subject.cases or change.cases) for name in change.cases]
    if names == [""]:
        return phrase("with the default arguments")
    if len(names) <= _MAX_NAMED_CASES:
        return phrase("with {arguments}", arguments=", ".join(names))
    return phrase("with {count} of {total} argument sets", count=len(names), total=len(subject.cases))


def format_cases_of(changes: Sequence[Change], subject: Subject) -> list[Phrase | None]:
    """Return the argument sets of changes in the order of a report. Long ones are not repeated in the next line."""
    texts = [format_cases(change, subject) for change in changes]
    return [
        phrase("with the same arguments")
        if text is not None and text == previous and len(str(text)) > _MAX_REPEATED_CASES
        else text
        for previous, text in zip([None, *texts], texts, strict=False)
    ]


def _find_common_cause(cases: Sequence[str], all_cases: Sequence[str]) -> Phrase | None:
    """Return the argument that all sets with a change have and no other set has, or vice versa.

    Returns None unless there is exactly one such argument. An argument is preferred that the other sets have with
    other values.
    """
    words = [set(ARGUMENT.split(case)) - {""} for case in cases]
    others = [set(ARGUMENT.split(case)) - {""} for case in all_cases if case not in cases]
    if not others:
        return None
    cause = _find_common_argument(words, others)
    if cause is not None:
        return phrase("with {arguments}", arguments=cause)
    cause = _find_common_argument(others, words)
    return None if cause is None else phrase("without {arguments}", arguments=cause)


def _find_common_argument(sets: Sequence[set[str]], others: Sequence[set[str]]) -> str | None:
    """Return the only argument that all sets have and no other set has, or None."""
    causes = sorted(set.intersection(*sets) - set().union(*others))
    distinguishing = [cause for cause in causes if all(_has_argument(other, cause) for other in others)]
    candidates = distinguishing or causes
    return candidates[0] if len(candidates) == 1 else None


def _has_argument(words: set[str], cause: str) -> bool:
    return any(word.startswith(cause.partition(":=")[0] + ":=") for word in words)


def format_figure_name(figure: Figure) -> Phrase:
    """Return the name of a quantity, with the arguments with which it was measured if there are several sets."""
    if not figure.arguments:
        return figure.name
    return phrase("{quantity} (with {arguments})", quantity=figure.name, arguments=figure.arguments)


def format_image_notes(images: Sequence[ViewImages]) -> Phrase | None:
    """Return what is special about images, such as meshes that are not drawn, or None."""
    notes = list({str(note): note for view in images for note in view.notes}.values())
    return joined_first(notes, _MAX_IMAGE_NOTES) if notes else None


def format_repeated(repeat: Repeat) -> Phrase:
    """Return the line for changes that an earlier section lists, with what is not the same."""
    path, count = repeat.path, repeat.change_count
    if repeat.is_shared:
        text = counted(
            "the same change in a shared file as in {path}",
            "the same {count} changes in shared files as in {path}",
            count,
            path=path,
        )
        if repeat.more_names:
            return phrase("{change}, here also {names}", change=text, names=quoted_names(repeat.more_names))
        return text
    if not repeat.missing:
        return phrase("the same {count} changes as in {path}", path=path, count=count)
    text = phrase("{count} of the {total} changes of {path}", path=path, count=count, total=repeat.total)
    if not repeat.names_missing:
        return text
    missing = [shorten(str(item), _MAX_MISSING) for item in repeat.missing]
    return phrase("{change}, but not: {changes}", change=text, changes=joined(missing))


def add_count(text: Phrase, count: int) -> Phrase:
    """Return a sentence with the number of equal things that it is about."""
    return phrase("{change} ({count} times)", change=text, count=count)


def format_paths(paths: Sequence[str]) -> Phrase:
    """Return paths in one line, with the number of the remaining ones."""
    return joined_first(paths, _MAX_PATHS)


def format_location(location: Location, path: str) -> Phrase | str:
    """Return a place as the line of a file, or with its path if it is in another file than `path`."""
    if location.file == path:
        return phrase("line {line}", line=location.line)
    return f"{location.file}:{location.line}"


def format_alike(paths: Sequence[str | Phrase]) -> Phrase | None:
    """Return the line for other files with the same changes, or None if there are none."""
    if not paths:
        return None
    return counted(
        "the same in one more file: {paths}",
        "the same in {count} more files: {paths}",
        len(paths),
        paths=format_paths(paths),
    )


def format_code_heading(count: int) -> Phrase:
    """Return the heading of the section about sources of which only the code changed."""
    return counted("Only code changed in {count} source", "Only code changed in {count} sources", count)


def list_other_files(review: Review) -> list[tuple[str, Phrase | None]]:
    """Return the paths and states of the files that were not compared.

    Several files of a folder are listed as one.
    """
    lines: list[tuple[str, Phrase | None]] = []
    for path, count, state in group_files(review.other_files, review.file_states):
        if count > 1 and state is not None:
            state = phrase("{count} files, {state}", count=count, state=state)
        lines.append((path, state))
    return lines
