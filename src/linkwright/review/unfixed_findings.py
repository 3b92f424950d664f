"""Find findings that the new version no longer has although their cause is still there."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from linkwright.diagnostics import Diagnostic
from linkwright.review.versions import Version, Versions

_MESH_RULES = ("LW42", "LW43")
"""The beginnings of the codes of findings about meshes, which need the files."""
_MISSING_MESH_CODE = "LW424"
_UNDECLARED_CODE = "LW848"
"""The finding about a package that launch files use and package.xml does not name."""
_LAUNCH_FILES = "*launch*"
_QUOTED_NAME = re.compile(r"'([\w-]+)'")


def drop_unfixed_findings(
    versions: Versions, fixed: Sequence[Diagnostic], added: Sequence[Diagnostic], new_paths: Mapping[str, str]
) -> list[Diagnostic]:
    """Return the fixed findings without those that only cannot be found any more.

    A mesh that is missing now has no size. A package whose manifest has not changed, and whose launch files still use
    another package, still does not name it, also if a third package brings it now.

    Args:
        versions: both versions.
        fixed: the findings that only the old version has, with relative paths.
        added: the findings that only the new version has, with relative paths.
        new_paths: the new paths of renamed files, by old path.
    """
    changed = {path for file in versions.changed_files for path in (file.old_path, file.new_path) if path}
    without_meshes = {_get_path(finding) for finding in added if finding.code == _MISSING_MESH_CODE}

    def is_fixed(finding: Diagnostic) -> bool:
        path = _get_path(finding)
        if finding.code.startswith(_MESH_RULES) and finding.code != _MISSING_MESH_CODE:
            return new_paths.get(path, path) not in without_meshes
        return finding.code != _UNDECLARED_CODE or path in changed or not _uses_packages(versions.new, finding)

    return [finding for finding in fixed if is_fixed(finding)]


def _uses_packages(version: Version, finding: Diagnostic) -> bool:
    """Return whether launch files of the package of a finding still contain the names that it quotes."""
    folder = version.file(_get_path(finding)).parent
    texts = [file.read_bytes() for file in sorted(folder.rglob(_LAUNCH_FILES)) if file.is_file()]
    names = _QUOTED_NAME.findall(str(finding.message))
    return any(name.encode() in text for name in names for text in texts)


def _get_path(finding: Diagnostic) -> str:
    return "" if finding.span is None else str(finding.span.file)
