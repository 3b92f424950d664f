"""Evaluate the CMake commands that compute texts and lists.

The commands are ``list``, ``string``, ``math`` and ``get_filename_component``.
"""

from __future__ import annotations

import ast
import operator
import posixpath
from collections.abc import Callable, Sequence

import regex

from linkwright.loading.deferred import lazy_pattern
from linkwright.packages.readers.cmake_conditions import find_matches
from linkwright.packages.readers.cmake_syntax import is_open

UNKNOWN = "${}"
"""The value that represents an unknown value of a variable."""

_SEARCH_TIMEOUT_S = 0.2
_MAX_NUMBER = 10**15
_OPERATORS: dict[type[ast.operator], Callable[[int, int], int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: lambda left, right: int(left / right),
    ast.Mod: operator.mod,
}


_MAJOR_VERSION = lazy_pattern(r".*?[^\d.](\d+)_VERSION_MAJOR")
"""The variable with the version of a package of Gazebo, whose name ends with it."""


class _NotKnownError(Exception):
    """Raised when the effect of a command cannot be evaluated without CMake."""


def split_items(text: str) -> list[str]:
    """Return the items of a CMake list, without empty items."""
    return [item for item in text.split(";") if item]


def find_major_version(variable: str) -> str | None:
    """Return the value of a variable such as ``gz-sim8_VERSION_MAJOR``, which the name tells; None for any other."""
    match = _MAJOR_VERSION.fullmatch(variable)
    return None if match is None else match[1]


def evaluate_list_command(operation: str, words: Sequence[str], value_of: Callable[[str], str]) -> dict[str, str]:
    """Return the variable that a command ``list(OPERATION ...)`` sets, with its value.

    Args:
        operation: the first argument of the command.
        words: the other arguments.
        value_of: the function that returns the value of a variable.
    """
    if not words:
        return {}
    items = split_items(value_of(words[0]))
    is_query = operation in ("LENGTH", "GET", "JOIN", "FIND", "SUBLIST")
    target = words[-1] if is_query else words[0]
    if any(map(is_open, (*items, *words[1:]))):
        return {target: UNKNOWN}
    try:
        if is_query:
            return {target: _query_list(operation, items, words[1:-1])}
        return {target: ";".join(_change_list(operation, items, list(words[1:])))}
    except (_NotKnownError, ValueError, IndexError):
        return {target: UNKNOWN}


def _query_list(operation: str, items: list[str], words: Sequence[str]) -> str:
    if operation == "LENGTH":
        return str(len(items))
    if operation == "GET":
        return ";".join(items[int(word)] for word in words)
    if operation == "JOIN":
        return words[0].join(items)
    if operation == "FIND":
        return str(items.index(words[0]) if words[0] in items else -1)
    start, count = int(words[0]), int(words[1])
    return ";".join(items[start:] if count < 0 else items[start : start + count])


def _change_list(operation: str, items: list[str], words: list[str]) -> list[str]:
    if operation in ("APPEND", "PREPEND"):
        return [*items, *words] if operation == "APPEND" else [*words, *items]
    if operation == "INSERT":
        index = int(words[0])
        return [*items[:index], *words[1:], *items[index:]]
    if operation == "REMOVE_ITEM":
        return [item for item in items if item not in words]
    if operation == "REMOVE_AT":
        removed_indices = {int(word) % len(items) for word in words}
        return [item for item_index, item in enumerate(items) if item_index not in removed_indices]
    if operation == "REMOVE_DUPLICATES":
        return list(dict.fromkeys(items))
    if operation == "REVERSE":
        return items[::-1]
    if operation == "SORT" and not words:
        return sorted(items)
    if operation == "FILTER" and len(words) == 3 and words[1] == "REGEX":
        return [item for item in items if bool(_find_matches(words[2], item)) == (words[0] == "INCLUDE")]
    if operation == "TRANSFORM" and words:
        return [_transform_item(item, words) for item in items]
    raise _NotKnownError


def _transform_item(item: str, words: Sequence[str]) -> str:
    action, *arguments = words
    if action in ("APPEND", "PREPEND") and len(arguments) == 1:
        return item + arguments[0] if action == "APPEND" else arguments[0] + item
    if action in ("TOLOWER", "TOUPPER", "STRIP") and not arguments:
        return _convert_case(action, item)
    if action == "REPLACE" and len(arguments) == 2:
        return _replace_regex(arguments[0], arguments[1], item)
    raise _NotKnownError


def evaluate_string_command(words: Sequence[str], value_of: Callable[[str], str]) -> dict[str, str]:
    """Return the variables that a command ``string(...)`` sets, with their values.

    Args:
        words: the arguments of the command.
        value_of: the function that returns the value of a variable.
    """
    operation, *arguments = words
    try:
        target, value = _evaluate_string(operation, arguments, value_of)
    except (_NotKnownError, ValueError, IndexError):
        return {word: UNKNOWN for word in arguments if word.isidentifier()}
    return {target: UNKNOWN if is_open(value) else value}


def _evaluate_string(operation: str, args: list[str], value_of: Callable[[str], str]) -> tuple[str, str]:
    if operation == "REPLACE":
        return args[2], "".join(args[3:]).replace(args[0], args[1])
    if operation == "REGEX" and args[0] == "REPLACE":
        return args[3], _replace_regex(args[1], args[2], "".join(args[4:]))
    if operation == "REGEX" and args[0] in ("MATCH", "MATCHALL"):
        matches = [text for text, _ in _find_matches(args[1], "".join(args[3:]))]
        return args[2], ";".join(matches if args[0] == "MATCHALL" else matches[:1])
    if operation in ("APPEND", "PREPEND"):
        old, new = value_of(args[0]), "".join(args[1:])
        return args[0], old + new if operation == "APPEND" else new + old
    if operation in ("CONCAT", "JOIN"):
        return (args[0], "".join(args[1:])) if operation == "CONCAT" else (args[1], args[0].join(args[2:]))
    if operation in ("TOLOWER", "TOUPPER", "STRIP"):
        return args[1], _convert_case(operation, args[0])
    if operation == "LENGTH":
        return args[1], str(len(args[0].encode()))
    if operation == "SUBSTRING":
        start, count = int(args[1]), int(args[2])
        return args[3], args[0][start:] if count < 0 else args[0][start : start + count]
    if operation == "FIND":
        return args[2], str(args[0].rfind(args[1]) if "REVERSE" in args[3:] else args[0].find(args[1]))
    raise _NotKnownError


def _convert_case(conversion: str, text: str) -> str:
    return text.strip() if conversion == "STRIP" else text.lower() if conversion == "TOLOWER" else text.upper()


def _find_matches(pattern: str, text: str) -> list[tuple[str, list[str]]]:
    matches = find_matches(pattern, text)
    if matches is None:
        raise _NotKnownError
    return matches


def _replace_regex(pattern: str, replacement: str, text: str) -> str:
    try:
        return regex.sub(pattern, regex.sub(r"\\(\d)", r"\\g<\1>", replacement), text, timeout=_SEARCH_TIMEOUT_S)
    except (regex.error, TimeoutError) as error:
        raise _NotKnownError from error


def evaluate_math(expression: str) -> str:
    """Return the value of ``math(EXPR ...)``, in decimal digits."""
    try:
        return str(_evaluate_number(ast.parse(expression.strip().replace("/", "//"), mode="eval").body))
    except (SyntaxError, ValueError, ZeroDivisionError, RecursionError, MemoryError, _NotKnownError):
        return UNKNOWN


def _evaluate_number(node: ast.expr) -> int:
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return node.value
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_evaluate_number(node.operand)
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        value = _OPERATORS[type(node.op)](_evaluate_number(node.left), _evaluate_number(node.right))
        if abs(value) < _MAX_NUMBER:
            return value
    raise _NotKnownError


def extract_filename_component(path: str, component: str) -> str:
    """Return the part of a path that ``get_filename_component`` extracts."""
    name = posixpath.basename(path)
    components = {
        "NAME": name,
        "NAME_WE": name.partition(".")[0],
        "NAME_WLE": posixpath.splitext(name)[0],
        "EXT": "".join(name.partition(".")[1:]),
        "LAST_EXT": posixpath.splitext(name)[1],
        "DIRECTORY": posixpath.dirname(path),
        "PATH": posixpath.dirname(path),
        "ABSOLUTE": path,
        "REALPATH": path,
    }
    return components.get(component, UNKNOWN)


def compute_version_variables(words: Sequence[str]) -> dict[str, str]:
    """Return the version variables that ``project(...)`` sets.

    Their values are empty if there is no version.
    """
    index = words.index("VERSION", 1) + 1 if "VERSION" in words[1:] else len(words)
    version = words[index] if index < len(words) else ""
    numbers = [*version.split("."), *[""] * 4]
    numbered_parts = zip(("MAJOR", "MINOR", "PATCH", "TWEAK"), numbers, strict=False)
    variables = {"VERSION": version, **{f"VERSION_{part}": number for part, number in numbered_parts}}
    return {f"{prefix}_{name}": value for prefix in ("PROJECT", words[0]) for name, value in variables.items()}
