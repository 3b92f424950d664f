"""Find code of Python sources that newly comes after a statement which always ends the program or the function."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.texts.excerpts import shorten_middle

_EXIT_FUNCTIONS = frozenset({"exit", "quit", "sys.exit", "os._exit"})
_DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Pass)
_MAX_CHARACTERS = 80


def find_unreached_code(old: PythonFile, new: PythonFile) -> Iterator[tuple[Phrase, Span]]:
    """Yield the sentences about statements that both versions have, and that only the old one can reach.

    Args:
        old: the old source.
        new: the new source.
    """
    before = {name: _split_at_exit(body) for name, body in _list_scopes(old.tree, "")}
    for name, body in _list_scopes(new.tree, ""):
        (reached, exit_statement, unreached), old_parts = _split_at_exit(body), before.get(name)
        if exit_statement is None or not unreached or old_parts is None:
            continue
        left = {ast.dump(statement) for statement in old_parts[0]} - {ast.dump(statement) for statement in reached}
        lost = [statement for statement in unreached if ast.dump(statement) in left]
        if lost:
            text = phrase(
                "`{statement}` is never reached, because `{exit}` comes before it",
                statement=_format(lost[0]),
                exit=_format(exit_statement),
            )
            yield (phrase("in '{name}': {text}", name=f"{name}()", text=text) if name else text), new.span(lost[0])


def _list_scopes(node: ast.AST, name: str) -> Iterator[tuple[str, Sequence[ast.stmt]]]:
    """Yield the names of the module, which is empty, and of all functions, each with the statements of its body."""
    if isinstance(node, (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef)):
        yield name, node.body
    for child in getattr(node, "body", ()):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield from _list_scopes(child, f"{name}.{child.name}".lstrip("."))


def _split_at_exit(body: Sequence[ast.stmt]) -> tuple[Sequence[ast.stmt], ast.stmt | None, Sequence[ast.stmt]]:
    """Return the statements before the first one that always ends the body, this one, and those after it.

    Definitions and imports are left out, because functions may be called before.
    """
    statements = [statement for statement in body if not isinstance(statement, _DEFINITIONS)]
    index = next((index for index, statement in enumerate(statements) if _is_exit(statement)), None)
    if index is None:
        return statements, None, ()
    return statements[:index], statements[index], statements[index + 1 :]


def _is_exit(statement: ast.stmt) -> bool:
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
        return called_name(statement.value) in _EXIT_FUNCTIONS
    return isinstance(statement, (ast.Return, ast.Raise))


def _format(statement: ast.stmt) -> str:
    """Return the first line of a statement."""
    return shorten_middle(ast.unparse(statement).partition("\n")[0], _MAX_CHARACTERS)
