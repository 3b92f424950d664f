"""Find C++ files that use a class or structure which an included header no longer declares."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.cpp_conditions import blank_disabled
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Versions

_COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_SCOPE = re.compile(r"\b(?:namespace|class|struct)\s+(?P<name>\w+)")
_USED_NAMESPACE = re.compile(r"\busing\s+namespace\s+(?:\w+::)*(?P<name>\w+)")
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<](?P<path>[^">\n]+)[">]', re.MULTILINE)


def find_lost_types(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that use a type which a header lost, each with a change.

    Types that another file of the repository declares are left out, as are files that do not include the header.
    """
    lost = {file.new_path: names for file in changed_files if file.new_path and (names := _find_lost(versions, file))}
    if not lost:
        return
    paths = versions.new.paths(CPP_SUFFIXES)
    texts = {path: versions.new.text(path) for path in paths if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)}
    codes = {path: blank_comments(text) for path, text in texts.items()}
    for header, names in lost.items():
        declared = _find_declared(names, codes.values())
        scopes = {match["name"] for match in _SCOPE.finditer(versions.old.text(_find_old_path(changed_files, header)))}
        for path in find_including_files(texts, header):
            if {match["name"] for match in _USED_NAMESPACE.finditer(codes[path])} <= scopes | {"std"}:
                yield from _find_uses(
                    path, codes[path], header, [name for name in names if name not in declared], scopes
                )


def _find_declared(names: Sequence[str], codes: Iterable[str]) -> set[str]:
    """Return the names that a file declares, of any kind."""
    any_name = "|".join(map(re.escape, names))
    pattern = re.compile(
        rf"\b(?:class|struct|union|enum|typename|define|using)\s+(?:[A-Z]\w*_\w+\s+|class\s+|struct\s+|(?:\w+::)+)?"
        rf"(?P<name>{any_name})\b|(?:\}}|\btypedef\b[^;{{}}]*)\s*\b(?P<alias>{any_name})\s*;"
    )
    return {match["name"] or match["alias"] for code in codes for match in pattern.finditer(code)}


def _find_uses(
    path: str, code: str, header: str, names: Sequence[str], scopes: Collection[str]
) -> Iterator[tuple[str, Change]]:
    """Yield a change for the first use of each name in a file.

    The name may have a scope of the header.
    """
    for name in names:
        pattern = re.compile(rf"(?<![\w.>:])(?:(?P<scope>\w+)::)*{name}\b(?=\s*(?:[&*]\s*|\s)\w|\s*::|\s*[>&*])")
        use = next((match for match in pattern.finditer(code) if match["scope"] in (None, *scopes)), None)
        if use is not None:
            yield path, _make_change(path, header, name, code[: use.start()].count("\n") + 1)


def _find_old_path(changed_files: Sequence[ChangedFile], path: str) -> str:
    return next(file.old_path for file in changed_files if file.new_path == path and file.old_path)


def _find_lost(versions: Versions, file: ChangedFile) -> list[str]:
    """Return the classes and structures that only the old version of a header has."""
    if file.old_path is None or PurePosixPath(file.path).suffix not in HEADER_SUFFIXES or file.is_submodule:
        return []
    old, new = (
        {item.name for item in names.of_kind(NameKind.CLASS)} | names.hidden_classes
        for names in (
            read_source_names(versions.old.file(file.old_path)),
            read_source_names(versions.new.file(file.new_path or "")),
        )
    )
    return sorted(old - new)


def find_including_files(texts: Mapping[str, str], header: str) -> list[str]:
    """Return the paths of the files that include a header directly or indirectly."""
    included_paths = [header]
    for included in included_paths:
        name = PurePosixPath(included).name
        for path, text in texts.items():
            is_new = path not in included_paths and name in text
            if is_new and any(_ends_with(included, match["path"]) for match in _INCLUDE.finditer(text)):
                included_paths.append(path)
    return included_paths[1:]


def _ends_with(path: str, included: str) -> bool:
    parts = tuple(part for part in PurePosixPath(included).parts if part != "..")
    return bool(parts) and PurePosixPath(path).parts[-len(parts) :] == parts


def _make_change(path: str, header: str, name: str, line: int) -> Change:
    text = phrase("uses '{name}', which '{file}' no longer has", name=name, file=header)
    return Change(text, Effect.BREAKING, phrase("the code does not build"), Location(path, line, 1))


def blank_comments(text: str) -> str:
    """Return a C++ source with spaces for comments, disabled code and texts in quotation marks."""
    return _COMMENT_OR_TEXT.sub(_blank_match, blank_disabled(text))


def _blank_match(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match[0])
