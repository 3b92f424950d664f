"""Completions at a place of an XML file: what its language, its package and its macros offer there."""

from __future__ import annotations

import builtins
import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from linkwright.diagnostics import Phrase
from linkwright.language.cursor import Cursor, Spot, cursor_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.grammar import PREFIX, XACRO, has_xacro, root_of, rule_at
from linkwright.language.occurrences import kinds_of_reference
from linkwright.language.parameters import called_macro, macro_parameters
from linkwright.packages import PackageFinder
from linkwright.schema import AttributeRule, ElementRule, describe_attribute, describe_element
from linkwright.xacro.macros import Parameter

_CHOICES = {
    ("joint", "type"): ("revolute", "continuous", "prismatic", "fixed", "floating", "planar"),
    ("xacro:property", "scope"): ("parent", "global"),
}
FUNCTIONS = tuple(
    sorted(
        {name for name in dir(math) if name[0] != "_"} | {"abs", "len", "max", "min", "round", "str", "int", "float"}
    )
)
"""Names of functions and constants that expressions have (ros/xacro 2.1)."""
_COMMANDS = ("arg", "find", "env", "optenv", "cwd", "dirname", "eval")
_PACKAGE = re.compile(r"^package://([^/]*)$")
_PATH = re.compile(r"^(?:package://|\$\(find\s+)([^/)]+)\)?/(.*)$")
_SHOWN_FILES = 200


class ItemKind(Enum):
    """The kinds of completions, for the icons of editors."""

    ELEMENT = "element"
    ATTRIBUTE = "attribute"
    VALUE = "value"
    MACRO = "macro"
    PROPERTY = "property"
    FUNCTION = "function"
    NAME = "name"
    PACKAGE = "package"
    FILE = "file"
    FOLDER = "folder"


@dataclass(frozen=True, slots=True)
class Completion:
    """A completion.

    Attributes:
        label: the text to show and, without a snippet, to write.
        kind: its kind.
        start: the offset from which the typed text is replaced, up to the cursor.
        detail: a few words beside the label.
        description: a text in Markdown.
        snippet: the text to write in the syntax of snippets; empty for the label.
    """

    label: str
    kind: ItemKind
    start: int
    detail: str = ""
    description: str | Phrase = ""
    snippet: str = ""


def complete(
    text: str, offset: int, file: Path, names: Sequence[NameDefinition], finder: Callable[[], PackageFinder]
) -> list[Completion]:
    """Return the completions at an offset.

    Args:
        text: the text of the file.
        offset: the character offset of the cursor.
        file: the file, whose name tells the language.
        names: the names that the files of the description define.
        finder: returns what finds packages.
    """
    root = root_of(file)
    if root is None:
        return []
    cursor = cursor_at(text, offset)
    if cursor.spot is Spot.TAG or (cursor.spot is Spot.TEXT and not cursor.typed.strip()):
        return [*_elements(cursor, root, names, opens=cursor.spot is Spot.TEXT)]
    if cursor.spot is Spot.CLOSING_TAG and cursor.tags:
        return [Completion(cursor.tags[-1], ItemKind.ELEMENT, offset - len(cursor.typed))]
    if cursor.spot is Spot.ATTRIBUTE:
        return [*_attributes(cursor, root, names)]
    if cursor.spot in (Spot.VALUE, Spot.TEXT):
        return [*_values(cursor, file, names, finder)]
    return []


def _elements(
    cursor: Cursor, root: ElementRule, names: Sequence[NameDefinition], *, opens: bool
) -> Iterator[Completion]:
    start = cursor.offset if opens else cursor.offset - len(cursor.typed)
    mark = "<" if opens else ""
    rule = rule_at(root, cursor.tags)
    in_macro_alone = bool(cursor.tags) and rule is None and all(tag.startswith(PREFIX) for tag in cursor.tags[1:])
    if not cursor.tags:
        offered: Iterable[ElementRule] = [root]
    else:
        offered = (rule or (root if in_macro_alone else None) or ElementRule("", "")).child_rules.values()
    for child in offered:
        snippet = mark + _element_snippet(child)
        yield Completion(child.tag, ItemKind.ELEMENT, start, "", describe_element(child), snippet)
    if not cursor.tags or not has_xacro(root):
        return
    for tag in XACRO.values():
        yield Completion(tag.tag, ItemKind.ELEMENT, start, "xacro", describe_element(tag), mark + _element_snippet(tag))
    for macro in _of_kind(names, NameKind.MACRO):
        label = PREFIX + macro.name
        yield Completion(label, ItemKind.MACRO, start, macro.detail, "", mark + _call_snippet(macro))


def _element_snippet(rule: ElementRule) -> str:
    wanted = [attribute for attribute in rule.attributes if attribute.required or attribute.usual]
    written = "".join(f' {attribute.name}="${{{number}}}"' for number, attribute in enumerate(wanted, 1))
    if rule.text is not None:
        return f"{rule.tag}{written}>${{{len(wanted) + 1}}}</{rule.tag}>"
    has_content = bool(rule.child_rules) or rule.tag in ("xacro:macro", "xacro:if", "xacro:unless")
    return f"{rule.tag}{written}>$0</{rule.tag}>" if has_content else f"{rule.tag}{written}/>$0"


