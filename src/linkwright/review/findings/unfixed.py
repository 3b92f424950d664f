"""Find findings that the new version no longer has although their cause is still there."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.reading import read_outline
from linkwright.review.versions import TEST_FOLDERS, Version, Versions
from linkwright.xacro.cache import read_document

_MESH_RULES = ("LW42", "LW43")
"""The beginnings of the codes of findings about meshes, which need the files."""
_MISSING_MESH_CODE = "LW424"
_UNDECLARED_CODE = "LW848"
"""The finding about a package that launch files use and package.xml does not name."""
_TEST_DEPENDENCY = "test_depend"
_LAUNCH_FILES = "*launch*"
_QUOTED_NAME = re.compile(r"'([\w-]+)'")
_JOINED_LITERALS = re.compile(r"(['\"])\s*\+\s*\1")
"""The end of a literal text and the beginning of the next, which an expression joins."""


def drop_unfixed_findings(
    versions: Versions, fixed: Sequence[Diagnostic], added: Sequence[Diagnostic], new_paths: Mapping[str, str]
) -> list[Diagnostic]:
    """Return the fixed findings without those that only cannot be found any more.

    A removed file has no findings, and a mesh that is missing now has no size. A package whose dependencies have not
    changed, and whose launch files still use another package, still does not name it, also if a third package brings
    it now. So does a package that names it only for its tests.

    Args:
        versions: both versions.
        fixed: the findings that only the old version has, with relative paths.
        added: the findings that only the new version has, with relative paths.
        new_paths: the new paths of renamed files, by old path.
    """
    changed = {path for file in versions.changed_files for path in (file.old_path, file.new_path) if path}
    removed = {file.old_path for file in versions.changed_files if file.new_path is None}
    without_meshes = {_get_path(finding) for finding in added if finding.code == _MISSING_MESH_CODE}

    def is_fixed(finding: Diagnostic) -> bool:
        path = _get_path(finding)
        if path in removed:
            return False
        if finding.code.startswith(_MESH_RULES) and finding.code != _MISSING_MESH_CODE:
            return new_paths.get(path, path) not in without_meshes
        if finding.code != _UNDECLARED_CODE:
            return True
        new_path = new_paths.get(path, path)
        is_left = path not in changed or _read_dependencies(versions.old, path) == _read_dependencies(
            versions.new, new_path
        )
        is_left = is_left or _depends_only_for_tests(versions.new, new_path, finding)
        return not is_left or not _uses_packages(versions.new, finding)

    return [finding for finding in fixed if is_fixed(finding)]


def _depends_only_for_tests(version: Version, path: str, finding: Diagnostic) -> bool:
    """Return whether a ``package.xml`` names packages that a finding quotes only as dependencies of tests."""
    dependencies = _read_dependencies(version, path)
    names = _QUOTED_NAME.findall(str(finding.message))
    return any({tag for tag, dependency in dependencies if dependency == name} == {_TEST_DEPENDENCY} for name in names)


def _read_dependencies(version: Version, path: str) -> set[tuple[str, str]]:
    """Return the tags and names of the dependencies of a ``package.xml``; none if it cannot be read."""
    try:
        dependencies = Manifest(read_document(str(version.file(path)))).dependencies
    except LinkwrightError:
        return set()
    return {(dependency.tag, dependency.name) for dependency in dependencies}


def _uses_packages(version: Version, finding: Diagnostic) -> bool:
    """Return whether launch files of the package of a finding still contain the names that it quotes.

    A launch file may join a name from the default of an argument and a literal text.
    """
    folder = version.file(_get_path(finding)).parent
    files = [file for file in sorted(folder.rglob(_LAUNCH_FILES)) if file.is_file()]
    files = [file for file in files if TEST_FOLDERS.isdisjoint(file.relative_to(folder).parts)]
    names = _QUOTED_NAME.findall(str(finding.message))
    texts = [file.read_bytes() for file in files]
    if any(name.encode() in text for name in names for text in texts):
        return True
    resolved = [value for file in files if is_launch_file(file.name) for value in _resolve_values(version, file)]
    return any(re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", value) for name in names for value in resolved)


def _resolve_values(version: Version, file: Path) -> Iterator[str]:
    """Yield the values in a launch file with the defaults of its arguments; none if it cannot be read."""
    with suppress(LinkwrightError, UnreadableFileError, OSError, ValueError):
        outline = read_outline(file, version.root)
        for entry in outline.entries:
            yield from (_JOINED_LITERALS.sub("", outline.resolve(value)) for value in entry.settings.values())


def _get_path(finding: Diagnostic) -> str:
    return "" if finding.span is None else str(finding.span.file)
