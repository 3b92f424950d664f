"""Find C++ files that use a class, structure or enumerator which an included header no longer declares."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, NameKind, SourceNames
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import Versions

_COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_SCOPE = re.compile(r"\b(?:namespace|enum\s+(?:class|struct)|class|struct|enum)\s+(?P<names>\w+(?:::\w+)*)")
_USED_NAMESPACE = re.compile(r"\busing\s+namespace\s+(?:\w+::)*(?P<name>\w+)")
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<](?P<path>[^">\n]+)[">]', re.MULTILINE)
_TYPE_USE = r"(?=\s*(?:[&*]\s*|\s)\w|\s*::|\s*[>&*])"
_ENUMERATOR_USE = r"(?!\s*(?:\w|[({]|::))"
"""The patterns of the code behind the name of a type and of an enumerator."""
_ENUMERATION = re.compile(r"\benum\b[^;{}()]*\{(?P<body>[^{}]*)\}")


def find_lost_types(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that use a type or enumerator which a header lost, each with a change.

    Names that another file of the repository declares are left out, as are files that do not include the header.
    """
    lost = {file.new_path: found for file in changed_files if file.new_path and (found := _find_lost(versions, file))}
    if not lost:
        return
    texts = {path: versions.new.text(path) for path in versions.new.paths(CPP_SUFFIXES)}
    codes = {path: blank_comments(text) for path, text in texts.items()}
    for header, (names, enumerators) in lost.items():
        declared = _find_declared([*names, *enumerators], codes.values())
        old_text = versions.old.text(_find_old_path(changed_files, header))
        scopes = {name for match in _SCOPE.finditer(old_text) for name in match["names"].split("::")}
        for path in find_including_files(texts, header):
            if {match["name"] for match in _USED_NAMESPACE.finditer(codes[path])} <= scopes | {"std"}:
                for own, pattern in ((names, _TYPE_USE), (enumerators, _ENUMERATOR_USE)):
                    lost_names = [name for name in own if name not in declared]
                    yield from _find_uses(path, codes[path], header, lost_names, scopes, pattern)


def _find_declared(names: Sequence[str], codes: Iterable[str]) -> set[str]:
    """Return the names that a file declares, of any kind."""
    any_name = "|".join(map(re.escape, names))
    pattern = re.compile(
        rf"\b(?:class|struct|union|enum|typename|define|using)\s+(?:[A-Z]\w*_\w+\s+|class\s+|struct\s+|(?:\w+::)+)?"
        rf"(?P<name>{any_name})\b|(?:\}}|\btypedef\b[^;{{}}]*)\s*\b(?P<alias>{any_name})\s*;|"
        rf"\b(?:const|constexpr)\b[^;{{}}()=]*\b(?P<value>{any_name})\b(?=\s*[=,}}{{])"
    )
    enumerator = re.compile(rf"(?:^|,)\s*(?P<name>{any_name})\b(?=\s*(?:[=,]|$))")
    declared = set()
    for code in codes:
        declared |= {match[match.lastgroup or 0] for match in pattern.finditer(code)}
        for enumeration in _ENUMERATION.finditer(code):
            declared |= {match["name"] for match in enumerator.finditer(enumeration["body"])}
    return declared


def _find_uses(
    path: str, code: str, header: str, names: Sequence[str], scopes: AbstractSet[str], use_pattern: str
) -> Iterator[tuple[str, Change]]:
    """Yield a change for the first use of each name in a file.

    The name may have scopes of the header.
    """
    for name in names:
        pattern = re.compile(rf"(?<![\w.>:])(?P<scopes>(?:\w+::)*){name}\b{use_pattern}")
        matches = (match for match in pattern.finditer(code) if scopes >= set(match["scopes"].split("::")[:-1]))
        use = next(matches, None)
        if use is not None:
            yield path, _make_change(path, header, name, code[: use.start()].count("\n") + 1)


def _find_old_path(changed_files: Sequence[ChangedFile], path: str) -> str:
    return next(file.old_path for file in changed_files if file.new_path == path and file.old_path)


def _find_lost(versions: Versions, file: ChangedFile) -> tuple[list[str], list[str]] | None:
    """Return the types and the enumerators that only the old version of a header has; None if there are none."""
    if file.old_path is None or PurePosixPath(file.path).suffix not in HEADER_SUFFIXES or file.is_submodule:
        return None
    old, new = (
        read_source_names(versions.old.file(file.old_path)),
        read_source_names(versions.new.file(file.new_path or "")),
    )
    types, enumerators = ([set(find(names)) for names in (old, new)] for find in (_list_types, _list_enumerators))
    lost = sorted(types[0] - types[1]), sorted(enumerators[0] - enumerators[1])
    return lost if any(lost) else None


def _list_types(names: SourceNames) -> set[str]:
    return {item.name for item in names.of_kind(NameKind.CLASS)} | names.hidden_classes


def _list_enumerators(names: SourceNames) -> set[str]:
    return {name for enumerators in names.enumerations.values() for name in enumerators}


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
