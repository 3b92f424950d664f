"""Read the keyword arguments that a call of a Python launch file gets from a dictionary of its function."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from linkwright.review.launches.python.expression_texts import ExpressionTexts


def find_keyword_values(call: ast.Call, texts: ExpressionTexts) -> Mapping[str, ast.expr]:
    """Return the values of the dictionaries that a call unpacks, such as ``Node(**settings)``, by keyword.

    They include the values that statements add before the call, if their conditions are not certainly false.
    The result has no values of a dictionary that is not a literal of the function.

    Args:
        call: the call.
        texts: the texts of the expressions of the function around the call.
    """
    values: dict[str, ast.expr] = {}
    for keyword in call.keywords:
        dictionary = None if keyword.arg is not None else texts.resolve(keyword.value)
        if dictionary is None or dictionary.texts is not texts or not isinstance(dictionary.node, ast.Dict):
            continue
        values |= {
            key.value: value
            for key, value in zip(dictionary.node.keys, dictionary.node.values, strict=True)
            if isinstance(key, ast.Constant) and isinstance(key.value, str)
        }
        if isinstance(keyword.value, ast.Name):
            lines = range(dictionary.node.lineno + 1, call.lineno)
            values |= dict(_find_added_values(_find_body(texts, call.lineno), keyword.value.id, lines, texts))
    return values


def _find_body(texts: ExpressionTexts, line: int) -> Sequence[ast.stmt]:
    """Return the statements of the innermost function around a line, or those of the file."""
    functions = [
        node
        for node in ast.walk(texts.python.tree)
        if isinstance(node, ast.FunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    return max(functions, key=lambda node: node.lineno).body if functions else texts.python.tree.body


def _find_added_values(
    body: Sequence[ast.stmt], name: str, lines: range, texts: ExpressionTexts
) -> Iterator[tuple[str, ast.expr]]:
    """Yield the keys and values that statements in a range of lines add to a dictionary."""
    for statement in body:
        if isinstance(statement, ast.If):
            holds = texts.evaluate_parameter(statement.test)
            if holds is not False:
                yield from _find_added_values(statement.body, name, lines, texts)
            if holds is not True:
                yield from _find_added_values(statement.orelse, name, lines, texts)
        if not isinstance(statement, ast.Assign) or statement.lineno not in lines:
            continue
        for target in statement.targets:
            if isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name) and target.value.id == name:
                key = target.slice
                if isinstance(key, ast.Constant) and isinstance(key.value, str):
                    yield key.value, statement.value
