"""Completion in expressions ``${...}`` and substitutions ``$(...)`` of a description."""

from __future__ import annotations

import builtins
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from linkwright.language.completion import Completion, ItemKind, definitions_of_kind
from linkwright.language.cursor import Cursor
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document
from linkwright.language.loaded_yaml import find_yaml_value
from linkwright.xacro.expressions.builtin_names import BARE_NAMES, MATHEMATICS
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters

FUNCTIONS = tuple(sorted({*MATHEMATICS, *BARE_NAMES}))
"""The names of the functions and constants in expressions (ros/xacro 2.1)."""
XACRO_FUNCTIONS = {
    "xacro.load_yaml": "the content of a YAML file",
    "xacro.arg": "the value of an argument",
    "xacro.abs_filename": "a path relative to this file as an absolute path",
    "xacro.dotify": "a mapping whose items can also be accessed with a dot",
    "xacro.tokenize": "the parts of a text between separators",
    "xacro.message": "prints a message",
    "xacro.warning": "prints a warning",
    "xacro.error": "prints an error",
    "xacro.fatal": "ends the expansion with an error",
    "xacro.print_location": "prints where the expression is",
}
"""The functions of the namespace ``xacro``, with their purposes."""
_COMMANDS = {
    "arg": "the value of an argument",
    "find": "the folder of a package",
    "env": "an environment variable, which must be set",
    "optenv": "an environment variable, or a default",
    "cwd": "the current folder",
    "dirname": "the folder of this file",
    "eval": "the value of an expression",
}
_COMMON_FUNCTIONS = ("pi", "radians", "sin", "cos", "sqrt", "abs", "max", "min")
_WORDS = re.compile(r"[A-Za-z_]\w*")
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_ITEM_ACCESS = re.compile(
    r"""([A-Za-z_]\w*)((?:\[\s*["'][^"'\]]*["']\s*\]|\.[A-Za-z_]\w*)*)(?:\[\s*["']|\.)([\w-]*)$"""
)
_KEY = re.compile(r"""\[\s*["']([^"'\]]*)["']\s*\]|\.([A-Za-z_]\w*)""")
_MAX_VALUE_LENGTH = 60


def complete_expression(document: Document, cursor: Cursor, names: Sequence[NameDefinition]) -> Iterator[Completion]:
    """Yield the names for an expression: parameters, properties by use, then functions.

    After the name of a mapping from a YAML file and a dot or bracket, yield the keys of the mapping instead.

    Args:
        document: the text.
        cursor: a cursor in ``${...}``.
        names: the names that the files of the description define.
    """
    item = _ITEM_ACCESS.search(cursor.typed)
    if item is not None and item[1] not in ("xacro", "math", "python"):
        yield from _key_completions(document, item, cursor, names)
        return
    begin = cursor.offset - len(cursor.word)
    uses = _count_words(document.text)
    for parameter in parameters_in_scope(cursor):
        detail = "" if parameter.default is None else f"= {parameter.default}"
        yield Completion(parameter.name, ItemKind.PROPERTY, begin, detail, f"**parameter {parameter.name}**")
    macro = cursor.macro
    macro_name = (
        ""
        if macro is None
        else next((attribute.value or "" for attribute in macro.attributes() if attribute.name == "name"), "")
    )
    properties = definitions_of_kind(
        [name for name in names if not name.owner or name.owner == macro_name], NameKind.PROPERTY
    )

    def rank(name: NameDefinition) -> tuple[bool, int, bool]:
        is_near = name.file == document.file
        return not (is_near and name.owner == macro_name and bool(macro_name)), -uses.get(name.name, 0), not is_near

    for name in sorted(properties, key=rank):
        described = f"**property {name.name}** = `{name.detail}`, {name.file.name}"
        yield Completion(name.name, ItemKind.PROPERTY, begin, _shorten(name.detail), described)
    for function, purpose in XACRO_FUNCTIONS.items():
        yield Completion(function, ItemKind.FUNCTION, begin, purpose)
    for function in sorted(FUNCTIONS, key=lambda name: (name not in _COMMON_FUNCTIONS, -uses.get(name, 0))):
        yield Completion(function, ItemKind.FUNCTION, begin, function_purpose(function))


