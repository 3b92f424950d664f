"""The links and joints of expanded descriptions, with the locations of their names."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from os.path import commonprefix
from pathlib import Path
from weakref import WeakKeyDictionary

from linkwright.diagnostics import LinkwrightError
from linkwright.language.definitions import NameDefinition, NameKind, definitions_in
from linkwright.language.format import Document, NotYetKnownError
from linkwright.language.includes import real_path
from linkwright.language.valid_parts import expand_valid_parts
from linkwright.language.workspace import Workspace
from linkwright.packages import enclosing_package
from linkwright.xacro import Expansion, expand
from linkwright.xmltree import Overlay
from linkwright.xmltree.positions import find_start_tag_end

_SUFFIXES = (".urdf", ".xacro")
_MAX_ROBOTS = 24
_MAX_STORED = 4 * _MAX_ROBOTS
_MAX_ENTRIES = 6
_MAX_ARGUMENT_SETS = 4
_MAX_DURATION_S = 0.5
_KINDS = {"link": NameKind.LINK, "joint": NameKind.JOINT}
_State = tuple[tuple[str, object], ...]
"""The files of an expansion, each with the hash of its open text or the time of its last change."""


@dataclass(frozen=True, slots=True)
class _Robot:
    state: _State
    names: tuple[NameDefinition, ...]
    mentioned_files: frozenset[str] = frozenset()
    """The names in the description's YAML files, such as parameters of controllers."""
    is_expanded: bool = True


_robots: WeakKeyDictionary[Workspace, dict[Path, _Robot]] = WeakKeyDictionary()


def robot_names(document: Document) -> list[NameDefinition]:
    """Return the links and joints of the robots that a file probably refers to.

    The most likely robots come first. Names with expressions are expanded, and located at the attribute with the
    expressions. A description that cannot be expanded provides its earlier names, the names in its valid parts, or the
    names without expressions.

    Args:
        document: a file of parameters, a configuration or a description.

    Raises:
        NotYetKnownError: no description was read, and the document does not wait.
    """
    robots: list[_Robot] = []
    begin = time.monotonic()
    for entry in _list_likely_robots(document):
        if time.monotonic() - begin > _MAX_DURATION_S:
            break  # The next request continues the expansion.
        robot = _find_robot(document, entry)
        if robot is not None:
            robots.append(robot)
        elif not robots:
            raise NotYetKnownError
    return _merge_names(sorted(robots, key=lambda robot: document.file.name not in robot.mentioned_files))


def part_names(document: Document) -> list[NameDefinition]:
    """Return the links and joints of the expanded descriptions that include a file.

    Args:
        document: a description, or a file that descriptions include.

    Raises:
        NotYetKnownError: a description was not read, and the document does not wait.
    """
    robots: list[_Robot] = []
    entries = document.workspace.index.entries(document.file, document.texts)[:_MAX_ENTRIES]
    for entry in dict.fromkeys((*entries, document.file)):
        if entry == document.file and entry not in entries and any(robot.is_expanded for robot in robots):
            continue  # The file alone counts only if no description that includes it can be expanded.
        robot = _find_robot(document, entry)
        if robot is None:
            raise NotYetKnownError
        robots.append(robot)
    return _merge_names(robots)


def find_mentioned_robots(document: Document, words: Collection[str]) -> list[Path]:
    """Return the descriptions whose links or joints are among some words, the best match first.

    Args:
        document: the file with the words.
        words: the possible names of links and joints.

    Raises:
        NotYetKnownError: no description was read, and the document does not wait.
    """
    robot_names(document)  # reads them
    cache = _robots.get(document.workspace, {})
    counts = {
        entry: len({name.name for name in cache[entry].names} & {*words})
        for entry in _list_likely_robots(document)
        if entry in cache
    }
    return sorted((entry for entry, count in counts.items() if count), key=lambda entry: -counts[entry])


def _merge_names(robots: Iterable[_Robot]) -> list[NameDefinition]:
    """Return the names of some robots, the first of each kind and name."""
    names: dict[tuple[NameKind, str], NameDefinition] = {}
    for name in (name for robot in robots for name in robot.names):
        names.setdefault((name.kind, name.name), name)
    return list(names.values())


