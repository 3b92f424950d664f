"""The findings of `linkwright check` in both versions, and which of them are new or fixed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from linkwright.diagnostics import Diagnostic
from linkwright.lint.engine import Checked
from linkwright.lint.known_findings import count_keys, new_findings
from linkwright.lint.targets import DESCRIPTIONS, Targets
from linkwright.review.versions import Version, Versions


@dataclass(frozen=True)
class Findings:
    """The findings of a version.

    Attributes:
        diagnostics: the findings.
        files: the paths of the descriptions and of the files that they include, if they could be read.
    """

    diagnostics: list[Diagnostic]
    files: frozenset[str]


def find(version: Version, targets: Targets) -> Findings:
    """Return the findings of a version about some files and packages."""
    files: set[str] = set()

    def add_files(checked: Checked) -> None:
        if checked.robot is None and checked.sdf is None:
            return
        included = () if checked.subject is None else checked.subject.sources
        files.update(path for file in (checked.path, *included) if (path := version.relative(file)) is not None)

    diagnostics, _ = version.checker().check(targets, [version.root], add_files)
    return Findings(diagnostics, frozenset(files))


def compare_findings(
    versions: Versions, old: Findings, new: Findings, new_paths: Mapping[str, str]
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """Return the findings that only the new version has, and those that only the old version has.

    A finding in a description that the other version has but could not read, or that no robot there includes, may be
    as old as the file. It is neither new nor fixed.

    Args:
        versions: both versions.
        old: the findings of the old version.
        new: the findings of the new version.
        new_paths: the new paths of renamed files, by old path.
    """
    old_paths = {new_path: old_path for old_path, new_path in new_paths.items()}
    sides = ((versions.new, new, old, versions.old, old_paths), (versions.old, old, new, versions.new, new_paths))
    added, fixed = (
        [
            version.labeled(finding)
            for finding in new_findings(
                own.diagnostics, version.root, count_keys(other.diagnostics, other_version.root, _inverse(names))
            )
            if _is_comparable(finding, version, own, other, other_version, names)
        ]
        for version, own, other, other_version, names in sides
    )
    return added, fixed


def _inverse(names: Mapping[str, str]) -> dict[str, str]:
    return {value: name for name, value in names.items()}


def _is_comparable(
    finding: Diagnostic,
    version: Version,
    own: Findings,
    other: Findings,
    other_version: Version,
    names: Mapping[str, str],
) -> bool:
    """Return whether the other version would have a finding, too, if its cause was there.

    This is the case if both versions of the file could be read, and also if neither could.
    """
    path = None if finding.span is None else version.relative(finding.span.file)
    if path is None or not PurePosixPath(path).name.endswith(DESCRIPTIONS):
        return True
    other_path = names.get(path, path)
    return other_path in other.files or path not in own.files or not other_version.file(other_path).exists()
