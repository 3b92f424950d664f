"""Make breaking changes of new findings about files without which a package cannot be built or a robot not be read."""

from __future__ import annotations

import posixpath
from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.review.changes import Change, Effect, Location, Subject, SubjectKind
from linkwright.review.kinds import find_rule
from linkwright.review.versions import Versions

_UNREADABLE_CODE = "XML101"
"""The finding about a description that includes a file which does not exist."""
_UNBUILDABLE_CODES = frozenset({"LW824", "LW825"})
"""The findings about build files that install a file which does not exist."""
_READER_PREFIX = "URDF"
"""The start of the codes of findings of the URDF reader, whose errors urdfdom refuses as well."""


def mark_failures(
    versions: Versions,
    subjects: Sequence[Subject],
    findings: Sequence[Diagnostic],
    fixed: Sequence[Diagnostic],
    old_findings: Sequence[Diagnostic],
) -> tuple[list[Subject], list[Diagnostic]]:
    """Return the subjects with breaking changes for findings that break a file, and the other findings.

    A line that already names the missing file becomes breaking. Files outside of the repository may exist, so that
    their findings are left out. A finding of a file whose old version had one of the same kind is left out, and so are
    errors of descriptions if the package had any. Only the first error of a description becomes breaking, unless a line
    tells that it can no longer be read.

    Args:
        versions: both versions.
        subjects: the compared files.
        findings: the new findings.
        fixed: the findings that only the old version has.
        old_findings: all findings of the old version.
    """
    broken_before = {(finding.code, finding.span.file) for finding in fixed if finding.span is not None}
    refused_before = {
        versions.old.package_of(path)
        for finding in old_findings
        if finding.span is not None
        and _is_refused(finding)
        and (path := versions.old.relative(finding.span.file)) is not None
    }
    refused = {subject.path for subject in subjects if subject.is_lost}
    old_paths = {file.new_path: file.old_path for file in versions.changed_files if file.new_path}
    result = {subject.path: subject for subject in subjects}
    others = []
    for finding in findings:
        if _is_outside(finding):
            continue
        path = "" if finding.span is None else finding.span.file
        reason, old_path = _find_reason(finding), old_paths.get(path, path)
        is_first = not {(finding.code, path), (finding.code, old_path)} & broken_before
        if _is_refused(finding):
            is_first = is_first and path not in refused and versions.old.package_of(path) not in refused_before
            refused.add(path)
        if (
            finding.span is None
            or reason is None
            or not (is_first and old_path and versions.old.file(old_path).is_file())
        ):
            others.append(finding)
            continue
        subject = result.get(path) or _make_subject(path)
        told = next((change for change in subject.changes if _names_same_file(finding, change)), None)
        if told is None:
            location = Location(path, finding.span.line, finding.span.column)
            changes = [*subject.changes, Change(finding.message, Effect.BREAKING, reason, location)]
        else:
            marked = replace(told, effect=Effect.BREAKING, reason=told.reason or reason)
            changes = [marked if change is told else change for change in subject.changes]
        result[path] = replace(subject, changes=changes)
    return list(result.values()), others


def _is_refused(finding: Diagnostic) -> bool:
    """Return whether a finding is an error for which urdfdom refuses a description."""
    return finding.code.startswith(_READER_PREFIX) and finding.severity is Severity.ERROR


def _find_reason(finding: Diagnostic) -> Phrase | None:
    """Return the reason why a new finding is breaking, or None if it is not."""
    if finding.code == _UNREADABLE_CODE:
        return phrase("the description can no longer be read")
    if _is_refused(finding):
        return phrase("robot_state_publisher does not start with the description")
    if finding.code not in _UNBUILDABLE_CODES:
        return None
    name = next(iter(finding.message.arguments.values()), "")
    return phrase("the build fails, because '{name}' does not exist", name=name)


def _is_outside(finding: Diagnostic) -> bool:
    """Return whether a build file installs a file outside of the repository, as in ``../other``. It may exist."""
    if finding.code not in _UNBUILDABLE_CODES or finding.span is None:
        return False
    name = str(next(iter(finding.message.arguments.values()), ""))
    return posixpath.normpath(posixpath.join(posixpath.dirname(finding.span.file), name)).startswith("..")


def _names_same_file(finding: Diagnostic, change: Change) -> bool:
    names = [PurePosixPath(str(value)) for value in finding.message.arguments.values()]
    return any(f"'{text}'" in str(change.sentence) for name in names for text in (name, name.name))


def _make_subject(path: str) -> Subject:
    rule = find_rule(path)
    return Subject(SubjectKind.SOURCE if rule is None else rule.kind, path, path, path)
