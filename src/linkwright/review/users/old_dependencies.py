"""Find packages that still depend on the old name of a renamed package."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_COMMENT = re.compile(r"#[^\n]*")
_FIND_PACKAGE = re.compile(r"\bfind_package\s*\(([^)]*)\)", re.IGNORECASE)
_WORD = re.compile(r"[\w.+-]+")
_CATKIN = "catkin"
_Use = tuple[str, Location]
"""The old name of a package, and the place of a dependency on it."""


def find_old_dependencies(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the manifests and build files that still name the old name of a renamed package, each with a change."""
    if not any(PurePosixPath(file.path).name == MANIFEST for file in changed_files):
        return
    new_names = {package.old_name: package.new_name for package in find_renamed_packages(versions)}
    new_names = {old: new for old, new in new_names.items() if old != new and old not in versions.new.shares}
    for path in versions.new.paths((MANIFEST, CMAKE_FILE)) if new_names else ():
        names = {name for name in new_names if name in versions.new.text(path)}
        for name, location in find_dependencies(versions.new, path, names) if names else ():
            text = _describe(name, new_names[name], is_manifest=PurePosixPath(path).name == MANIFEST)
            yield path, Change(text, Effect.BREAKING, phrase("no package of the repository has this name"), location)


def find_dependencies(version: Version, path: str, names: Collection[str]) -> Iterator[_Use]:
    """Yield the packages with the given names on which a manifest or ``CMakeLists.txt`` depends."""
    find_uses = _find_in_manifest if PurePosixPath(path).name == MANIFEST else _find_in_cmake_file
    return find_uses(version, path, names)


def _describe(old: str, new: str, *, is_manifest: bool) -> Phrase:
    if is_manifest:
        return phrase("depends on the package '{package}', whose name is '{name}' now", package=old, name=new)
    return phrase("requires the package '{package}', whose name is '{name}' now", package=old, name=new)


def _find_in_manifest(version: Version, path: str, names: Collection[str]) -> Iterator[_Use]:
    try:
        manifest = Manifest(read_document(str(version.file(path))))
    except (LinkwrightError, OSError):
        return
    reported: set[str] = set()
    for dependency in manifest.dependencies:
        if dependency.name in names and dependency.name not in reported:
            reported.add(dependency.name)
            span = dependency.element.span()
            yield dependency.name, Location(path, 1 if span is None else span.line, 1 if span is None else span.column)


def _find_in_cmake_file(version: Version, path: str, names: Collection[str]) -> Iterator[_Use]:
    """Yield the packages that ``find_package`` requires, also as components of catkin."""
    text = _COMMENT.sub(lambda match: " " * len(match[0]), version.text(path))
    source = SourceText(str(version.file(path)), text)
    reported: set[str] = set()
    for call in _FIND_PACKAGE.finditer(text):
        words = list(_WORD.finditer(text, call.start(1), call.end(1)))
        if words and words[0][0] != _CATKIN:
            words = words[:1]
        for word in words:
            if word[0] in names and word[0] not in reported:
                reported.add(word[0])
                span = source.span(*word.span())
                yield word[0], Location(path, span.line, span.column)
