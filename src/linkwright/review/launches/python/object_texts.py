"""Report texts of Python launch files that contain a substitution as an object, and commands without a blank."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkwright.diagnostics import Span, phrase
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.expressions import unparse_on_one_line
from linkwright.review.launches.python.conditions import ArgumentReader, try_parse_version, walk_functions
from linkwright.review.texts.excerpts import shorten

_MAX_CHARACTERS = 80
_MESSAGE_FUNCTIONS = frozenset({"print", "LogInfo", "debug", "info", "warning", "warn", "error"})
"""The functions that only show a text."""


def report_object_texts(pair: FilePair) -> None:
    """Report the texts with objects, and the commands without a blank, that only the new version has."""
    old, new = try_parse_version(pair, is_old=True), try_parse_version(pair)
    known = {source for source, _, _ in _find_object_texts(old)}
    for source, name, span in _find_object_texts(new):
        if source not in known:
            text = phrase("`{text}` contains the object {name}, instead of its value", text=source, name=name)
            pair.add(text, pair.location(span), phrase("the text does not depend on the value"))
    known = {source for source, _, _ in _find_joined_commands(old)}
    for source, name, span in _find_joined_commands(new):
        if source not in known:
            text = phrase("`{text}` has no blank after the program '{name}'", text=source, name=name)
            pair.add(text, pair.location(span), phrase("the launch file fails, because there is no such program"))


def _find_object_texts(python: PythonFile | None) -> Iterator[tuple[str, str, Span]]:
    """Yield the texts that contain the description of a substitution, each with the substitution and the place."""
    messages = set() if python is None else _find_messages(python.tree)
    for function, node in walk_functions(python.tree, None) if python is not None else ():
        if python is None or not isinstance(node, ast.JoinedStr) or id(node) in messages:
            continue
        reader = ArgumentReader(python, function)
        values = [part.value for part in node.values if isinstance(part, ast.FormattedValue)]
        found = next((call for value in values if (call := reader.find_substitution(value)) is not None), None)
        if found is not None:
            name = shorten(unparse_on_one_line(found), _MAX_CHARACTERS)
            yield shorten(unparse_on_one_line(node), _MAX_CHARACTERS), name, python.span(node)


def _find_messages(tree: ast.AST) -> set[int]:
    """Return the identities of the expressions that are only shown, or that are the text of an error."""
    shown: set[int] = set()
    for node in ast.walk(tree):
        is_message = isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _MESSAGE_FUNCTIONS
        if is_message or isinstance(node, (ast.Raise, ast.Assert)):
            shown.update(id(part) for part in ast.walk(node))
    return shown


def _find_joined_commands(python: PythonFile | None) -> Iterator[tuple[str, str, Span]]:
    """Yield the commands whose program and first argument are one word, each with the program and the place."""
    for function, node in walk_functions(python.tree, None) if python is not None else ():
        is_command = isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] == "Command"
        if python is None or not is_command or not isinstance(node, ast.Call) or not node.args:
            continue
        words = python.resolved(node.args[0])
        if not isinstance(words, (ast.List, ast.Tuple)) or len(words.elts) < 2:
            continue
        program = _find_program(python, words.elts[0])
        second = words.elts[1]
        begins_word = ArgumentReader(python, function).find_substitution(second) is not None
        start = _find_start(python.resolved(second))
        if program is not None and (begins_word or (start is not None and start[:1].strip())):
            yield shorten(unparse_on_one_line(node), _MAX_CHARACTERS), program, python.span(node)


def _find_program(python: PythonFile, node: ast.expr) -> str | None:
    """Return the program of a command if the word has no blank, or None if it is unknown."""
    value = python.resolved(node)
    if isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] == "FindExecutable":
        arguments = [*value.args, *(keyword.value for keyword in value.keywords)]
        value = python.resolved(arguments[0]) if arguments else value
    is_text = isinstance(value, ast.Constant) and isinstance(value.value, str)
    text = str(value.value) if is_text and isinstance(value, ast.Constant) else ""
    return text if text and text == text.strip() and " " not in text and "/" not in text else None


def _find_start(node: ast.expr) -> str | None:
    """Return the beginning of a literal text, or None for other expressions."""
    first = node.values[0] if isinstance(node, ast.JoinedStr) and node.values else node
    is_text = isinstance(first, ast.Constant) and isinstance(first.value, str)
    return str(first.value) if is_text and isinstance(first, ast.Constant) else None
