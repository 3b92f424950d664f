"""Find the environment variables that launch files read, and those that Python code sets."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence

from linkwright.diagnostics import Span
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import ENVIRONMENT_KIND, READING, Entry
from linkwright.review.launches.python.expression_texts import ExpressionTexts
from linkwright.review.launches.python.substitution_texts import ENVIRONMENT_FUNCTION

_ENVIRON = ("os.environ", "environ")
_SUBSTITUTION = re.compile(r"\$\((?P<kind>env|optenv) (?P<name>\w+)(?P<default> [^()]*)?\)")
_NAME = re.compile(r"\w+")
_ALWAYS_SET = re.compile(
    r"ROS_(?:DISTRO|VERSION|PYTHON_VERSION)|(?:AMENT_|CMAKE_)PREFIX_PATH|LD_LIBRARY_PATH|PYTHONPATH|PATH|HOME"
)
"""The variables that the setup files of ROS or the system set."""
_DEFAULT = "default"


def find_python_readings(python: PythonFile) -> list[Entry]:
    """Return an entry for each environment variable that a launch file in Python reads."""
    texts = ExpressionTexts(python)
    guarded = set(_find_guarded_readings(python.tree, frozenset()))
    readings = (
        (texts.text(name), has_default or id(node) in guarded, python.span(node))
        for node in ast.walk(python.tree)
        if isinstance(node, ast.expr)
        for name, has_default in _find_read_names(node)
    )
    return _make_entries(readings)


def find_set_variables(python: PythonFile, texts: ExpressionTexts) -> dict[int, Entry]:
    """Return an entry for each variable that a statement sets in any case, by the identity of the statement.

    Args:
        python: the parsed launch file.
        texts: the texts of its expressions.
    """
    bodies = [python.tree.body, *(node.body for node in ast.walk(python.tree) if isinstance(node, ast.FunctionDef))]
    found: dict[int, Entry] = {}
    for statement in (statement for body in bodies for statement in body):
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
            target, key = statement.targets[0], "value"
        elif isinstance(statement, ast.AugAssign) and isinstance(statement.op, ast.Add):
            target, key = statement.target, "appended value"
        else:
            continue
        if isinstance(target, ast.Subscript) and ast.unparse(target.value) in _ENVIRON:
            settings = {key: texts.format_joined(statement.value)}
            found[id(statement)] = Entry(ENVIRONMENT_KIND, texts.text(target.slice), settings, python.span(statement))
    return found


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
        if ENVIRONMENT_FUNCTION.fullmatch(name):
            yield node.args[0], True
        elif name.rpartition(".")[2] == "EnvironmentVariable":
            yield node.args[0], len(node.args) + len(node.keywords) > 1


def _find_guarded_readings(node: ast.AST, names: frozenset[str]) -> Iterator[int]:
    """Yield the identities of expressions that read a variable only if it is set, or whose error is handled.

    Args:
        node: the syntax tree.
        names: the expressions of the names of variables that are set.
    """
    if isinstance(node, ast.Subscript) and ast.unparse(node.value) in _ENVIRON and ast.unparse(node.slice) in names:
        yield id(node)
    elif isinstance(node, ast.BoolOp):
        for value in node.values:
            yield from _find_guarded_readings(value, names)
            names |= _find_set_names(value, is_true=isinstance(node.op, ast.And))
        return
    elif isinstance(node, (ast.If, ast.IfExp, ast.While)):
        yield from _find_guarded_readings(node.test, names)
        for branch, is_true in ((node.body, True), (node.orelse, False)):
            inner = names | _find_set_names(node.test, is_true=is_true)
            statements: Sequence[ast.AST] = branch if isinstance(branch, list) else [branch]
            for statement in statements:
                yield from _find_guarded_readings(statement, inner)
        return
    elif isinstance(node, ast.Try) and any(map(_handles_missing_keys, node.handlers)):
        yield from (id(child) for statement in node.body for child in ast.walk(statement))
    for child in ast.iter_child_nodes(node):
        yield from _find_guarded_readings(child, names)


def _find_set_names(test: ast.expr, *, is_true: bool) -> frozenset[str]:
    """Return the expressions of the names of variables that are set if a test is true, or false."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return _find_set_names(test.operand, is_true=not is_true)
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And if is_true else ast.Or):
        return frozenset().union(*(_find_set_names(value, is_true=is_true) for value in test.values))
    if isinstance(test, ast.Compare) and len(test.ops) == 1:
        operator = ast.In if is_true else ast.NotIn
        is_membership = isinstance(test.ops[0], operator) and ast.unparse(test.comparators[0]) in _ENVIRON
        return frozenset({ast.unparse(test.left)}) if is_membership else frozenset()
    if is_true and isinstance(test, ast.Call) and test.args and ENVIRONMENT_FUNCTION.fullmatch(called_name(test)):
        return frozenset({ast.unparse(test.args[0])})
    return frozenset()


def _handles_missing_keys(handler: ast.ExceptHandler) -> bool:
    return handler.type is None or any(
        name in ast.unparse(handler.type) for name in ("KeyError", "LookupError", "Exception")
    )


def _make_entries(readings: Iterable[tuple[str, bool, Span]]) -> list[Entry]:
    """Return an entry for each variable.

    An entry has a default only if every expression that reads the variable has one.
    """
    entries: dict[str, Entry] = {}
    for name, has_default, span in readings:
        has_default = has_default or _ALWAYS_SET.fullmatch(name) is not None
        if _NAME.fullmatch(name) and (name not in entries or not has_default):
            entries[name] = Entry(READING, name, {_DEFAULT: "given"} if has_default else {}, span)
    return list(entries.values())
