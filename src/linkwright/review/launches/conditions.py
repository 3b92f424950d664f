"""Evaluate the conditions of launch actions."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable

from linkwright.packages.readers.python_values import parse_python_expression
from linkwright.review.texts.list_changes import EMPTY

_SEPARATOR = re.compile(r" and (?=(?:if|unless|after) )")
_EVAL_SUBSTITUTION = re.compile(r"\$\(eval (.*)\)", re.DOTALL)
_COMPARISON = re.compile(r"(?P<left>\S*) (?P<operator>==|!=) (?P<right>\S*)")
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
_TEXT_METHODS: dict[str, Callable[[str], str]] = {"lower": str.lower, "strip": str.strip, "upper": str.upper}
_ARGUMENT_TERM = re.compile(r"(?P<word>if|unless) \$\((?:var|arg) (?P<name>\w+)\)")
_MAX_CHARACTERS = 500
"""The maximum length of an evaluated condition."""


def evaluate_condition(condition: str) -> bool | None:
    """Return whether a condition holds, or None if that is unknown.

    Args:
        condition: conditions such as ``if true and unless $(eval 'a' == 'b')``, with values in place of variables.
            Empty if there is none.
    """
    results = [_evaluate_part(part) for part in split_condition(condition)]
    if False in results:
        return False
    return None if None in results else True


def split_condition(condition: str) -> list[str]:
    """Return the terms of a condition, all of which must hold."""
    return [part for part in _SEPARATOR.split(condition) if part]


def _evaluate_part(part: str) -> bool | None:
    keyword, _, text = part.partition(" ")
    if keyword == "after":
        return True  # the delay of a timer
    value = _evaluate_text(text)
    return value if value is None or keyword == "if" else not value


def _evaluate_text(text: str) -> bool | None:
    evaluation = _EVAL_SUBSTITUTION.fullmatch(text.strip())
    text = text if evaluation is None else _strip_quotes(evaluation[1].strip())
    if "$(" in text or "`" in text or len(text) > _MAX_CHARACTERS:
        return None
    if evaluation is None:
        comparison = _COMPARISON.fullmatch(text)
        if comparison is not None:
            left, right = (comparison[side].replace(EMPTY, "") for side in ("left", "right"))
            return (left == right) == (comparison["operator"] == "==")
        return _BOOLEANS.get(text.strip().lower())
    try:
        return evaluate_test(parse_python_expression(text))
    except (SyntaxError, ValueError, RecursionError):
        return None


def evaluate_test(node: ast.expr) -> bool | None:
    """Return whether a test of constants holds, or None if that is unknown."""
    try:
        return _to_bool(_evaluate_expression(node))
    except (ValueError, RecursionError):
        return None


def _strip_quotes(text: str) -> str:
    """Return an expression without the quotes that an XML launch file needs around it."""
    for quote in "\"'":
        if len(text) > 1 and text[0] == text[-1] == quote and quote not in text[1:-1]:
            return text[1:-1]
    return text


def find_reversed_argument(old: str, new: str) -> str | None:
    """Return the argument that a condition tests the other way round, if this is the only difference; else None."""
    old_terms, new_terms = (set(_SEPARATOR.split(condition)) for condition in (old, new))
    matches = [_ARGUMENT_TERM.fullmatch(" ".join(terms)) for terms in (old_terms - new_terms, new_terms - old_terms)]
    before, after = matches
    if before is None or after is None or before["name"] != after["name"] or before["word"] == after["word"]:
        return None
    return before["name"]


def find_added_terms(old: str, new: str) -> str:
    """Return the terms that a condition has in addition to all the old ones; empty if there are none."""
    old_terms, new_terms = split_condition(old), split_condition(new)
    added = [term for term in new_terms if term not in old_terms]
    return " and ".join(added) if set(old_terms) <= set(new_terms) else ""


def _evaluate_expression(node: ast.expr) -> object:
    """Return the value of an expression of constants, comparisons and logic.

    Raises:
        ValueError: the expression contains anything else.
    """
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name) and node.id.lower() in _BOOLEANS:
        return _BOOLEANS[node.id.lower()]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return not _to_bool(_evaluate_expression(node.operand))
    if isinstance(node, ast.BoolOp):
        values = [_to_bool(_evaluate_expression(item)) for item in node.values]
        return all(values) if isinstance(node.op, ast.And) else any(values)
    if isinstance(node, ast.IfExp):
        return _evaluate_expression(node.body if _to_bool(_evaluate_expression(node.test)) else node.orelse)
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Dict):
        keys = [_evaluate_expression(key) for key in node.value.keys if key is not None]
        return _evaluate_expression(node.value.values[keys.index(_evaluate_expression(node.slice))])
    if isinstance(node, (ast.List, ast.Tuple)):
        return [_evaluate_expression(item) for item in node.elts]
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and not (node.args or node.keywords):
        owner = _evaluate_expression(node.func.value)
        if isinstance(owner, str) and node.func.attr in _TEXT_METHODS:
            return _TEXT_METHODS[node.func.attr](owner)
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and isinstance(node.ops[0], (ast.In, ast.NotIn)):
        items = _evaluate_expression(node.comparators[0])
        if isinstance(items, list):
            return (_evaluate_expression(node.left) in items) == isinstance(node.ops[0], ast.In)
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and isinstance(node.ops[0], (ast.Eq, ast.NotEq)):
        is_equal = _evaluate_expression(node.left) == _evaluate_expression(node.comparators[0])
        return is_equal == isinstance(node.ops[0], ast.Eq)
    raise ValueError(ast.dump(node))


def _to_bool(value: object) -> bool:
    """Return a value as a boolean, as launch converts a condition.

    Raises:
        ValueError: the value is neither true nor false.
    """
    truth = _BOOLEANS.get(str(value).lower())
    if truth is None:
        raise ValueError(value)
    return truth
