"""Compare the findings of `linkwright check` in both versions: new and fixed findings."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.lint.engine import Checked
from linkwright.lint.finding import Finding
from linkwright.lint.known_findings import Key, count_keys, find_new_findings
from linkwright.lint.missing_packages import is_missing_here
from linkwright.lint.targets import DESCRIPTION_SUFFIXES, Targets
from linkwright.packages.manifest import MANIFEST
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.texts.folders import finding_without_folders, without_folder
from linkwright.review.versions import Version, Versions

QUOTED_NAME = re.compile(r"'([^']*)'")
"""A name in the message of a finding."""
_UNPARSED_CODE = "LW820"
"""The finding about a ``setup.py`` with a syntax error, of which no other finding is known."""


@dataclass(frozen=True)
class Findings:
    """The findings of a version.

    Attributes:
        diagnostics: the findings of the check.
        files: the paths of the descriptions and of the files that they include, if they could be read.
        reading_errors: the codes and messages of the errors that made descriptions unreadable.
    """

    diagnostics: list[Diagnostic]
    files: frozenset[str]
    reading_errors: frozenset[tuple[str, str]]


def find_findings(version: Version, targets: Targets) -> Findings:
    """Return the findings of a version about some files and packages.

    Declared dependencies that only this computer lacks are left out.
    """
    files: set[str] = set()
    errors: set[tuple[str, str]] = set()

    def add_files(checked: Checked) -> None:
        if checked.robot is None and checked.sdf is None:
            errors.update(
                (finding.code, without_folder(str(finding.message), version.root))
                for finding in checked.diagnostics
                if finding.severity is Severity.ERROR and not isinstance(finding, Finding)
            )
            return
        included = () if checked.subject is None else checked.subject.sources
        files.update(path for file in (checked.path, *included) if (path := version.relative(file)) is not None)

    diagnostics, _ = version.checker().check(targets, [version.root], add_files)
    findings = [
        finding_without_folders(finding, version.root, version.installed_shares)
        for finding in diagnostics
        if not is_missing_here(finding)
    ]
    return Findings(findings, frozenset(files), frozenset(errors))


def find_findings_singly(
    sides: Sequence[tuple[Version, Targets]], new_paths: Mapping[str, str]
) -> tuple[list[Findings], dict[str, Exception]]:
    """Return the findings of both versions, and the failed checks by path.

    A target that fails in one version is left out of both, so that none of its findings is new or fixed.

    Args:
        sides: both versions with the files and packages to check.
        new_paths: the new paths of renamed files, by old path.
    """
    failures: dict[str, Exception] = {}
    for version, targets in sides:
        single_targets = [
            *(Targets((file,), ()) for file in targets.files),
            *(Targets((), (path,)) for path in targets.packages),
        ]
        for single_target in single_targets:
            path = _find_target_path(version, *single_target.files, *single_target.packages, new_paths=new_paths)
            try:
                find_findings(version, single_target)
            except Exception as error:  # noqa: BLE001 - the other files are still checked
                failures.setdefault(path, error)
    findings = []
    for version, targets in sides:
        files, packages = (
            tuple(path for path in paths if _find_target_path(version, path, new_paths=new_paths) not in failures)
            for paths in (targets.files, targets.packages)
        )
        findings.append(find_findings(version, Targets(files, packages)))
    return findings, failures


def _find_target_path(version: Version, path: Path, *, new_paths: Mapping[str, str]) -> str:
    """Return the new path of a file, or that of the manifest of a package."""
    relative = version.relative(path / MANIFEST if path.is_dir() else path) or str(path)
    return new_paths.get(relative, relative) if version.is_old else relative


def compare_findings(
    versions: Versions, old: Findings, new: Findings, new_paths: Mapping[str, str]
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """Return the new and the fixed findings: those that only one of the versions has.

    A finding in a description that the other version could not read, or that no robot there includes, may be
    as old as the file. It is neither new nor fixed. The same holds for a finding that moved to another file, for one
    that only names a package by its new name, for one about a file that git cannot check out, for one in a
    ``setup.py`` that has a syntax error in the other version, and for one in an unchanged description that the other
    version also has when the file is checked alone.

    Args:
        versions: both versions.
        old: the findings of the old version.
        new: the findings of the new version.
        new_paths: the new paths of renamed files, by old path.
    """
    old_paths = {new_path: old_path for old_path, new_path in new_paths.items()}
    changed = {path for file in versions.changed_files for path in (file.old_path, file.new_path) if path}
    sides = ((versions.new, new, old, versions.old, old_paths), (versions.old, old, new, versions.new, new_paths))
    added, fixed = (
        [
            version.with_relative_paths(finding)
            for finding in _drop_found_alone(
                [
                    finding
                    for finding in find_new_findings(
                        own.diagnostics, version.root, count_keys(other.diagnostics, other_version.root, _invert(names))
                    )
                    if _is_comparable(finding, version, own, other, other_version, names, changed)
                    and not _names_missing_file(finding, version)
                ],
                version,
                other_version,
                changed,
            )
        ]
        for version, own, other, other_version, names in sides
    )
    rename = PackageNames(find_renamed_packages(versions)).rename_derived
    added_keys = [(finding.code, str(finding.message)) for finding in added]
    fixed_keys = [(finding.code, rename(str(finding.message))) for finding in fixed]
    added, fixed = _drop_moved(added, added_keys, fixed_keys), _drop_moved(fixed, fixed_keys, added_keys)
    added = [finding for finding in added if not _is_at_old_line(finding, versions, old, old_paths)]
    return _drop_in_unparsed_files(added, fixed, new_paths), _drop_in_unparsed_files(fixed, added, old_paths)


def _is_at_old_line(finding: Diagnostic, versions: Versions, old: Findings, old_paths: Mapping[str, str]) -> bool:
    """Return whether the old version has the line of a finding in a description, and the same finding elsewhere.

    Such a finding is not new: a robot used a copy of the line, which had the finding. At the line itself, a robot may
    have given another prefix to the names in it.
    """
    path = None if finding.span is None else str(finding.span.file)
    if path is None or not path.endswith(DESCRIPTION_SUFFIXES):
        return False
    old_path, message = old_paths.get(path, path), str(finding.message)
    line = _find_line(versions.new, finding)
    if line.text not in versions.old.text(old_path).splitlines():
        return False
    alike = [item for item in old.diagnostics if item.code == finding.code and _are_alike(str(item.message), message)]
    return any(
        str(other.message) == message
        or (
            other.span is not None
            and versions.old.path_of_label(other.span.file) == old_path
            and _find_line(versions.old, other) == line
        )
        for other in alike
    )


class _Line(NamedTuple):
    """A line of a file, and the number of equal lines before it and in the file."""

    text: str
    before: int
    total: int


def _find_line(version: Version, finding: Diagnostic) -> _Line:
    """Return the line of a finding."""
    assert finding.span is not None
    lines = version.text(version.path_of_label(finding.span.file)).splitlines()
    before, rest = lines[: finding.span.line - 1], lines[finding.span.line - 1 :]
    text = rest[0] if rest else ""
    return _Line(text, before.count(text), lines.count(text))


def _are_alike(old: str, new: str) -> bool:
    """Return whether two messages are equal, or differ in quoted names of which one ends with the other."""
    if QUOTED_NAME.sub("''", old) != QUOTED_NAME.sub("''", new):
        return False
    pairs = zip(QUOTED_NAME.findall(old), QUOTED_NAME.findall(new), strict=True)
    return all(name and other and (name.endswith(other) or other.endswith(name)) for name, other in pairs)


def _names_missing_file(finding: Diagnostic, version: Version) -> bool:
    """Return whether a finding is about a file that git cannot check out.

    For example, a partial clone lacks files.
    """
    missing = () if version.commit is None else version.commit.missing_files
    return any(path in str(finding.message) for path in missing)


def _drop_found_alone(
    findings: Sequence[Diagnostic], version: Version, other_version: Version, changed: Collection[str]
) -> list[Diagnostic]:
    """Return the findings without those that the other version has when their unchanged file is checked alone.

    A check of several robots reports a finding about a robot and about the file that xacro wrote for it only once.
    """
    paths = {
        path
        for finding in findings
        if finding.span is not None
        if (path := version.relative(finding.span.file)) is not None
        if path.endswith(DESCRIPTION_SUFFIXES) and path not in changed and other_version.file(path).is_file()
    }
    known: dict[Key, int] = {}
    for path in sorted(paths):
        own = find_findings(other_version, Targets((other_version.file(path),), ()))
        known |= count_keys(own.diagnostics, other_version.root)
    return find_new_findings(findings, version.root, known) if known else list(findings)


def _drop_moved(
    findings: Sequence[Diagnostic], keys: Sequence[Hashable], other_keys: Sequence[Hashable]
) -> list[Diagnostic]:
    """Return the findings that the other version does not have in another file.

    Args:
        findings: the findings that one version does not have in the same file.
        keys: the code and message of each, with the new names of packages.
        other_keys: those of the findings of the other version.
    """
    counts = Counter(other_keys)
    result = []
    for finding, key in zip(findings, keys, strict=True):
        if counts[key] > 0:
            counts[key] -= 1
        else:
            result.append(finding)
    return result


def _drop_in_unparsed_files(
    findings: Sequence[Diagnostic], others: Sequence[Diagnostic], names: Mapping[str, str]
) -> list[Diagnostic]:
    """Return the findings without those in files that cannot be parsed in the other version.

    Args:
        findings: the findings that only one version has.
        others: those that only the other version has.
        names: the paths of renamed files in the version of the findings, by the path in the other version.
    """
    unparsed = {
        names.get(other.span.file, other.span.file)
        for other in others
        if other.code == _UNPARSED_CODE and other.span is not None
    }
    return [finding for finding in findings if finding.span is None or finding.span.file not in unparsed]


def _invert(names: Mapping[str, str]) -> dict[str, str]:
    return {value: name for name, value in names.items()}


def _is_comparable(
    finding: Diagnostic,
    version: Version,
    own: Findings,
    other: Findings,
    other_version: Version,
    names: Mapping[str, str],
    changed: Collection[str],
) -> bool:
    """Return whether the other version would also have a finding if it had its cause.

    This is the case if both versions of the file could be read, and also if neither could. However, checks that stop at
    different errors reach different files. A finding in a file that has not changed is then not compared.
    """
    path = None if finding.span is None else version.relative(finding.span.file)
    if path is None or not PurePosixPath(path).name.endswith(DESCRIPTION_SUFFIXES):
        return True
    other_path = names.get(path, path)
    if other_path in other.files or not other_version.file(other_path).exists():
        return True
    return path not in own.files and (path in changed or own.reading_errors == other.reading_errors)
