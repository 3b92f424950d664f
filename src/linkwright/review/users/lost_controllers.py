"""Find launch files, sources and configurations of MoveIt that still name removed controllers."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_all_controllers
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.sources.reading import read_source_names
from linkwright.review.texts.list_changes import list_items
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SETTINGS = (".yaml", ".yml")
_READER_SUFFIXES = (".py", ".sh", ".launch", ".launch.xml")
_LISTED = re.compile(r"(?:^|[._])controller_(?:names$|list\[[^\]]*\]\.name$)")
"""The parameters of MoveIt that list the controllers to which it sends trajectories."""
_COMMENT = re.compile(r"^[ \t]*#[^\n]*|<!--.*?-->", re.MULTILINE | re.DOTALL)
_CONTROLLER = re.compile(r"controller|broadcaster|spawner")
"""A word in the line or the name that marks the name as the name of a controller."""


def find_lost_controllers(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files of the new version that name a controller removed from the changed files."""
    old, new = _find_controllers(versions.old, changed_files), _find_controllers(versions.new, changed_files)
    lost = {name: path for name, path in old.items() if name not in new}
    if not lost:
        return
    paths = versions.new.paths((*_SETTINGS, *_READER_SUFFIXES, *CPP_SUFFIXES))
    files = [path for path in paths if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)]
    for path in files:
        if path.endswith(_SETTINGS):
            for name in _read_controller_names(versions.new, path):
                lost.pop(name, None)
    for path in files if lost else ():
        if path.endswith(_SETTINGS):
            yield from ((path, change) for change in _find_in_settings(path, versions.new.text(path), lost))
            continue
        if path.endswith((*CPP_SUFFIXES, PYTHON_SUFFIX)):
            found = list(_find_in_source(versions.new, path, lost))
            yield from ((path, change) for change in found)
            if found or path.endswith(CPP_SUFFIXES):
                continue  # a source in Python may also load controllers
        text = versions.new.text(path)
        text = _COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
        for name, source in lost.items():
            yield from ((path, change) for change in _find_use(path, text, name, source))


def _find_in_settings(path: str, text: str, lost: Mapping[str, str]) -> Iterator[Change]:
    """Yield the changes about controllers that a configuration of MoveIt still lists."""
    if not any(name in text for name in lost):
        return
    try:
        values = read_yaml_values(text)
    except UnreadableFileError:
        return
    for parameter, value in values.items():
        if _LISTED.search(parameter) is None:
            continue
        for name in (item.strip("/") for item in list_items(value.text)):
            if name in lost:
                yield _make_change(name, lost[name], Location(path, value.line, value.column))


def _find_in_source(version: Version, path: str, lost: Mapping[str, str]) -> Iterator[Change]:
    """Yield the changes about removed controllers whose topics, services or actions a source uses."""
    text = version.text(path)
    left = {name for name in lost if f"{name}/" in text}
    for item in read_source_names(version.file(path)).names if left else ():
        name = next((name for name in sorted(left) if item.name.lstrip("/").startswith(f"{name}/")), None)
        if item.kind in COMMUNICATION_KINDS and name is not None:
            left.remove(name)
            yield _make_change(name, lost[name], Location(path, item.span.line, item.span.column))


def _find_use(path: str, text: str, name: str, source: str) -> Iterator[Change]:
    """Yield the change about the first location where a file names a removed controller."""
    pattern = re.compile(rf"(?<=[\"'\s])/?{re.escape(name)}(?=[\"'\s/])")
    for match in pattern.finditer(text):
        start = text.rfind("\n", 0, match.start()) + 1
        line = text[start:].partition("\n")[0]
        if _CONTROLLER.search(line):
            location = Location(path, text.count("\n", 0, start) + 1, match.start() - start + 1)
            yield _make_change(name, source, location)
            return


def _make_change(name: str, source: str, location: Location) -> Change:
    sentence = phrase("names the controller '{name}', which '{file}' no longer has", name=name, file=source)
    return Change(sentence, Effect.BREAKING, phrase("the controller '{name}' is not found", name=name), location)


def _find_controllers(version: Version, changed_files: Sequence[ChangedFile]) -> dict[str, str]:
    """Return the paths of changed parameter files, by the controllers that they configure."""
    paths = (file.old_path if version.is_old else file.new_path for file in changed_files if not file.is_submodule)
    return {
        name: path
        for path in paths
        if path and path.endswith(_SETTINGS)
        for name in _read_controller_names(version, path)
    }


def _read_controller_names(version: Version, path: str) -> set[str]:
    try:
        return set(find_all_controllers(read_yaml_values(version.text(path))))
    except UnreadableFileError:
        return set()
