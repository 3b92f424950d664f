"""Find the variables and calls of Python sources that get a parameter with another default instead of a literal."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.sources.parameter_defaults import find_declarations, get_name_argument

_READERS = ("get_param", "get_parameter", "get_parameter_or", "declare_parameter")
_CONVERSIONS = ("bool", "float", "int", "str")
_MAX_DEPTH = 6


def find_replaced_literals(old: PythonFile, new: PythonFile) -> Iterator[tuple[Phrase, Span]]:
    """Yield the variables and calls that had a literal and get a parameter now, whose default has another value.

    Args:
        old: the old source.
        new: the new source.
    """
    literals = {key: values[0] for key, values in _read_assignments(old).items() if len(values) == 1}
    for key, values in _read_assignments(new).items():
        literal = literals.get(key)
        call = _find_read(values[0]) if len(values) == 1 else None
        if literal is None or call is None or not _is_literal(literal):
            continue
        name, default = new.text(get_name_argument(call)), _find_default(new, call)
        if name is not None and default is not None and ast.literal_eval(literal) != ast.literal_eval(default):
            yield (
                phrase(
                    "{variable} gets the parameter '{name}' now: by default, {old} -> {new}",
                    variable=key[1],
                    name=name,
                    old=ast.unparse(literal),
                    new=ast.unparse(default),
                ),
                new.span(values[0]),
            )
    yield from _find_replaced_arguments(old, new)


def _find_replaced_arguments(old: PythonFile, new: PythonFile) -> Iterator[tuple[Phrase, Span]]:
    """Yield the literal arguments of calls that a parameter replaces, such as ``sleep(get_param("/delay"))``.

    The function must have one call of that name in each version, whose other arguments are equal.
    """
    old_calls, new_calls = _read_calls(old), _read_calls(new)
    for key, calls in new_calls.items():
        others = old_calls.get(key, [])
        if len(calls) != 1 or len(others) != 1 or len(calls[0].args) != len(others[0].args):
            continue
        pairs = [
            (before, after)
            for before, after in zip(others[0].args, calls[0].args, strict=True)
            if ast.dump(before) != ast.dump(after)
        ]
        read = _find_read(pairs[0][1]) if len(pairs) == 1 else None
        name = None if read is None else new.text(get_name_argument(read))
        if read is None or name is None or not _is_literal(pairs[0][0]):
            continue
        default = _find_default(new, read)
        if default is None or ast.literal_eval(default) != ast.literal_eval(pairs[0][0]):
            values = {"parameter": name, "old": ast.unparse(pairs[0][0]), "name": key[0].lstrip(".")}
            text = phrase("parameter '{parameter}' replaces {old} in '{name}()'", **values)
            if default is not None:
                text = phrase(
                    "parameter '{parameter}' replaces {old} in '{name}()': {default} by default",
                    **values,
                    default=ast.unparse(default),
                )
            yield text, new.span(pairs[0][1])


def _read_calls(python: PythonFile) -> dict[tuple[str, str], list[ast.Call]]:
    """Return the calls in each function, by its name and that of the called function."""
    calls: dict[tuple[str, str], list[ast.Call]] = {}
    for scope, node in _walk(python.tree.body):
        if isinstance(node, ast.Call) and scope:
            calls.setdefault((scope, called_name(node)), []).append(node)
    return calls


def _read_assignments(python: PythonFile) -> dict[tuple[str, str], list[ast.expr]]:
    """Return the expressions that each function assigns to each variable and attribute."""
    assignments: dict[tuple[str, str], list[ast.expr]] = {}
    for scope, node in _walk(python.tree.body):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                assignments.setdefault((scope, ast.unparse(target)), []).append(node.value)
        elif isinstance(node, (ast.AugAssign, ast.AnnAssign)) and node.value is not None:
            assignments.setdefault((scope, ast.unparse(node.target)), []).append(node.value)
    return assignments


def _walk(body: Iterable[ast.stmt], scope: str = "") -> Iterator[tuple[str, ast.AST]]:
    """Yield all nodes of statements, each with the names of the functions and classes around it."""
    for statement in body:
        if isinstance(statement, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield from _walk(statement.body, f"{scope}.{statement.name}")
        else:
            yield from ((scope, node) for node in ast.walk(statement))


def _find_read(node: ast.expr) -> ast.Call | None:
    """Return the call that reads the parameter of an expression such as ``float(node.get_parameter("x").value)``."""
    for _ in range(_MAX_DEPTH):
        if isinstance(node, ast.Attribute):
            node = node.value
        elif not isinstance(node, ast.Call):
            return None
        elif called_name(node).rpartition(".")[2] in _READERS:
            return node
        elif called_name(node) in _CONVERSIONS and len(node.args) == 1:
            node = node.args[0]
        elif isinstance(node.func, ast.Attribute) and node.func.attr == "get_parameter_value":
            node = node.func.value
        else:
            return None
    return None


def _find_default(python: PythonFile, call: ast.Call) -> ast.expr | None:
    """Return the literal default in a call that reads or declares a parameter, or in the only declaration of it."""
    given = call.args[1] if len(call.args) > 1 else argument_of(call, "default") or argument_of(call, "value")
    if given is not None:
        default = python.resolved(given)
        return default if _is_literal(default) else None
    declarations = find_declarations(python, call, python.text(get_name_argument(call)))
    has_own = len(declarations) == 1 and len(declarations[0].args) + len(declarations[0].keywords) > 1
    return _find_default(python, declarations[0]) if has_own else None


def _is_literal(node: ast.expr) -> bool:
    try:
        return ast.literal_eval(node) is not None
    except (ValueError, TypeError, SyntaxError):
        return False
