"""Find worlds and descriptions that load a library that their package stopped building."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.facts import BuildFacts, FactKind
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import TEST_FOLDERS, Versions

_READER_SUFFIXES = (".sdf", ".world", ".urdf", ".xacro", ".gazebo", ".xml")
_LIBRARY_KINDS = (FactKind.LIBRARY, FactKind.BUILT_LIBRARY)
_LOADED = re.compile(
    r"<plugin\b[^>]*?\bfilename\s*=\s*[\"'](?:[^\"']*/)?(?:lib)?(?P<plugin>[\w.-]+?)(?:\.so)?[\"']"
    r"|<library\b[^>]*?\bpath\s*=\s*[\"'](?:[^\"']*/)?(?:lib)?(?P<library>[\w.-]+?)(?:\.so)?[\"']"
)
"""A plugin of a simulator, or the library of a plugin description."""


def find_lost_libraries(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that load a library that its package stopped building, each with a change."""
    folders = {
        folder
        for file in changed_files
        if file.old_path and PurePosixPath(file.old_path).name == CMAKE_FILE
        if (folder := versions.old.package_of(file.old_path)) is not None
    }
    lost: set[str] = set()
    for folder in folders:
        old, new = read_package_facts(versions.old, folder), read_package_facts(versions.new, folder)
        if old is not None and new is not None and new.unknown <= old.unknown:
            lost |= _list_libraries(old) - _list_libraries(new)
    for path in versions.new.paths(_READER_SUFFIXES) if lost else ():
        text = versions.new.text(path)
        if not any(name in text for name in lost) or not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        source = SourceText(str(versions.new.file(path)), text)
        for match in _LOADED.finditer(without_comments(text, path)):
            name = match["plugin"] or match["library"]
            if name in lost:
                span = source.span(*match.span("plugin" if match["plugin"] else "library"))
                sentence = phrase("loads the library '{name}', which is no longer built", name=name)
                reason = phrase("the plugin is not found")
                yield path, Change(sentence, Effect.BREAKING, reason, Location(path, span.line, span.column))
                break


def _list_libraries(facts: BuildFacts) -> set[str]:
    return {fact.name for fact in facts.facts if fact.kind in _LIBRARY_KINDS}