def parameters_in_scope(cursor: Cursor) -> list[Parameter]:
    """Return the parameters of the macro around a cursor, without block parameters."""
    return [parameter for parameter in _parse_parameters(cursor) if not parameter.is_block]


def blocks_in_scope(cursor: Cursor) -> list[Parameter]:
    """Return the block parameters of the macro around a cursor."""
    return [parameter for parameter in _parse_parameters(cursor) if parameter.is_block]


def _parse_parameters(cursor: Cursor) -> tuple[Parameter, ...]:
    macro = cursor.macro
    params_values = (
        ()
        if macro is None
        else (attribute.value or "" for attribute in macro.attributes() if attribute.name == "params")
    )
    try:
        return tuple(parse_parameters(next(iter(params_values), "")))
    except Fault:  # The name is still being typed.
        return ()


def _count_words(text: str) -> Mapping[str, int]:
    """Return the number of occurrences of each word in the expressions of a text."""
    use_counts: dict[str, int] = {}
    for expression in _EXPRESSION.finditer(text):
        for word in _WORDS.findall(expression[1]):
            use_counts[word] = use_counts.get(word, 0) + 1
    return use_counts


def _key_completions(
    document: Document, item: re.Match[str], cursor: Cursor, names: Sequence[NameDefinition]
) -> Iterator[Completion]:
    """Yield completions of the keys of a mapping that a property loads from a YAML file."""
    value: Any = find_yaml_value(document, item[1], names)
    for key in _KEY.finditer(item[2]):
        value = value.get(key[1] or key[2]) if isinstance(value, Mapping) else None
    for key_name, inner in value.items() if isinstance(value, Mapping) else ():
        detail = ", ".join(map(str, inner)) if isinstance(inner, Mapping) else str(inner)
        yield Completion(str(key_name), ItemKind.PROPERTY, cursor.offset - len(item[3]), _shorten(detail))


def complete_substitution(document: Document, cursor: Cursor, names: Sequence[NameDefinition]) -> Iterator[Completion]:
    """Yield completions of the commands of ``$(...)``, or of their arguments.

    Args:
        document: the text.
        cursor: a cursor in ``$(...)``.
        names: the names that the files of the description define.
    """
    substitution = cursor.substitution
    if substitution is None:
        return
    command, argument = substitution
    typed = cursor.typed
    if " " not in typed[typed.rfind("$(") :].lstrip("$( "):
        for name, purpose in _COMMANDS.items():
            yield Completion(name, ItemKind.FUNCTION, cursor.offset - len(command), purpose)
        return
    begin = cursor.offset - len(argument)
    if command == "arg":
        for definition in definitions_of_kind(names, NameKind.ARGUMENT):
            described = f"**argument {definition.name}** = `{definition.detail}`, {definition.file.name}"
            yield Completion(definition.name, ItemKind.NAME, begin, _shorten(definition.detail), described)
    elif command == "find":
        yield from package_completions(document, begin)


def package_completions(document: Document, start: int) -> Iterator[Completion]:
    """Yield completions of packages: the file's own first, then by the number of mentions."""
    packages = document.finder.packages()
    folder = document.file.parent

    def rank(name: str) -> tuple[bool, int, str]:
        return not folder.is_relative_to(packages[name]), -document.text.count(name), name

    for name in sorted(packages, key=rank):
        yield Completion(name, ItemKind.PACKAGE, start, str(packages[name]))


def _shorten(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _MAX_VALUE_LENGTH else f"{line[: _MAX_VALUE_LENGTH - 3]}..."


def function_purpose(function: str) -> str:
    """Return the first docstring line of a function of expressions, or the value of a constant."""
    value = getattr(math, function, None) or getattr(builtins, function, None)
    return (getattr(value, "__doc__", None) or "").partition("\n")[0] if callable(value) else str(value)
