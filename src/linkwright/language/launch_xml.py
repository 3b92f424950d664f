"""Launch files in XML: values of attributes by their element, substitutions, and arguments of included files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind, complete
from linkwright.language.cursor import Cursor, Spot, cursor_at
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.grammar import is_launch_file, rule_at
from linkwright.language.hover import Explanation, explain_at
from linkwright.language.launch_arguments import LaunchArgument, arguments_in, likely_values
from linkwright.language.launch_schema import LAUNCH, choices_of
from linkwright.language.launch_text import (
    evaluated,
    open_substitution,
    path_words,
    substitution_around,
    substitution_names,
    typed_word,
)
from linkwright.language.links import FileReference
from linkwright.language.offers import (
    explain_file,
    explain_package,
    explain_program,
    offer_components,
    offer_files,
    offer_packages,
    offer_programs,
    offer_values,
    target_of_component,
    target_of_file,
    target_of_package,
    target_of_program,
)
from linkwright.language.outline import Outline, OutlineElement
from linkwright.packages.share_layout import source_of
from linkwright.schema import describe_attribute
from linkwright.xmltree.tokens import Kind, Token, tokens

_PACKAGES = frozenset({"find-pkg-share", "find-pkg-prefix", "find"})
_VARIABLES = frozenset({"var", "arg"})
_USE = re.compile(r"\$\((?:var|arg)\s+([\w./-]+)")
_PATHS = frozenset({"file", "from", "filename", "world_sdf_file", "config_file", "new_log_dir", "cwd"})
_INTO_ARGUMENTS = frozenset({"arg", "let"})
_WITH_VARIABLES = frozenset({"value", "default", "args", "cmd", "if", "unless", "namespace", "ros_args"})
_BEGINNINGS = ("$(find-pkg-share ", "$(dirname)/")


@dataclass
class _LaunchText:
    """A launch file in XML, with what it declares."""

    document: Document
    offered: set[str] = field(default_factory=set)

    @cached_property
    def arguments(self) -> list[LaunchArgument]:
        return arguments_in(self.document.text, self.document.file)

    @cached_property
    def configurations(self) -> Mapping[str, str | None]:
        return {argument.name: argument.default for argument in self.arguments}

    def used_names(self, apart: int) -> list[str]:
        """Return the names in ``$(var NAME)`` that the file does not declare, except the one at an offset."""
        found = (use for use in _USE.finditer(self.document.text) if use.start(1) != apart)
        return [name for name in dict.fromkeys(use[1] for use in found) if name not in self.configurations]

    def path_of(self, written: str) -> Path | None:
        """Return the path of a text, relative to the folder of the file; None if it is not known."""
        text = evaluated(written, self.document.file, self.document.finder, self.configurations)
        return None if not text or "\0" in text else self.document.file.parent / text

    def included_arguments(self, offset: int) -> list[LaunchArgument]:
        """Return the arguments of the file that the ``include`` around an offset includes."""
        around = Outline.of(self.document.text).around(offset)
        include = next((element for element in reversed(around) if element.tag.name == "include"), None)
        written = "" if include is None else _given(include.tag).get("file", "")
        path = self.path_of(written) if written else None
        if path is None or not path.is_file():
            return []
        path = Path(source_of(str(path)))
        found = arguments_in(self.document.other(path), path)
        return [argument for argument in found if argument.is_argument]

    def package_of(self, cursor: Cursor) -> str | None:
        """Return the package in the tag at a cursor."""
        given = {} if cursor.token is None else _given(cursor.token)
        written = given.get("pkg", "")
        return evaluated(written, self.document.file, self.document.finder, self.configurations) if written else None


def _given(token: Token) -> dict[str, str]:
    return {attribute.name: attribute.value or "" for attribute in token.attributes()}


# --- completion -----------------------------------------------------------------------------------------------


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    cursor = cursor_at(document.text, offset)
    if cursor.spot is not Spot.VALUE or cursor.attribute is None:
        yield from complete(document.text, offset, document.file, (), lambda: document.finder)
        return
    launch = _LaunchText(document)
    substitution = open_substitution(cursor.typed)
    if substitution is not None:
        start = offset - len(substitution.typed)
        if not substitution.arguments:
            for name, purpose in substitution_names().items():
                yield Completion(name, ItemKind.FUNCTION, start, purpose)
        elif substitution.command in _PACKAGES:
            yield from offer_packages(document, start)
        elif substitution.command in _VARIABLES and len(substitution.arguments) == 1:
            yield from _offer_arguments(launch.arguments, start)
            for name in launch.used_names(start):
                yield Completion(name, ItemKind.NAME, start)
        elif substitution.command == "exec-in-pkg" and len(substitution.arguments) > 1:
            yield from offer_packages(document, start)
        elif substitution.command == "find-exec":
            yield from offer_values(("xacro", "python3", "ros2"), start)
        return
    yield from _values(launch, cursor)


def _offer_arguments(arguments: list[LaunchArgument], start: int) -> Iterator[Completion]:
    for argument in arguments:
        detail = "" if argument.default is None else argument.default
        yield Completion(argument.name, ItemKind.NAME, start, detail, argument.described())


def _values(launch: _LaunchText, cursor: Cursor) -> Iterator[Completion]:
    document, offset, typed = launch.document, cursor.offset, cursor.typed
    tag, name = cursor.tags[-1], cursor.attribute.name if cursor.attribute else ""
    start = offset - len(typed)
    rule = rule_at(LAUNCH, cursor.tags)
    attribute = None if rule is None else rule.attribute_rules.get(name)
    is_included = tag in _INTO_ARGUMENTS and "include" in cursor.tags[:-1]
    if name == "pkg":
        yield from offer_packages(document, start)
    elif name == "exec":
        yield from offer_programs(document, launch.package_of(cursor), start)
    elif name == "plugin":
        yield from offer_components(document, launch.package_of(cursor), start)
    elif is_included and name == "name":
        given = _given_arguments(document.text, offset)
        found = launch.included_arguments(offset) or launch.arguments
        yield from _offer_arguments([each for each in found if each.name not in given], start)
        return
    elif name in ("if", "unless"):
        yield from _offer_variables(launch, start, [each for each in launch.arguments if each.is_condition])
        yield from offer_values(("true", "false"), start)
    elif attribute is not None and choices_of(attribute):
        yield from offer_values(choices_of(attribute), start)
    elif name in ("value", "default"):
        if is_included and cursor.token is not None:
            named = _given(cursor.token).get("name", "")
            yield from _offer_variables(launch, start, _named(launch.arguments, named))
        yield from offer_values(_choices(launch, cursor, is_included=is_included), start)
    elif tag in ("param", "set_parameter") and name == "name":
        yield Completion("use_sim_time", ItemKind.NAME, start)
    word = typed_word(typed)
    if name in _PATHS:
        yield from offer_values((begin for begin in _BEGINNINGS if begin.startswith(word)), offset - len(word))
    if "/" in word or name in _PATHS:
        yield from _offer_path(launch, word, offset, launch_files=tag == "include")
    if (name in _PATHS or name in _WITH_VARIABLES) and (not word or word.startswith("$")):
        yield from _offer_variables(launch, offset - len(word), launch.arguments)


def _offer_variables(launch: _LaunchText, start: int, arguments: Iterable[LaunchArgument]) -> Iterator[Completion]:
    """Yield arguments as substitutions, those that an earlier call has yielded left out."""
    for argument in arguments:
        if argument.name not in launch.offered:
            launch.offered.add(argument.name)
            yield Completion(f"$(var {argument.name})", ItemKind.NAME, start, argument.default or "")


def _given_arguments(text: str, offset: int) -> set[str]:
    """Return the names of the arguments that the ``include`` around an offset has, except the one at the offset."""
    around = Outline.of(text).around(offset)
    include = next((element for element in reversed(around) if element.tag.name == "include"), None)
    children = [] if include is None else include.children
    return {_given(child.tag).get("name", "") for child in children if not child.tag.start <= offset <= child.tag.end}


def _choices(launch: _LaunchText, cursor: Cursor, *, is_included: bool) -> tuple[str, ...]:
    """Return the likely values of an argument: its choices, or both values of a condition."""
    given = {} if cursor.token is None else _given(cursor.token)
    found = launch.included_arguments(cursor.offset) if is_included else launch.arguments
    name = given.get("name", "")
    argument = next((each for each in found if each.name == name), None)
    if is_included and argument is None:
        return ()
    return likely_values(argument if is_included else None, name, launch.document.text)


def _offer_path(launch: _LaunchText, word: str, offset: int, *, launch_files: bool) -> Iterator[Completion]:
    folder, slash, name = word.rpartition("/")
    if slash and not folder:
        return
    base = launch.path_of(folder) if folder else launch.document.file.parent
    if base is not None:
        yield from offer_files(base, name, offset, launch_files=launch_files)


# --- hover and definition -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Place:
    """The meaning of a place in a launch file.

    Attributes:
        kind: "package", "program", "component", "argument", "file" or "substitution".
        name: the name or path.
        start: the offset of the name.
        end: the offset behind it.
        package: the package of a program or component.
        arguments: the arguments with the name.
    """

    kind: str
    name: str
    start: int
    end: int
    package: str | None = None
    arguments: tuple[LaunchArgument, ...] = ()


def _place_at(launch: _LaunchText, offset: int) -> _Place | None:
    cursor = cursor_at(launch.document.text, offset)
    if cursor.spot is not Spot.VALUE or cursor.attribute is None or cursor.attribute.value is None:
        return None
    value, begin = cursor.attribute.value, cursor.attribute.value_start
    around = substitution_around(value, offset - begin)
    place = None if around is None else _in_substitution(launch, around, offset - begin)
    if place is not None:
        return replace(place, start=begin + place.start, end=begin + place.end)
    return _of_attribute(launch, cursor, value, begin)


def _in_substitution(launch: _LaunchText, around: re.Match[str], offset: int) -> _Place | None:
    command, arguments = around[1], (around[2] or "").strip("'\" ")
    if offset <= around.end(1):
        return _Place("substitution", command, *around.span(1)) if command in substitution_names() else None
    name = arguments.partition(" ")[0]
    start = around.start(2) + (around[2] or "").find(name) if around[2] else around.end(1)
    place = start, start + len(name)
    if command in _PACKAGES:
        return _Place("package", name, *place)
    if command in _VARIABLES:
        return _Place("argument", name, *place, arguments=_named(launch.arguments, name))
    if command == "exec-in-pkg" and " " in arguments:
        return _Place("program", name, *place, package=arguments.split()[-1])
    return None


def _named(arguments: list[LaunchArgument], name: str) -> tuple[LaunchArgument, ...]:
    return tuple(argument for argument in arguments if argument.name == name)


def _of_attribute(launch: _LaunchText, cursor: Cursor, value: str, begin: int) -> _Place | None:
    name = cursor.attribute.name if cursor.attribute else ""
    whole = begin, begin + len(value)
    kinds = {"pkg": "package", "exec": "program", "plugin": "component"}
    if name in kinds:
        return _Place(kinds[name], value, *whole, package=launch.package_of(cursor))
    if name == "name" and cursor.tags[-1] in _INTO_ARGUMENTS:
        is_included = "include" in cursor.tags[:-1]
        found = launch.included_arguments(cursor.offset) if is_included else launch.arguments
        return _Place("argument", value, *whole, arguments=_named(found, value))
    for start, end in path_words(value):
        word = value[start:end]
        if begin + start <= cursor.offset <= begin + end and ("/" in word or name in _PATHS):
            path = launch.path_of(word)
            if path is not None and (path.exists() or name in _PATHS):
                return _Place("file", str(path), begin + start, begin + end)
    return None


def _explain(document: Document, offset: int) -> Explanation | None:
    launch = _LaunchText(document)
    place = _place_at(launch, offset)
    if place is not None:
        text = None
        if place.kind == "package":
            text = explain_package(document, place.name)
        elif place.kind == "program":
            text = explain_program(document, place.package, place.name)
        elif place.kind == "argument":
            text = "\n\n".join(argument.described() for argument in place.arguments)
        elif place.kind == "file":
            text = explain_file(Path(place.name))
        elif place.kind == "substitution":
            text = f"**$({place.name} ...)**: {substitution_names()[place.name]}"
        if text:
            return Explanation(text, place.start, place.end)
    cursor = cursor_at(document.text, offset)
    if cursor.attribute is not None and cursor.spot is Spot.VALUE:
        rule = rule_at(LAUNCH, cursor.tags)
        attribute = None if rule is None else rule.attribute_rules.get(cursor.attribute.name)
        if attribute is not None:
            return Explanation(describe_attribute(attribute), cursor.attribute.start, cursor.attribute.end)
    return explain_at(document.text, offset, document.file, ())


def _define(document: Document, offset: int) -> Iterator[Target]:
    place = _place_at(_LaunchText(document), offset)
    if place is None:
        return
    if place.kind == "package":
        yield from target_of_package(document, place.name)
    elif place.kind == "program":
        yield from target_of_program(document, place.package, place.name)
    elif place.kind == "component":
        yield from target_of_component(document, place.package, place.name)
    elif place.kind == "file":
        yield from target_of_file(Path(place.name))
    for argument in place.arguments:
        yield Target(argument.file, argument.start, argument.end)


# --- links ----------------------------------------------------------------------------------------------------


def _links(document: Document) -> Iterator[FileReference]:
    launch = _LaunchText(document)
    for token in tokens(document.text):
        for attribute in token.attributes() if token.kind is Kind.START else ():
            for start, end in path_words(attribute.value or ""):
                word = (attribute.value or "")[start:end]
                if "/" not in word and attribute.name not in _PATHS:
                    continue
                path = launch.path_of(word)
                if path is not None and path.is_file():
                    begin = attribute.value_start
                    yield FileReference(begin + start, begin + end, Path(source_of(str(path))))


# --- symbols --------------------------------------------------------------------------------------------------

_KINDS = {
    "launch": SymbolKind.GROUP,
    "group": SymbolKind.GROUP,
    "include": SymbolKind.FILE,
    "arg": SymbolKind.ARGUMENT,
    "bool_arg": SymbolKind.ARGUMENT,
    "let": SymbolKind.ARGUMENT,
    "param": SymbolKind.FIELD,
    "remap": SymbolKind.KEY,
    "executable": SymbolKind.FUNCTION,
    **dict.fromkeys(("node", "lifecycle_node", "composable_node", "node_container"), SymbolKind.NODE),
}
_DEEPEST = 50
"""Elements that are nested deeper are left out of the symbols."""
_NAMING = ("name", "exec", "plugin", "file", "from", "namespace", "target", "cmd")


def _symbols(document: Document) -> Iterator[Symbol]:
    return (_symbol(element, 0) for element in Outline.of(document.text).elements)


def _symbol(element: OutlineElement, depth: int) -> Symbol:
    given = _given(element.tag)
    named = next((given[name] for name in _NAMING if given.get(name)), "")
    kind = _KINDS.get(element.tag.name, SymbolKind.OBJECT)
    children = tuple(_symbol(child, depth + 1) for child in element.children) if depth < _DEEPEST else ()
    name = f"{element.tag.name} {named}".strip()
    return Symbol(name, kind, element.tag.start, element.end, children, given.get("pkg", ""))


LAUNCH_XML = Format(is_launch_file, _complete, _explain, _define, _links, _symbols)
"""Launch files in XML."""
