"""Included files that may be missing: the build creates them, or a program locates them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.lint.finding import with_related
from linkwright.lint.generated_files import is_created_later
from linkwright.lint.package import find_package

_MISSING_FILE_CODE = "XML101"


def with_file_severity(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the diagnostics, with a lower severity for some missing files.

    A file that the build creates later becomes informational. Files that exist relative to the package's folder, which
    another program may use as the base, become one warning for each file that includes them.
    """
    package_findings: dict[str, list[Diagnostic]] = {}
    for diagnostic in diagnostics:
        if (
            diagnostic.code != _MISSING_FILE_CODE
            or diagnostic.span is None
            or diagnostic.severity is not Severity.ERROR
        ):
            yield diagnostic
        elif (
            package_finding := None
            if (built_finding := _adapt_to_built_file(diagnostic))
            else _adapt_to_package_file(diagnostic)
        ) is not None:
            package_findings.setdefault(diagnostic.span.file, []).append(package_finding)
        else:
            yield built_finding or diagnostic
    yield from (with_related(first, others) for first, *others in package_findings.values())


def _adapt_to_built_file(diagnostic: Diagnostic) -> Diagnostic | None:
    path = _find_missing_path(diagnostic)
    package = find_package(path.parent)
    if package is None or not is_created_later(package, path.relative_to(package.folder).as_posix()):
        return None
    hint = phrase("the build or another program creates it; until then, the parts that need it are left out")
    return diagnostic.with_changes(severity=Severity.INFO, hint=hint)


def _adapt_to_package_file(diagnostic: Diagnostic) -> Diagnostic | None:
    assert diagnostic.span is not None
    folder = Path(diagnostic.span.file).absolute().parent
    package = find_package(folder)
    relative_path = os.path.relpath(_find_missing_path(diagnostic), folder)
    if package is None or not (package.folder / relative_path).is_file():
        return None
    correct_path = Path(os.path.relpath(package.folder / relative_path, folder)).as_posix()
    hint = phrase("xacro resolves the path from the folder of this file: write '{path}'", path=correct_path)
    return diagnostic.with_changes(severity=Severity.WARNING, hint=hint)


def _find_missing_path(diagnostic: Diagnostic) -> Path:
    return Path(os.path.abspath(str(as_phrase(diagnostic.message).arguments.get("path", ""))))  # noqa: PTH100 - resolve() follows links