def _find_robot(document: Document, entry: Path) -> _Robot | None:
    """Return the robot of a description, or None if the document cannot wait for its expansion."""
    cache = _robots.setdefault(document.workspace, {})
    robot = cache.get(entry)
    if robot is not None and robot.state == _compute_state((path for path, _ in robot.state), document.texts):
        return robot
    if document.waits:
        robot = _read_robot(document.workspace, document.texts, entry, cache.pop(entry, None))
        cache[entry] = robot
        if len(cache) > _MAX_STORED:
            del cache[next(iter(cache))]
    elif robot is not None:
        document.refreshes.append(partial(_find_robot, replace(document, waits=True), entry))
    return robot


def _list_likely_robots(document: Document) -> list[Path]:
    """Return the top-level descriptions, sorted by their relation to the file's package."""
    file = document.file
    package = enclosing_package(file.parent)
    name, folder = ("", file.parent) if package is None else (package[1].name, real_path(package[1]))

    def distance(entry: Path) -> tuple[bool, int]:
        shared = max(len(commonprefix([name, part])) for part in entry.parts)  # noqa: RUF071 - it compares characters
        return not entry.is_relative_to(folder), -shared

    entries = [entry for entry in document.workspace.index.roots(document.texts) if entry.name.endswith(_SUFFIXES)]
    return sorted(entries, key=distance)[:_MAX_ROBOTS]


def _read_robot(workspace: Workspace, texts: Mapping[Path, str], entry: Path, cached: _Robot | None) -> _Robot:
    """Return the names of a description.

    If its text cannot be expanded, these are its earlier names, the names in the saved files, in the valid parts, or in
    the text.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        entry: the description.
        cached: its earlier names, or None.
    """
    robot = _expand_robot(workspace, texts, entry)
    if robot is not None:
        return robot
    related = dict.fromkeys((entry, *workspace.index.related_files(entry, texts)))
    state = _compute_state([*map(str, related), *(path for path, _ in (() if cached is None else cached.state))], texts)
    if cached is not None and cached.is_expanded:
        return replace(cached, state=state)
    saved = _expand_robot(workspace, {}, entry) if texts else None
    if saved is not None:
        return replace(saved, state=state)
    parts = expand_valid_parts(workspace, texts, entry)
    if parts is not None:
        return _make_robot(parts, state, is_complete=False)
    text = workspace.text(entry, texts) or ""
    literal = (name for name in definitions_in(text, entry) if "$" not in name.name)
    return _Robot(state, tuple(name for name in literal if name.kind in _KINDS.values()), is_expanded=False)


def _expand_robot(workspace: Workspace, texts: Mapping[Path, str], entry: Path) -> _Robot | None:
    """Return the names in the first expansion without errors, or None if there is none."""
    overlay = Overlay({str(path): text for path, text in texts.items()})
    for arguments, _ in workspace.argument_calls(entry)[:_MAX_ARGUMENT_SETS]:
        with suppress(LinkwrightError, OSError, RecursionError):
            expansion = expand(entry, arguments, packages=workspace.finder(entry), overlay=overlay)
            return _make_robot(expansion, _compute_state(map(str, expansion.dependencies), texts))
    return None


def _make_robot(expansion: Expansion, state: _State, *, is_complete: bool = True) -> _Robot:
    names: list[NameDefinition] = []
    for element in expansion.document.root.elements():
        kind, name = _KINDS.get(element.tag), element.attributes.get("name")
        if kind is not None and name and element.source is not None:
            end = find_start_tag_end(element.source.text, element.offset)
            tag = element.source.text[element.offset : end]
            definition = next(definitions_in(tag, Path()), None)
            start = element.offset + (definition.start if definition else 0)
            detail = element.attributes.get("type", "")
            names.append(NameDefinition(kind, name, real_path(element.source.name), start, detail))
    contents = (element.text() for element in expansion.document.root.walk())
    files = (content.strip().rpartition("/")[2] for content in contents)
    mentioned = frozenset(file for file in files if file.endswith((".yaml", ".yml")))
    return _Robot(state, tuple(names), mentioned, is_complete)


def _compute_state(files: Iterator[str] | list[str] | map[str], texts: Mapping[Path, str]) -> _State:
    state: list[tuple[str, object]] = []
    for file in files:
        text = texts.get(Path(file)) or texts.get(real_path(file))
        try:
            state.append((file, os.stat(file).st_mtime_ns if text is None else str(hash(text))))  # noqa: PTH116
        except OSError:
            state.append((file, None))
    return tuple(state)


def written_length(text: str, name: NameDefinition) -> int:
    """Return the length of a name as written in its file, possibly with expressions."""
    quote = text[name.start - 1 : name.start]
    end = text.find(quote, name.start) if quote in ("'", '"') and quote else -1
    return end - name.start if end >= 0 else len(name.name)
