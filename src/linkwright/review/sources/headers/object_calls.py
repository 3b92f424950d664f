"""Find calls in C++ of methods that the class of an object does not have, where its type is certain."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.review.sources.cpp.text import find_closing_bracket
from linkwright.review.sources.headers.lost_types import blank_comments, find_including_files
from linkwright.review.sources.names import HEADER_SUFFIXES

_CALL = re.compile(
    r"(?<![\w.>:)\]])(?:this\s*->\s*)?(?P<object>[A-Za-z_]\w*)\s*(?P<operator>\.|->)\s*(?P<method>\w+)\s*\("
)
_CLASS = re.compile(
    r"(?P<template>>\s*)?\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?(?P<end>[:{])(?!:)"
)
_MACRO = re.compile(r"^\s*(?!RCLCPP_|EIGEN_)[A-Z_][A-Z\d_]+\b\s*(?:\(|$)", re.MULTILINE)
"""A macro in a class, which may declare methods."""
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<](?P<path>[^">\n]+)[">]', re.MULTILINE)
_POINTER = re.compile(r"(?:\w+\s*::\s*)*(?:unique_ptr|shared_ptr)\s*<\s*(?:const\s+)?(?P<type>[\w:]+)\s*>")
_POINTER_TYPE = re.compile(r"(?P<type>[\w:]+)::(?:SharedPtr|UniquePtr|Ptr)")
_DECLARATION = re.compile(
    r"(?<![\w:])(?P<type>[A-Za-z_]\w*(?:::\w+)*(?:\s{0,4}<[^;(){}]{0,200}>)?(?:::\w+)?)(?P<mark>(?:\s+const\b)?\s*[*&]*\s*)(?<=[\s*&>])"
    r"(?P<name>[A-Za-z_]\w*)\s*(?=[;=({,)\[]|:(?!:))"
)
_BINDING = re.compile(r"\bauto\b[\s&]*\[(?P<names>[\w\s,]*)\]")
_NOT_TYPES = frozenset(("return", "else", "delete", "new", "throw", "case", "goto", "co_return", "typename", "using"))


class MissingMethod(NamedTuple):
    """A call of a method that a class does not have.

    Attributes:
        header: the path of the file that declares the class.
        class_name: the name of the class.
        method: the name of the method.
        line: the line of the call, starting at 1.
    """

    header: str
    class_name: str
    method: str
    line: int


class ObjectCalls:
    """The calls of methods of objects in the C++ sources of a version.

    Args:
        texts: the texts of the sources by path.
    """

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._texts = texts
        self._declarations: dict[str, dict[str, set[tuple[str, bool]]]] = {}
        self._classes: dict[str, tuple[str, str] | None] = {}
        self._including: dict[str, frozenset[str]] = {}

    @staticmethod
    def list_called(code: str) -> set[str]:
        """Return the names of the methods that a source without comments calls of objects."""
        return {match["method"] for match in _CALL.finditer(code)}

    def find_missing(self, path: str, methods: Collection[str]) -> Iterator[MissingMethod]:
        """Yield the calls of methods, by their names, that the class of the object certainly does not have.

        The class must have no base classes, and all declarations of the object's name in the source and in the
        headers that it includes must have the same type.
        """
        code = blank_comments(self._texts[path]) if methods else ""
        for match in _CALL.finditer(code):
            if match["method"] not in methods:
                continue
            found = self._find_type(path, match["object"])
            if found is None or found[1] != (match["operator"] == "->"):
                continue
            *scopes, name = found[0].split("::")
            declared = self._find_class(name)
            if declared is None or re.search(rf"\b{match['method']}\b", declared[1]):
                continue
            header = declared[0]
            if self._is_included(path, header) and all(scope in self._texts[header] for scope in scopes):
                yield MissingMethod(header, name, match["method"], code.count("\n", 0, match.start()) + 1)

    def _is_included(self, path: str, header: str) -> bool:
        """Return whether a source includes a header, directly or indirectly."""
        if header not in self._including:
            self._including[header] = frozenset(find_including_files(self._texts, header))
        return path == header or path in self._including[header]

    def _find_type(self, path: str, name: str) -> tuple[str, bool] | None:
        """Return the class of an object as it is spelled, and whether it is a pointer; None if it is not certain."""
        declared = [self._read_declarations(path), *map(self._read_declarations, self._list_headers(path))]
        types = set().union(*(items.get(name, ()) for items in declared))
        return types.pop() if len(types) == 1 else None

    def _read_declarations(self, path: str) -> Mapping[str, set[tuple[str, bool]]]:
        """Return the types that a file declares for each name."""
        known = self._declarations.get(path)
        if known is None:
            known = self._declarations[path] = {}
            code = blank_comments(self._texts[path])
            for match in _DECLARATION.finditer(code):
                found = _read_type(match["type"], match["mark"])
                if found is not None:
                    known.setdefault(match["name"], set()).add(found)
            for match in _BINDING.finditer(code):
                for name in re.findall(r"\w+", match["names"]):
                    known.setdefault(name, set()).add(("auto", False))
        return known

    def _list_headers(self, path: str) -> Iterator[str]:
        """Yield the paths of the headers of the repository that a source includes."""
        names = [match["path"] for match in _INCLUDE.finditer(self._texts[path])]
        for name in names:
            yield from self._headers.get(PurePosixPath(name).name, ())

    @cached_property
    def _headers(self) -> Mapping[str, list[str]]:
        """The paths of the headers by file name."""
        found: dict[str, list[str]] = {}
        for path in self._texts:
            if path.endswith(tuple(HEADER_SUFFIXES)):
                found.setdefault(PurePosixPath(path).name, []).append(path)
        return found

    def _find_class(self, name: str) -> tuple[str, str] | None:
        """Return the path and the body of a class, if one header declares it.

        It must have no base classes, no parameters of a template, no macros and no operators.
        """
        if name not in self._classes:
            word = re.compile(rf"\b(?:class|struct)\b[^;{{}}()]*\b{re.escape(name)}\b")
            paths = [path for path, text in self._texts.items() if name in text and word.search(text)]
            found = [item for path in paths for item in self._read_classes(path, name)]
            body = found[0][1] if len(found) == 1 else ""
            is_plain = bool(body) and not _MACRO.search(body) and "operator" not in body
            self._classes[name] = found[0] if is_plain else None
        return self._classes[name]

    def _read_classes(self, path: str, name: str) -> Iterator[tuple[str, str]]:
        """Yield the path and the body of each class with a name in a file; the body of an unsuitable one is empty."""
        code = blank_comments(self._texts[path])
        for match in _CLASS.finditer(code):
            if match["name"] == name:
                is_plain = match["end"] == "{" and match["template"] is None and path.endswith(tuple(HEADER_SUFFIXES))
                start = match.end() - 1
                yield path, code[start : find_closing_bracket(code, start)] if is_plain else ""


def _read_type(text: str, mark: str) -> tuple[str, bool] | None:
    """Return the class in a declared type, with its namespaces, and whether it is a pointer; None for a keyword.

    The class of any other type is its text, which is the name of no class of the repository.
    """
    pointer = _POINTER.fullmatch(text) or _POINTER_TYPE.fullmatch(text)
    if text in _NOT_TYPES:
        return None
    name = text if pointer is None else pointer["type"]
    return name, pointer is not None or "*" in mark
