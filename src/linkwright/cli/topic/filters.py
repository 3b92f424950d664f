"""The Python expression of ``--filter``, which selects messages ``m``."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, foreign, phrase

_SOURCE_NAME = "<filter>"
_FORBIDDEN = (ast.Lambda, ast.Await, ast.Yield, ast.YieldFrom, ast.NamedExpr)
_FUNCTIONS: dict[str, Any] = {
    function.__name__: function
    for function in (abs, all, any, bool, bytes, float, int, len, list, max, min, round, set, sorted, str, sum, tuple)
}
_NAMES: dict[str, Any] = {**_FUNCTIONS, "math": math, "True": True, "False": False, "None": None}


def compile_filter(text: str) -> Callable[[Any], bool]:
    """Compile an expression such as ``m.data > 3`` to a predicate on messages.

    The expression can use the message ``m``, the module ``math`` and a few functions, but no names with a leading
    underscore.

    Raises:
        LinkwrightError: CLI407, the expression is not valid. The predicate raises the same error if the expression
            cannot be evaluated for a message.
    """
    source = SourceText(_SOURCE_NAME, text)

    def create_error(message: Phrase, column: int | None = None, hint: Phrase | None = None) -> LinkwrightError:
        span = source.span(0, len(text)) if column is None else source.span(column)
        return LinkwrightError(Diagnostic("CLI407", message, span, hint=hint, source=source))

    try:
        tree = ast.parse(text.strip(), _SOURCE_NAME, "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None)
        raise create_error(
            phrase("the filter is not a Python expression: {error}", error=foreign(getattr(error, "msg", error))),
            column and column - 1,
        ) from None
    for node in ast.walk(tree):
        if isinstance(node, _FORBIDDEN):
            raise create_error(
                phrase("a filter cannot contain {name}", name=type(node).__name__.lower()), node.col_offset
            )
        if isinstance(node, ast.Attribute) and node.attr.startswith("_"):
            raise create_error(phrase("a filter cannot use '{attr}'", attr=node.attr), node.col_offset)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id not in (*_NAMES, "m"):
            bound_names = {
                node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
            }
            if node.id not in bound_names:
                raise create_error(
                    phrase("a filter cannot use the name '{id}'", id=node.id),
                    node.col_offset,
                    phrase("the message is 'm', as in 'm.data > 3'"),
                )
    code = compile(tree, _SOURCE_NAME, "eval")

    def matches(message: Any) -> bool:
        try:
            # `eval` is safe here, because the syntax tree was checked above: it contains no private names and only the
            # listed functions.
            return bool(eval(code, {"__builtins__": {}, **_NAMES, "m": message}))  # noqa: S307
        except Exception as error:  # noqa: BLE001 - the user's expression may raise any exception
            raise create_error(
                phrase("the filter cannot be evaluated for a message: {error}", error=foreign(error))
            ) from None

    return matches
