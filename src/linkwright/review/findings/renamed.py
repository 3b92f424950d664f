"""Find findings that are as old as a robot, although a renamed link or joint is in their message."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from linkwright.diagnostics import Diagnostic
from linkwright.review.changes import Change, Subject
from linkwright.review.findings.comparing import QUOTED_NAME

_ARROW = " -> "


def drop_renamed_findings(
    subjects: Iterable[Subject],
    added: Sequence[Diagnostic],
    fixed: Sequence[Diagnostic],
    new_paths: Mapping[str, str],
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """Return new and fixed findings without the pairs that differ only in the name of a renamed thing.

    Args:
        subjects: the compared subjects with their changes, which tell the renames.
        added: the findings that only the new version has, with relative paths.
        fixed: the findings that only the old version has, with relative paths.
        new_paths: the new paths of renamed files, by old path.
    """
    renames = {pair for subject in subjects for change in subject.changes for pair in _list_renames(change)}
    left_fixed = list(fixed)
    left_added = []
    for finding in added:
        match = next((old for old in left_fixed if renames and _are_same(old, finding, renames, new_paths)), None)
        if match is None:
            left_added.append(finding)
        else:
            left_fixed.remove(match)
    return left_added, left_fixed


def _list_renames(change: Change) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of the links, joints or extensions that a change renames."""
    arguments = change.core.arguments
    if "old" not in arguments or "new" in arguments or not change.name:
        return
    yield str(arguments["old"]), change.name
    for name in change.other_names:
        old, arrow, new = name.partition(_ARROW)
        if arrow:
            yield old, new


def _are_same(old: Diagnostic, new: Diagnostic, renames: set[tuple[str, str]], new_paths: Mapping[str, str]) -> bool:
    """Return whether two findings of one rule about one file differ only in renamed names."""
    old_path, new_path = (None if finding.span is None else str(finding.span.file) for finding in (old, new))
    if old.code != new.code or old_path is None or new_paths.get(old_path, old_path) != new_path:
        return False
    old_message, new_message = str(old.message), str(new.message)
    if QUOTED_NAME.sub("''", old_message) != QUOTED_NAME.sub("''", new_message):
        return False
    names = zip(QUOTED_NAME.findall(old_message), QUOTED_NAME.findall(new_message), strict=True)
    return all(pair[0] == pair[1] or pair in renames for pair in names)
