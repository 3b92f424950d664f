"""Find the environment variables that launch files read."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Span
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import READING, Entry
from linkwright.review.launches.text import ExpressionTexts

_READING_FUNCTIONS = re.compile(r"(os\.)?(environ\.get|getenv)")
_ENVIRON = ("os.environ", "environ")
_SUBSTITUTION = re.compile(r"\$\((?P<kind>env|optenv) (?P<name>\w+)(?P<default> [^()]*)?\)")
_NAME = re.compile(r"\w+")
_DEFAULT = "default"


def find_python_readings(python: PythonFile) -> list[Entry]:
    """Return an entry for each environment variable that a launch file in Python reads."""
    texts = ExpressionTexts(python)
    readings = (
        (texts.text(name), has_default, python.span(node))
        for node in ast.walk(python.tree)
        if isinstance(node, ast.expr)
        for name, has_default in _find_read_names(node)
    )
    return _make_entries(readings)


def find_markup_readings(values: Iterable[tuple[str, Span]]) -> list[Entry]:
    """Return an entry for each environment variable that XML or YAML values read."""
    readings = (
        (match["name"], match["kind"] == "optenv" or match["default"] is not None, span)
        for value, span in values
        for match in _SUBSTITUTION.finditer(value)
    )
    return _make_entries(readings)


def _find_read_names(node: ast.expr) -> Iterator[tuple[ast.expr, bool]]:
    """Yield the names of the variables that an expression reads.

    Each name comes with True if the variable may be missing.
    """
    if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Load) and ast.unparse(node.value) in _ENVIRON:
        yield node.slice, False
    elif isinstance(node, ast.Call) and node.args:
        name = called_name(node)
        if _READING_FUNCTIONS.fullmatch(name):
            yield node.args[0], True
        elif name.rpartition(".")[2] == "EnvironmentVariable":
            yield node.args[0], len(node.args) + len(node.keywords) > 1


def _make_entries(readings: Iterable[tuple[str, bool, Span]]) -> list[Entry]:
    """Return an entry for each variable.

    An entry has a default only if every expression that reads the variable has one.
    """
    entries: dict[str, Entry] = {}
    for name, has_default, span in readings:
        if _NAME.fullmatch(name) and (name not in entries or not has_default):
            entries[name] = Entry(READING, name, {_DEFAULT: "given"} if has_default else {}, span)
    return list(entries.values())
