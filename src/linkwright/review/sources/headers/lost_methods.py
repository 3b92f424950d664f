"""Find C++ sources that call methods which the header of a class no longer declares, or never did."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.headers.lost_types import blank_comments, find_including_files
from linkwright.review.sources.headers.object_calls import ObjectCalls
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_DEFINITION = re.compile(r"\b(?P<class>\w+)::~?\w+\s*\([^;{}]*\)[^;{}]*\{")


def find_lost_methods(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the sources that call a method which its class does not have, each with a change.

    The header lost the method, or a changed source newly calls it through an object whose type is certain.
    Classes with base classes, which may declare the method, are left out.
    """
    lost = {
        file.new_path: methods for file in changed_files if file.new_path and (methods := _find_lost(versions, file))
    }
    new_calls = {
        file.new_path: called
        for file in changed_files
        if file.new_path and file.new_path.endswith(CPP_SUFFIXES) and not file.is_submodule
        if (called := _find_new_calls(versions, file.old_path, file.new_path))
    }
    if not lost and not new_calls:
        return
    paths = versions.new.paths(CPP_SUFFIXES)
    texts = {path: versions.new.text(path) for path in paths if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)}
    calls = ObjectCalls(texts)
    told: set[tuple[str, str, str]] = set()
    for header, methods in lost.items():
        for path in find_including_files(texts, header):
            code = blank_comments(texts[path])
            for class_name, method in methods:
                line = _find_call_line(code, class_name, method)
                if line:
                    yield path, _make_change(path, header, class_name, method, line)
            for call in calls.find_missing(path, {method for _, method in methods}):
                if call.header == header and (call.class_name, call.method) in methods:
                    told.add((path, call.class_name, call.method))
                    yield path, _make_change(path, header, call.class_name, call.method, call.line)
    for path in [path for path in new_calls if path in texts]:
        for call in calls.find_missing(path, new_calls[path]):
            key = path, call.class_name, call.method
            if key not in told:
                told.add(key)
                yield path, _make_change(path, call.header, call.class_name, call.method, call.line)


def _find_new_calls(versions: Versions, old_path: str | None, new_path: str) -> set[str]:
    """Return the names of the methods that only the new version of a source calls of objects."""
    old_text = versions.old.text(old_path) if old_path else ""
    called, known = (ObjectCalls.list_called(blank_comments(text)) for text in (versions.new.text(new_path), old_text))
    return called - known


def _find_lost(versions: Versions, file: ChangedFile) -> list[tuple[str, str]]:
    """Return the classes and methods that only the old version of a header declares."""
    path = PurePosixPath(file.path)
    if file.old_path is None or path.suffix not in HEADER_SUFFIXES or file.is_submodule:
        return []
    code = blank_comments(versions.new.text(file.new_path or ""))
    old, new = _read_methods(versions.old, file.old_path), _read_methods(versions.new, file.new_path or "")
    return [
        (class_name, method)
        for class_name, method in sorted(old - new)
        if not re.search(rf"\b{re.escape(method)}\b", code)
        and re.search(rf"\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?{re.escape(class_name)}\s*(?:final\s*)?\{{", code)
    ]


def _read_methods(version: Version, path: str) -> set[tuple[str, str]]:
    """Return the classes and names of the methods and members that a header declares."""
    names = read_source_names(version.file(path))
    declared = {item.name for item in names.of_kind(NameKind.FUNCTION)} | names.non_public
    parts = (name.split("::") for name in declared)
    return {(part[-2], part[-1]) for part in parts if len(part) > 1}


def _find_call_line(code: str, class_name: str, method: str) -> int:
    """Return the line of the first call of a method in its class, or 0.

    Lines are counted from 1.
    """
    for call in re.finditer(rf"\bthis\s*->\s*{re.escape(method)}\s*\(", code):
        enclosing = [match["class"] for match in _DEFINITION.finditer(code, 0, call.start())]
        if enclosing and enclosing[-1] == class_name:
            return code.count("\n", 0, call.start()) + 1
    return 0


def _make_change(path: str, header: str, class_name: str, method: str, line: int) -> Change:
    text = phrase(
        "calls the method '{name}', which '{class_name}' in '{file}' does not have",
        name=method,
        class_name=class_name,
        file=header,
    )
    return Change(text, Effect.BREAKING, phrase("the code does not build"), Location(path, line, 1))