def _call_snippet(macro: NameDefinition) -> str:
    parameters = macro_parameters(macro)
    written = "".join(
        f' {parameter.name}="${{{number}}}"'
        for number, parameter in enumerate((each for each in parameters if _is_required(each)), 1)
    )
    tag = PREFIX + macro.name
    return f"{tag}{written}>$0</{tag}>" if any(each.is_block for each in parameters) else f"{tag}{written}/>$0"


def _is_required(parameter: Parameter) -> bool:
    return not parameter.is_block and parameter.default is None and not parameter.forward


def _attributes(cursor: Cursor, root: ElementRule, names: Sequence[NameDefinition]) -> Iterator[Completion]:
    tag = cursor.tags[-1]
    start = cursor.offset - len(cursor.typed)
    given = {attribute.name for attribute in cursor.token.attributes()} if cursor.token else set()
    given.discard(cursor.attribute.name if cursor.attribute else "")
    suffix = "" if cursor.attribute is not None and cursor.attribute.value is not None else '="$1"$0'
    if tag.startswith(PREFIX) and tag not in XACRO:
        macro = called_macro(tag, names)
        for parameter in () if macro is None else macro_parameters(macro):
            if not parameter.is_block and parameter.name not in given:
                yield Completion(parameter.name, ItemKind.ATTRIBUTE, start, "", "", parameter.name + suffix)
        return
    rule = XACRO.get(tag) or rule_at(root, cursor.tags)
    for attribute in () if rule is None else rule.attributes:
        if attribute.name not in given:
            yield _attribute(attribute, start, suffix)


def _attribute(attribute: AttributeRule, start: int, suffix: str) -> Completion:
    detail = f"{attribute.type.name}, {attribute.unit}" if attribute.unit else attribute.type.name
    description = describe_attribute(attribute)
    return Completion(attribute.name, ItemKind.ATTRIBUTE, start, detail, description, attribute.name + suffix)


def _values(
    cursor: Cursor, file: Path, names: Sequence[NameDefinition], finder: Callable[[], PackageFinder]
) -> Iterator[Completion]:
    typed, start = cursor.typed, cursor.offset - len(cursor.typed)
    if cursor.in_expression:
        begin = cursor.offset - len(cursor.word)
        for name in _of_kind(names, NameKind.PROPERTY):
            yield Completion(name.name, ItemKind.PROPERTY, begin, name.detail)
        for function in FUNCTIONS:
            yield Completion(function, ItemKind.FUNCTION, begin, _purpose(function))
        return
    substitution = cursor.substitution
    if substitution is not None and " " in typed[typed.rfind("$(") :].lstrip("$( "):
        command, argument = substitution
        begin = cursor.offset - len(argument)
        if command == "arg":
            for name in _of_kind(names, NameKind.ARGUMENT):
                yield Completion(name.name, ItemKind.NAME, begin, name.detail)
        elif command == "find":
            for package, folder in sorted(finder().packages().items()):
                yield Completion(package, ItemKind.PACKAGE, begin, str(folder))
        return
    if substitution is not None:
        for command in _COMMANDS:
            yield Completion(command, ItemKind.FUNCTION, cursor.offset - len(substitution[0]))
        return
    if cursor.attribute is None:
        return
    key = (cursor.tags[-1], cursor.attribute.name)
    for choice in _CHOICES.get(key, ()):
        yield Completion(choice, ItemKind.VALUE, start)
    for kind in kinds_of_reference(*key):
        for name in _of_kind(names, kind):
            yield Completion(name.name, ItemKind.NAME, start, name.detail)
    if cursor.attribute.name in ("filename", "file", "uri"):
        yield from _paths(typed, cursor.offset, file, finder)


def _paths(typed: str, offset: int, file: Path, finder: Callable[[], PackageFinder]) -> Iterator[Completion]:
    package = _PACKAGE.match(typed)
    if package is not None:
        for name, folder in sorted(finder().packages().items()):
            yield Completion(name, ItemKind.PACKAGE, offset - len(package[1]), str(folder))
        return
    inside = _PATH.match(typed)
    base, rest = (finder().find(inside[1]), inside[2]) if inside else (file.parent, typed)
    if inside is None:
        for beginning in ("package://", "$(find "):
            if beginning.startswith(typed):
                yield Completion(beginning, ItemKind.VALUE, offset - len(typed))
    if base is None:
        return
    below, _, name = rest.rpartition("/")
    try:
        entries = sorted((base / below).iterdir(), key=lambda entry: (entry.is_file(), entry.name))
    except OSError:
        return
    for entry in entries[:_SHOWN_FILES]:
        if not entry.name.startswith("."):
            kind = ItemKind.FILE if entry.is_file() else ItemKind.FOLDER
            yield Completion(entry.name, kind, offset - len(name))


def _of_kind(names: Sequence[NameDefinition], kind: NameKind) -> list[NameDefinition]:
    """Return the definitions of a kind, one for each name."""
    return list({name.name: name for name in reversed(names) if name.kind is kind}.values())


def _purpose(function: str) -> str:
    found = getattr(math, function, None) or getattr(builtins, function, None)
    return (getattr(found, "__doc__", None) or "").partition("\n")[0] if callable(found) else str(found)
