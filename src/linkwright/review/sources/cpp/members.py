"""Find the action servers, action clients and filtered subscriptions of C++ classes, and the classes of functions."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from linkwright.packages import enclosing_package
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.enclosing_folders import list_enclosing_folders
from linkwright.review.sources.names import HEADER_SUFFIXES, NameKind, SourceName

_CLASS = r"(?:\w+::)*(?:Simple(?P<action>ActionServer|ActionClient)|Subscriber)\s*<(?P<type>[^<>;(){}]*)>"
_MEMBER = re.compile(rf"(?<![\w:])(?P<class>{_CLASS})[\s>]*(?P<variable>\w+)\b")
_ALIASES = (
    re.compile(rf"\busing\s+(?P<name>\w+)\s*=\s*{_CLASS}\s*;"),
    re.compile(rf"\btypedef\s+{_CLASS}\s*(?P<name>\w+)\s*;"),
)
_CONSTRUCTION = re.compile(rf"(?:\bmake_(?:unique|shared)\s*<\s*|\bnew\s+){_CLASS}\s*>?\s*(?=\()")
_FILTER = "message_filters::"
_SUBSCRIBING_CALL = r"(?:\s*(?:\.|->)\s*subscribe)?"
"""The method that gives a filtered subscription its topic after the construction."""
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<](?P<path>[^">\n]+)[">]', re.MULTILINE)
_MAX_BYTES = 1 << 20
_MAX_FOLDERS = 4
"""The maximum number of folders above a source in which its headers are searched."""
_MAX_LEVELS = 2
"""The maximum number of folders above a package in which another package of the repository is searched."""


class Construction(NamedTuple):
    """The construction of a member or variable.

    Attributes:
        kind: the kind of the name.
        type: the type of the action or messages as written.
        start: the offset of the parenthesis before its arguments.
    """

    kind: NameKind
    type: str
    start: int


def find_constructions(text: str, headers: Sequence[str]) -> Iterator[Construction]:
    """Yield the constructions of action servers, action clients and filtered subscriptions.

    Args:
        text: the source without comments.
        headers: the texts of the headers that may declare them.
    """
    types: dict[str, tuple[NameKind, str]] = {}
    aliases: dict[str, tuple[NameKind, str]] = {}
    for source in (*headers, text):
        for match in (match for pattern in _ALIASES for match in pattern.finditer(source)):
            aliases[match["name"]] = _get_kind(match["action"]), _normalize_type(match["type"])
        for match in _MEMBER.finditer(source):
            if match["action"] or _FILTER in match["class"]:
                types[match["variable"]] = _get_kind(match["action"]), _normalize_type(match["type"])
    for source in (*headers, text):
        for name, alias in aliases.items():
            types.update((match[1], alias) for match in re.finditer(rf"\b{name}\s+(\w+)\s*[;({{,]", source))
    for variable, (kind, type_name) in types.items():
        method = _SUBSCRIBING_CALL if kind is NameKind.SUBSCRIPTION else ""
        for construction in re.finditer(rf"\b{variable}{method}\s*\(", text):
            yield Construction(kind, type_name, construction.end() - 1)
    for name, (kind, type_name) in aliases.items():
        for construction in re.finditer(
            rf"(?:\bmake_(?:unique|shared)\s*<\s*|\bnew\s+)(?:\w+::)*{name}\s*>?\s*\(", text
        ):
            yield Construction(kind, type_name, construction.end() - 1)
    for match in _CONSTRUCTION.finditer(text):
        if match["action"] or _FILTER in match[0]:
            yield Construction(_get_kind(match["action"]), _normalize_type(match["type"]), match.end())


def _get_kind(action: str | None) -> NameKind:
    return {"ActionServer": NameKind.ACTION, "ActionClient": NameKind.ACTION_CLIENT}.get(
        action or "", NameKind.SUBSCRIPTION
    )


def _normalize_type(text: str) -> str:
    return text.partition(",")[0].strip()


def read_included_headers(path: Path) -> list[str]:
    """Return the texts of the headers that `find_included_headers` finds.

    Args:
        path: the path of a source. The result is empty for a header.
    """
    files = () if path.suffix in HEADER_SUFFIXES else find_included_headers(path)
    return [blank_disabled(file.read_text("utf-8", errors="replace")) for file in files]


def find_included_headers(path: Path) -> list[Path]:
    """Return the headers that a source includes: beside it, or in an ``include`` folder of its package.

    Headers of other packages near it count, but not targets of links and ``..`` outside of a package.

    Args:
        path: the path of a source or header.
    """
    try:
        text = path.read_text("utf-8", errors="replace")
    except OSError:
        return []
    package = enclosing_package(path.parent)
    base = (_find_built_folder(path) if package is None else package[1]).resolve()
    folders = [path.parent, *(folder / "include" for folder in list_enclosing_folders(path.parent, _MAX_FOLDERS))]
    headers = []
    for match in _INCLUDE.finditer(text):
        places = [(base, folder) for folder in folders]
        if package is not None and (other := _find_neighbor(base, match["path"].partition("/")[0])) is not None:
            places.append((other, other / "include"))
        files = (((folder / match["path"]).resolve(), root) for root, folder in places)
        file = next((file for file, root in files if file.is_relative_to(root) and file.is_file()), None)
        if file is not None and file.stat().st_size <= _MAX_BYTES:
            headers.append(file)
    return headers


def _find_built_folder(path: Path) -> Path:
    """Return the folder that CMake builds a source in no package from, or else the folder of the source."""
    folders = list_enclosing_folders(path.parent, _MAX_FOLDERS)
    return next((folder for folder in folders if (folder / "CMakeLists.txt").is_file()), path.parent)


def _find_neighbor(package: Path, name: str) -> Path | None:
    """Return the folder of another package near a package, if it has its name, or None."""
    folders = (folder / name for folder in list_enclosing_folders(package, 1 + _MAX_LEVELS)[1:])
    return next((folder for folder in folders if (folder / "package.xml").is_file()), None)


def has_class(function: SourceName, classes: Collection[str]) -> bool:
    """Return whether a C++ function belongs to one of the given classes or to none."""
    names = function.name.split("::")[:-1]
    return not names or names[-1] in classes
