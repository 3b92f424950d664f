"""Find descriptions that still include a removed file or call a removed macro."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.parts.include_graph import IncludeGraph, IncludeGraphs
from linkwright.review.parts.outline import Outline
from linkwright.review.versions import Version, Versions
from linkwright.xmltree import Element

_INCLUDE, _XACRO = "xacro:include", "xacro:"
_PATH_IN_PACKAGE = re.compile(r"\$\(find\s+([\w-]+)\s*\)/+([^$]+)")


def find_left_uses(
    versions: Versions, files: Sequence[ChangedFile], graphs: IncludeGraphs
) -> Iterator[tuple[str, Change]]:
    """Yield the descriptions that use what the new version no longer has, each with a change.

    These are includes of removed and renamed files, and calls of macros that no file defines for them.

    Args:
        versions: the repository before and after the change.
        files: the changed files of the review.
        graphs: the includes of both versions.
    """
    renamed = {file.old_path: file.new_path for file in files if file.old_path and file.old_path != file.new_path}
    paths = {file.old_path for file in files if file.old_path}
    macros = {name for path in paths for name in graphs.old.find_macros(path) if _is_lost(name, path, graphs)}
    if not renamed and not macros:
        return
    for path, outline in graphs.new.iterate_outlines():
        includes = list(_find_left_includes(versions, path, outline, renamed))
        yield from ((path, change) for change in includes)
        if macros and not includes:
            yield from ((path, change) for change in _find_left_calls(versions.new, path, outline, macros, graphs))


def _is_lost(name: str, path: str, graphs: IncludeGraphs) -> bool:
    """Return whether the new version no longer defines a macro in its file."""
    return name not in graphs.new.find_macros(path)


def _find_left_includes(
    versions: Versions, path: str, outline: Outline, renamed: Mapping[str, str | None]
) -> Iterator[Change]:
    for element in outline.root.walk():
        if element.tag != _INCLUDE or element.attributes.get("optional") == "true":
            continue
        filename = element.attributes.get("filename", "").strip()
        old = resolve_include(versions.old, path, filename)
        old_path = None if old is None or not old.is_file() else versions.old.relative(old)
        if old_path is None or old_path not in renamed:
            continue
        new = resolve_include(versions.new, path, filename)
        if new is None or new.exists():
            continue
        new_path = renamed[old_path]
        text = phrase("includes '{file}', which was removed", file=filename)
        if new_path is not None:
            text = phrase("includes '{file}', which is now {path}", file=filename, path=new_path)
        yield _make_change(text, _find_location(versions.new, path, element))


def resolve_include(version: Version, path: str, filename: str) -> Path | None:
    """Return the file that an include names, or None if its path is computed or its package unknown."""
    folder = version.file(path).parent
    match = _PATH_IN_PACKAGE.fullmatch(filename)
    if match is not None:
        share = version.share_of(match[1], folder)
        return None if share is None else share / match[2]
    return None if "$" in filename or not filename else Path(os.path.normpath(folder / filename))


def _find_left_calls(
    version: Version, path: str, outline: Outline, macros: Collection[str], graphs: IncludeGraphs
) -> Iterator[Change]:
    found: dict[str, Element] = {}
    for element in outline.root.walk():
        name = element.tag.removeprefix(_XACRO)
        if name in macros and name != element.tag:
            found.setdefault(name, element)
    for name, element in found.items():
        if _knows_macro(graphs.old, path, name) and not _knows_macro(graphs.new, path, name):
            text = phrase("calls the macro '{name}', which no longer exists", name=name)
            if graphs.new.find_files_with_macro(name):
                text = phrase("calls the macro '{name}', which no included file defines any more", name=name)
            yield _make_change(text, _find_location(version, path, element))


def _knows_macro(graph: IncludeGraph, path: str, name: str) -> bool:
    """Return whether a file, or a robot that includes it, reads a definition of a macro."""
    return any(
        graph.declares(reader, lambda outline: name in outline.macros)
        for reader in (path, *graph.find_robots_with(path))
    )


def _make_change(text: Phrase, location: Location | None) -> Change:
    return Change(text, Effect.BREAKING, phrase("descriptions that use the file cannot be expanded"), location)


def _find_location(version: Version, path: str, element: Element) -> Location | None:
    span = element.span()
    return None if span is None else Location(path, span.line, span.column, version.is_old)
