"""Find worlds and descriptions that load a library that their package does not build, or no longer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
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
_PLUGIN_CLASS = re.compile(r"<class\b[^>]*\bbase_class_type\s*=\s*[\"'](?!rqt_gui_py::)")
"""A class of a plugin description that pluginlib loads from a library of C++."""


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


def find_unbuilt_libraries(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the plugin descriptions that newly name a library which no target of their package builds.

    This is breaking if the library whose place it takes was built. Packages without a library are left out, because
    another build system may make it, as are those with a command that names it and is not known.
    """
    for file in changed_files:
        path = file.new_path
        if path is None or not path.endswith(".xml") or not versions.new.file(path).is_file():
            continue
        text = without_comments(versions.new.text(path), path)
        folder = versions.new.package_of(path)
        if folder is None or _PLUGIN_CLASS.search(text) is None:
            continue
        facts = read_package_facts(versions.new, folder)
        if facts is None:
            continue
        old_text = "" if file.old_path is None else without_comments(versions.old.text(file.old_path), file.old_path)
        old_names = {match["library"] for match in _LOADED.finditer(old_text)}
        matches = [match for match in _LOADED.finditer(text) if match["library"]]
        old_folder = None if file.old_path is None else versions.old.package_of(file.old_path)
        old = None if old_folder is None else read_package_facts(versions.old, old_folder)
        lost = old_names - {match["library"] for match in matches}
        source = SourceText(str(versions.new.file(path)), text)
        for match in matches:
            name = match["library"]
            if name in old_names or not _is_unbuilt(facts, name):
                continue
            span = source.span(*match.span("library"))
            sentence = phrase("names the library '{name}', which no target of the package builds", name=name)
            change = Change(sentence, location=Location(path, span.line, span.column))
            if old is not None and not lost.isdisjoint(_list_libraries(old)):
                change = replace(change, effect=Effect.BREAKING, reason=phrase("the plugin is not found"))
            yield path, change


def _is_unbuilt(facts: BuildFacts, name: str) -> bool:
    """Return whether a package builds libraries, but certainly none with a name."""
    libraries = _list_libraries(facts)
    files = {*libraries, *facts.output_names.values()}
    names = (name, "${PROJECT_NAME}") if name == facts.project else (name,)
    is_open = any("$" in file for file in files)
    is_mentioned = any(other in text.split() for _, text in facts.other_commands for other in names)
    return bool(libraries) and name not in files and not is_open and not is_mentioned


def _list_libraries(facts: BuildFacts) -> set[str]:
    return {fact.name for fact in facts.facts if fact.kind in _LIBRARY_KINDS}
