"""Read the classes, functions and members that a C++ source declares."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, Span
from linkwright.review.sources.cpp.functions import (
    HIDDEN,
    PRIVATE,
    PROTECTED,
    DeclaredFunction,
    read_base_names,
    read_declared_functions,
    read_declared_members,
    read_scopes,
)
from linkwright.review.sources.enumerators import read_enumerations
from linkwright.review.sources.names import HEADER_SUFFIXES, YES, Detail, NameKind, SourceName, SourceNames

_NAMESPACE = re.compile(r"^[ \t]*(?:inline\s+)?namespace\s+(?P<name>[A-Za-z_]\w*(?:\s*::\s*\w+)*)\s*\{", re.MULTILINE)
_ALIAS = re.compile(
    r"\btypedef\s+(?P<type>[^;{}]+[\s>*&])(?P<name>\w+)\s*;|\busing\s+(?P<using>\w+)\s*=\s*(?P<used>[^;{}]+);"
)
_CLASS = re.compile(
    r"^[ \t]*(?:class|struct|enum(?:\s+class)?)\s+(?:[A-Z][A-Z\d]*_[A-Z\d_]+\s+(?!final\b))?"
    r"(?P<name>[A-Za-z_]\w*)\s*(?:final\s*)?(?::(?!:)(?P<bases>[^;{]*))?\{",
    re.MULTILINE,
)
_FORWARD_CLASS = re.compile(r"^[ \t]*(?:class|struct)\s+(\w+)\s*;", re.MULTILINE)


def read_declarations(
    source: SourceText,
    text: str,
    names: SourceNames,
    add: Callable[..., None],
    make_span: Callable[[int, int], Span],
) -> None:
    """Add the classes of a C++ source, and the functions, members and other declarations of a header.

    Args:
        source: the source.
        text: its text without comments.
        names: the collection to which the names are added.
        add: adds a name; it gets the kind, the name, its offsets, its type and its details.
        make_span: returns the location of the text between two offsets.
    """
    declarations = _Declarations(source, text, names, add, make_span)
    declarations.read_classes()
    declarations.read_functions()


class _Declarations:
    """Reads the declarations of a C++ source, with the arguments of `read_declarations`."""

    def __init__(
        self,
        source: SourceText,
        text: str,
        names: SourceNames,
        add: Callable[..., None],
        make_span: Callable[[int, int], Span],
    ) -> None:
        self._source = source
        self._text = text
        self._names = names
        self._add = add
        self._make_span = make_span

    def read_classes(self) -> None:
        """Add the classes and enumerations.

        Other packages cannot use those that a class hides.
        """
        scopes = {end: classes for classes, end in read_scopes(self._text, HIDDEN)}
        protected = {end for _, end in read_scopes(self._text, PROTECTED)}
        for match in _CLASS.finditer(self._text):
            end = match.end() - 1
            if end not in scopes:
                self._names.bases.setdefault(match["name"], []).extend(read_base_names(match["bases"] or ""))
                self._add(NameKind.CLASS, match["name"], match.start("name"), match.end("name"))
                continue
            self._names.hidden_classes.add(match["name"])
            if end in protected:
                span = self._make_span(match.start("name"), match.end("name"))
                name = "::".join([*scopes[end], match["name"]])
                self._names.protected.append(SourceName(NameKind.CLASS, name, "", span))

    def read_functions(self) -> None:
        """Add the functions and members of a header.

        The type of a function is the list of parameters of each overload.
        """
        if PurePosixPath(self._source.name).suffix not in HEADER_SUFFIXES:
            return
        for match in _ALIAS.finditer(self._text):
            type_name = re.sub(r"\s*([*&<>,:()])\s*", r"\1", " ".join((match["type"] or match["used"]).split()))
            self._names.aliases[match["name"] or match["using"]] = type_name
        for match in _FORWARD_CLASS.finditer(self._text):
            if self._text.count("{", 0, match.start()) == self._text.count("}", 0, match.start()):
                self._names.forward_classes.add(match[1])
        for match in _NAMESPACE.finditer(self._text):
            self._names.namespaces.setdefault(match["name"], self._make_span(match.start("name"), match.end("name")))
        for enumeration, enumerators in read_enumerations(self._text).items():
            self._names.enumerations[enumeration] = {
                name: (item.value, self._make_span(item.start, item.start + len(name)))
                for name, item in enumerators.items()
            }
        overloads: dict[str, list[DeclaredFunction]] = {}
        for function in read_declared_functions(self._text):
            if function.is_override:
                self._names.overrides.add(function.name)
            else:
                overloads.setdefault(function.name, []).append(function)
        for name, functions in overloads.items():
            if not any(function.is_defined or function.is_pure for function in functions):
                self._names.declared_only.add(name)
            self._names.parameter_names |= {
                (name, _join_overloads([function]).replace(" = ...", "")): function.parameter_names
                for function in functions
            }
            types = _join_overloads(functions)
            details = ((Detail.REQUIRED, YES),) if any(function.is_pure for function in functions) else ()
            if len(functions) == 1 and functions[0].result:
                details = (*details, (Detail.RESULT, functions[0].result))
            if any(function.is_const for function in functions):
                details = (*details, (Detail.CONSTANT, YES))
            start = self._text.find(name.rpartition("::")[2], functions[0].start)
            self._add(NameKind.FUNCTION, name, start, start + len(name.rpartition("::")[2]), types, details)
        for member in read_declared_members(self._text):
            end = member.start + len(member.name.rpartition("::")[2])
            self._add(NameKind.MEMBER, member.name, member.start, end, member.type)
        non_public = (read_declared_functions(self._text, HIDDEN), read_declared_members(self._text, HIDDEN))
        self._names.non_public = frozenset(item.name for items in non_public for item in items)
        protected: dict[str, list[DeclaredFunction]] = {}
        private = [function for function in read_declared_functions(self._text, PRIVATE) if function.is_pure]
        for function in (*read_declared_functions(self._text, PROTECTED), *private):
            if not function.is_override:
                protected.setdefault(function.name, []).append(function)
        for name, functions in protected.items():
            short = name.rpartition("::")[2]
            start = max(functions[0].start, self._text.find(short, functions[0].start))
            span = self._make_span(start, start + len(short))
            details = ((Detail.REQUIRED, YES),) if functions[0] in private else ()
            types = _join_overloads(functions)
            self._names.protected.append(SourceName(NameKind.FUNCTION, name, types, span, details))
        for member in read_declared_members(self._text, PROTECTED):
            span = self._make_span(member.start, member.start + len(member.name.rpartition("::")[2]))
            self._names.protected.append(SourceName(NameKind.MEMBER, member.name, member.type, span))


def _join_overloads(functions: Sequence[DeclaredFunction]) -> str:
    """Return the parameters of each overload of a function."""
    return "; ".join(sorted({", ".join(function.parameters) for function in functions}))
