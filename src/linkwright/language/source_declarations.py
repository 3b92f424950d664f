"""The parameters and topics in the Python and C++ sources of the workspace."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple
from weakref import WeakKeyDictionary

from linkwright.language.format import Document, NotYetKnownError
from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import find_files_and_packages

_SOURCE_SUFFIXES = (".py", ".cpp", ".hpp", ".cc", ".cxx", ".h")
_MAX_FILES = 3000
_MAX_TEXT_LENGTH = 300_000
_CACHE_LIFETIME_S = 10.0
"""The time in seconds after which the sources are searched and read again."""
_DECLARATION = re.compile(
    r"""declare_parameter\s{0,9}(?:<([\w:<> ]{1,80})>)?\s{0,9}\(\s{0,99}["']([\w.]+)["']"""
    r"""\s{0,99}(?:,\s{0,99}([^,()\n]{1,200}))?"""
)
_ENDPOINT = re.compile(
    r"""\b(?:create_(?P<kind>publisher|subscription|service|client)|advertise|subscribe|Action(?P<side>Server|Client))"""
    r"""\s{0,9}(?:<(?P<type>[\w:<> ]{1,80})>)?\s{0,9}\(\s{0,99}(?:(?:self|this)\s{0,9},\s{0,99})?"""
    r"""(?:(?P<message>[A-Za-z_][\w.]{0,80})\s{0,9},\s{0,99})?["'](?P<name>[\w~/]{1,120})["']"""
)
_TYPES = {
    "int": "integer",
    "int64_t": "integer",
    "double": "double",
    "float": "double",
    "bool": "bool",
    "std::string": "string",
    "std::vector<std::string>": "string_array",
    "std::vector<double>": "double_array",
    "std::vector<int64_t>": "integer_array",
    "std::vector<bool>": "bool_array",
}


@dataclass(frozen=True, slots=True)
class DeclaredParameter:
    """A parameter that a source declares.

    Attributes:
        name: the name with dots.
        type: the ROS 2 type, or empty if it is unknown.
        default: the text of the default, or empty if it has none.
        file: the source.
        start: the offset of the name.
    """

    name: str
    type: str
    default: str
    file: Path
    start: int


@dataclass(frozen=True, slots=True)
class DeclaredTopic:
    """A topic, service or action that a source creates.

    Attributes:
        name: the name in the source.
        type: the type as written in the source, or empty.
        role: the role of the node, such as ``publisher`` or ``action server``.
        file: the source.
        start: the offset of the name.
    """

    name: str
    type: str
    role: str
    file: Path
    start: int


class _Source(NamedTuple):
    """A source file with the parameters and topics that it declares.

    Attributes:
        text: its text.
        parameters: the parameters that it declares.
        topics: the topics, services and actions that it creates.
    """

    text: str
    parameters: tuple[DeclaredParameter, ...]
    topics: tuple[DeclaredTopic, ...]


@dataclass(slots=True)
class _Sources:
    sources: dict[Path, _Source]
    time: float
    cache: dict[Path, tuple[object, _Source]]


_sources: WeakKeyDictionary[Workspace, _Sources] = WeakKeyDictionary()


def declared_parameters(document: Document, node: str) -> list[DeclaredParameter]:
    """Return the parameters that the sources of a node declare.

    The sources of a node contain its name as a string. If none does, all sources of the workspace are used.

    Args:
        document: the file of the request.
        node: the name of the node.

    Raises:
        NotYetKnownError: the sources were never read, and the document does not wait.
    """
    of_node: list[DeclaredParameter] = []
    others: list[DeclaredParameter] = []
    for text, parameters, _ in _list_known_sources(document).values():
        (of_node if f'"{node}"' in text or f"'{node}'" in text else others).extend(parameters)
    return of_node or others


def declared_topics(document: Document, folder: Path) -> list[DeclaredTopic]:
    """Return the topics, services and actions in the sources below a folder, or in one source.

    Args:
        document: the file of the request.
        folder: the folder of a package, or a source.

    Raises:
        NotYetKnownError: the sources were never read, and the document does not wait.
    """
    return [
        topic
        for file, source in _list_known_sources(document).items()
        if file.is_relative_to(folder)
        for topic in source.topics
    ]


def _list_known_sources(document: Document) -> dict[Path, _Source]:
    """Return the source files that declare parameters or topics, by path."""
    sources = _sources.get(document.workspace)
    if sources is not None and time.monotonic() - sources.time <= _CACHE_LIFETIME_S:
        return sources.sources
    if document.waits:
        sources = _sources[document.workspace] = _read_sources(document.workspace, document.texts, sources)
    elif sources is None:
        raise NotYetKnownError
    else:
        document.refreshes.append(partial(_list_known_sources, replace(document, waits=True)))
    return sources.sources


def _read_sources(workspace: Workspace, texts: Mapping[Path, str], cached: _Sources | None) -> _Sources:
    """Read the sources that have changed since they were read before."""
    files = [
        real_path(file)
        for folder in workspace.index.packages
        for file in find_files_and_packages(folder, _SOURCE_SUFFIXES)[0]
    ][:_MAX_FILES]
    cache = {} if cached is None else cached.cache
    sources: dict[Path, _Source] = {}
    for file in files:
        try:
            state: object = texts.get(file) or file.stat().st_mtime_ns
        except OSError:
            continue
        entry = cache.get(file)
        if entry is None or entry[0] != state:
            entry = cache[file] = state, _read_source(workspace.text(file, texts) or "", file)
        if entry[1].text:
            sources[file] = entry[1]
    return _Sources(sources, time.monotonic(), cache)


def _read_source(text: str, file: Path) -> _Source:
    """Return the declarations in a source, or an empty source if there are none."""
    if len(text) > _MAX_TEXT_LENGTH:
        return _Source("", (), ())
    source = _Source(text, tuple(_find_parameters(text, file)), tuple(_find_topics(text, file)))
    return source if source.parameters or source.topics else _Source("", (), ())


def _find_topics(text: str, file: Path) -> Iterator[DeclaredTopic]:
    for match in _ENDPOINT.finditer(text):
        role = match["kind"] or (f"action {match['side'].lower()}" if match["side"] else "")
        kind = (match["type"] or match["message"] or "").strip()
        yield DeclaredTopic(match["name"], kind.replace("::", "/"), role or "topic", file, match.start("name"))


def _find_parameters(text: str, file: Path) -> Iterator[DeclaredParameter]:
    for match in _DECLARATION.finditer(text):
        default = (match[3] or "").strip()
        yield DeclaredParameter(match[2], _derive_type(match[1] or "", default), default, file, match.start(2))


def _derive_type(declared_type: str, default: str) -> str:
    """Derive the type of a parameter from its C++ type, or from the text of its default."""
    cpp_type = _TYPES.get(declared_type.replace(" ", ""))
    if cpp_type is not None:
        return cpp_type
    if default.lower() in ("true", "false"):
        return "bool"
    if default[:1] in ("'", '"'):
        return "string"
    if re.fullmatch(r"-?\d+", default):
        return "integer"
    return "double" if re.fullmatch(r"-?[\d.]+(e-?\d+)?f?", default) else ""
