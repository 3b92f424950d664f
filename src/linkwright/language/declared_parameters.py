"""The parameters that the sources of the workspace's own nodes declare, in Python and C++."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from weakref import WeakKeyDictionary

from linkwright.language.format import Document, NotYetKnownError
from linkwright.language.includes import real
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import walk

_SOURCES = (".py", ".cpp", ".hpp", ".cc", ".cxx", ".h")
_MAX_FILES = 3000
_MAX_TEXT = 300_000
_SECONDS = 10.0
"""How long the sources are used before they are searched and read again."""
_DECLARATION = re.compile(
    r"""declare_parameter\s{0,9}(?:<([\w:<> ]{1,80})>)?\s{0,9}\(\s{0,99}["']([\w.]+)["']"""
    r"""\s{0,99}(?:,\s{0,99}([^,()\n]{1,200}))?"""
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
        type: the type, as ROS 2 names it; empty if the source does not tell it.
        default: the text of the default; empty if it has none.
        file: the source.
        start: the offset of the name.
    """

    name: str
    type: str
    default: str
    file: Path
    start: int


@dataclass(slots=True)
class _Sources:
    found: list[tuple[str, tuple[DeclaredParameter, ...]]]
    time: float
    cache: dict[Path, tuple[object, str, tuple[DeclaredParameter, ...]]]


_sources: WeakKeyDictionary[Workspace, _Sources] = WeakKeyDictionary()


def declared_parameters(document: Document, node: str) -> list[DeclaredParameter]:
    """Return the parameters that the sources of a node declare.

    These are the sources that contain the name of the node as a string; if none does, all sources of the workspace.

    Args:
        document: the file that asks.
        node: the name of the node.

    Raises:
        NotYetKnownError: the sources were never read, and the document does not wait.
    """
    of_node: list[DeclaredParameter] = []
    others: list[DeclaredParameter] = []
    for text, parameters in _known(document):
        (of_node if f'"{node}"' in text or f"'{node}'" in text else others).extend(parameters)
    return of_node or others


def _known(document: Document) -> list[tuple[str, tuple[DeclaredParameter, ...]]]:
    """Return the texts of the sources that declare parameters, each with these parameters."""
    sources = _sources.get(document.project)
    if sources is not None and time.monotonic() - sources.time <= _SECONDS:
        return sources.found
    if document.waits:
        sources = _sources[document.project] = _read(document.project, document.texts, sources)
    elif sources is None:
        raise NotYetKnownError
    else:
        document.refreshes.append(partial(_known, replace(document, waits=True)))
    return sources.found


def _read(project: Workspace, texts: Mapping[Path, str], before: _Sources | None) -> _Sources:
    """Read the sources that have changed since they were read before."""
    files = [real(file) for folder in project.index.packages for file in walk(folder, _SOURCES)[0]][:_MAX_FILES]
    cache = {} if before is None else before.cache
    found: list[tuple[str, tuple[DeclaredParameter, ...]]] = []
    for file in files:
        try:
            state: object = texts.get(file) or file.stat().st_mtime_ns
        except OSError:
            continue
        entry = cache.get(file)
        if entry is None or entry[0] != state:
            text = project.text(file, texts) or ""
            parameters = tuple(_declarations(text, file)) if len(text) <= _MAX_TEXT else ()
            entry = cache[file] = (state, text if parameters else "", parameters)
        if entry[2]:
            found.append((entry[1], entry[2]))
    return _Sources(found, time.monotonic(), cache)


def _declarations(text: str, file: Path) -> Iterator[DeclaredParameter]:
    for match in _DECLARATION.finditer(text):
        default = (match[3] or "").strip()
        yield DeclaredParameter(match[2], _type_of(match[1] or "", default), default, file, match.start(2))


def _type_of(written: str, default: str) -> str:
    """Return the type of a parameter by its type in C++, or by the text of its default."""
    cpp_type = _TYPES.get(written.replace(" ", ""))
    if cpp_type is not None:
        return cpp_type
    if default.lower() in ("true", "false"):
        return "bool"
    if default[:1] in ("'", '"'):
        return "string"
    if re.fullmatch(r"-?\d+", default):
        return "integer"
    return "double" if re.fullmatch(r"-?[\d.]+(e-?\d+)?f?", default) else ""
