"""Evaluation of CMake's commands on texts and lists.

The commands are ``list``, ``string``, ``math`` and ``get_filename_component``.
"""

from __future__ import annotations

import ast
import operator
import posixpath
from collections.abc import Callable, Sequence

import regex

from linkwright.packages.readers.cmake_conditions import matched
from linkwright.packages.readers.cmake_syntax import is_open

UNKNOWN = "${}"
"""The value of a variable whose value is not known."""

_LONGEST_SEARCH = 0.2
_MOST_DIGITS = 10**15
_OPERATORS: dict[type[ast.operator], Callable[[int, int], int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: lambda left, right: int(left / right),
    ast.Mod: operator.mod,
}


class _NotKnownError(Exception):
    """Raised when the effect of a command cannot be evaluated without CMake."""


def items_of(text: str) -> list[str]:
    """Return the items of a CMake list, without empty items."""
    return [item for item in text.split(";") if item]


def list_command(what: str, words: Sequence[str], value_of: Callable[[str], str]) -> dict[str, str]:
    """Return the variable that a command ``list(WHAT ...)`` sets, with its value.

    Args:
        what: the operation, which is the first argument of the command.
        words: the other arguments.
        value_of: the function that returns the value of a variable.
    """
    if not words:
        return {}
    items = items_of(value_of(words[0]))
    asks = what in ("LENGTH", "GET", "JOIN", "FIND", "SUBLIST")
    target = words[-1] if asks else words[0]
    if any(map(is_open, (*items, *words[1:]))):
        return {target: UNKNOWN}
    try:
        if asks:
            return {target: _asked(what, items, words[1:-1])}
        return {target: ";".join(_changed(what, items, list(words[1:])))}
    except (_NotKnownError, ValueError, IndexError):
        return {target: UNKNOWN}


def _asked(what: str, items: list[str], words: Sequence[str]) -> str:
    if what == "LENGTH":
        return str(len(items))
    if what == "GET":
        return ";".join(items[int(word)] for word in words)
    if what == "JOIN":
        return words[0].join(items)
    if what == "FIND":
        return str(items.index(words[0]) if words[0] in items else -1)
    start, count = int(words[0]), int(words[1])
    return ";".join(items[start:] if count < 0 else items[start : start + count])


def _changed(what: str, items: list[str], words: list[str]) -> list[str]:
    if what in ("APPEND", "PREPEND"):
        return [*items, *words] if what == "APPEND" else [*words, *items]
    if what == "INSERT":
        at = int(words[0])
        return [*items[:at], *words[1:], *items[at:]]
    if what == "REMOVE_ITEM":
        return [item for item in items if item not in words]
    if what == "REMOVE_AT":
        gone = {int(word) % len(items) for word in words}
        return [item for at, item in enumerate(items) if at not in gone]
    if what == "REMOVE_DUPLICATES":
        return list(dict.fromkeys(items))
    if what == "REVERSE":
        return items[::-1]
    if what == "SORT" and not words:
        return sorted(items)
    if what == "FILTER" and len(words) == 3 and words[1] == "REGEX":
        return [item for item in items if bool(_found(words[2], item)) == (words[0] == "INCLUDE")]
    if what == "TRANSFORM" and words:
        return [_transform_item(item, words) for item in items]
    raise _NotKnownError


def _transform_item(item: str, words: Sequence[str]) -> str:
    what, *arguments = words
    if what in ("APPEND", "PREPEND") and len(arguments) == 1:
        return item + arguments[0] if what == "APPEND" else arguments[0] + item
    if what in ("TOLOWER", "TOUPPER", "STRIP") and not arguments:
        return _convert_case(what, item)
    if what == "REPLACE" and len(arguments) == 2:
        return _replaced(arguments[0], arguments[1], item)
    raise _NotKnownError


def string_command(words: Sequence[str], value_of: Callable[[str], str]) -> dict[str, str]:
    """Return the variables that a command ``string(...)`` sets, with their values.

    Args:
        words: the arguments of the command.
        value_of: the function that returns the value of a variable.
    """
    what, *arguments = words
    try:
        target, value = _string(what, arguments, value_of)
    except (_NotKnownError, ValueError, IndexError):
        return {word: UNKNOWN for word in arguments if word.isidentifier()}
    return {target: UNKNOWN if is_open(value) else value}


def _string(what: str, args: list[str], value_of: Callable[[str], str]) -> tuple[str, str]:
    if what == "REPLACE":
        return args[2], "".join(args[3:]).replace(args[0], args[1])
    if what == "REGEX" and args[0] == "REPLACE":
        return args[3], _replaced(args[1], args[2], "".join(args[4:]))
    if what == "REGEX" and args[0] in ("MATCH", "MATCHALL"):
        found = [text for text, _ in _found(args[1], "".join(args[3:]))]
        return args[2], ";".join(found if args[0] == "MATCHALL" else found[:1])
    if what in ("APPEND", "PREPEND"):
        old, new = value_of(args[0]), "".join(args[1:])
        return args[0], old + new if what == "APPEND" else new + old
    if what in ("CONCAT", "JOIN"):
        return (args[0], "".join(args[1:])) if what == "CONCAT" else (args[1], args[0].join(args[2:]))
    if what in ("TOLOWER", "TOUPPER", "STRIP"):
        return args[1], _convert_case(what, args[0])
    if what == "LENGTH":
        return args[1], str(len(args[0].encode()))
    if what == "SUBSTRING":
        start, count = int(args[1]), int(args[2])
        return args[3], args[0][start:] if count < 0 else args[0][start : start + count]
    if what == "FIND":
        return args[2], str(args[0].rfind(args[1]) if "REVERSE" in args[3:] else args[0].find(args[1]))
    raise _NotKnownError


def _convert_case(what: str, text: str) -> str:
    return text.strip() if what == "STRIP" else text.lower() if what == "TOLOWER" else text.upper()


def _found(pattern: str, text: str) -> list[tuple[str, list[str]]]:
    found = matched(pattern, text)
    if found is None:
        raise _NotKnownError
    return found


def _replaced(pattern: str, new: str, text: str) -> str:
    try:
        return regex.sub(pattern, regex.sub(r"\\(\d)", r"\\g<\1>", new), text, timeout=_LONGEST_SEARCH)
    except (regex.error, TimeoutError) as error:
        raise _NotKnownError from error


def evaluate_math(expression: str) -> str:
    """Return the value of ``math(EXPR ...)``, in decimal digits."""
    try:
        return str(_number(ast.parse(expression.strip().replace("/", "//"), mode="eval").body))
    except (SyntaxError, ValueError, ZeroDivisionError, RecursionError, MemoryError, _NotKnownError):
        return UNKNOWN


def _number(node: ast.expr) -> int:
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return node.value
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_number(node.operand)
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        value = _OPERATORS[type(node.op)](_number(node.left), _number(node.right))
        if abs(value) < _MOST_DIGITS:
            return value
    raise _NotKnownError


def filename_component(path: str, part: str) -> str:
    """Return the part of a path that ``get_filename_component`` extracts."""
    name = posixpath.basename(path)
    parts = {
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
    return parts.get(part, UNKNOWN)


def version_variables(words: Sequence[str]) -> dict[str, str]:
    """Return the version variables that ``project(...)`` sets.

    Their values are empty if there is no version.
    """
    at = words.index("VERSION", 1) + 1 if "VERSION" in words[1:] else len(words)
    version = words[at] if at < len(words) else ""
    numbers = [*version.split("."), *[""] * 4]
    parts = zip(("MAJOR", "MINOR", "PATCH", "TWEAK"), numbers, strict=False)
    found = {"VERSION": version, **{f"VERSION_{part}": number for part, number in parts}}
    return {f"{prefix}_{name}": value for prefix in ("PROJECT", words[0]) for name, value in found.items()}
