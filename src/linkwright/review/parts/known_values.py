"""Evaluate expressions and conditions of unexpanded descriptions with the values that are known."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from linkwright.review.parts.outline import PROPERTY, Item, MacroOutline, Outline, iterate_items
from linkwright.xacro.expressions.scope import parse_literal
from linkwright.xmltree import Element

_SUBSTITUTION = re.compile(r"\$\(arg\s+(?P<argument>[^\s()]+)\s*\)|\$\{(?P<expression>[^{}]*)\}")
_CONDITION = re.compile(r"(?P<word>if|unless) (?P<value>.*)", re.DOTALL)
_MAX_CHARACTERS = 200
_MAX_DEPTH = 5
"""The maximum number of properties and defaults that name each other."""
_NAMES = {"True": True, "False": False, "true": True, "false": False}


def evaluate_text(text: str, values: Mapping[str, str], kept: Collection[str] = ()) -> str:
    """Return a text with the values of its expressions; those with unknown names remain.

    Args:
        text: the text, with expressions such as ``${name}`` and ``$(arg name)``.
        values: the values of properties and parameters by name, and those of arguments by ``$`` and the name.
        kept: the names that are not replaced.
    """
    evaluation = _Evaluation({name: value for name, value in values.items() if name not in kept})
    for _ in range(_MAX_DEPTH):
        result = evaluation.replace(text)
        if result == text:
            break
        text = result
    return text


def evaluate_condition(condition: str, values: Mapping[str, str]) -> bool | None:
    """Return whether a condition such as ``if ${x}`` holds, or None if it depends on unknown values."""
    match = _CONDITION.fullmatch(condition)
    value = None if match is None else parse_literal(evaluate_text(match["value"].strip(), values))
    if match is None or not isinstance(value, bool | int | float):
        return None
    return bool(value) ^ (match["word"] == "unless")


def is_left_out(item: Item, values: Mapping[str, str]) -> bool:
    """Return whether a condition around an element does not hold."""
    return any(evaluate_condition(condition, values) is False for condition in item.conditions)


def collect_values(
    defaults: Mapping[str, str], outlines: Iterable[Outline], macro: MacroOutline | None = None
) -> dict[str, str]:
    """Return the values of properties and parameters by name, and those of arguments by ``$`` and the name.

    A property has the one value whose conditions may hold with the defaults of arguments and parameters.

    Args:
        defaults: the defaults of arguments, by name.
        outlines: the files with properties.
        macro: the macro in which the names are used; None outside of macros.
    """
    values: dict[str, str] = {"$" + name: default for name, default in defaults.items()}
    values |= _choose_properties([outline.root for outline in outlines], values)
    if macro is None:
        return values
    for name, parameter in macro.parameters.items():
        values.pop(name, None)
        if parameter.default is not None and not parameter.forward:
            values[name] = parameter.default.strip("'\"")
    for name in _find_properties(macro.element):
        values.pop(name, None)
    return values | _choose_properties([macro.element], values)


def _choose_properties(roots: Iterable[Element], values: Mapping[str, str]) -> dict[str, str]:
    """Return the properties that have one value with the given values, with this value."""
    found: dict[str, set[str]] = {}
    nested: set[str] = set()
    for root in roots:
        items = [item for item in iterate_items(root) if item.element.tag == PROPERTY]
        nested |= _find_properties(root) - {item.element.attributes.get("name", "") for item in items}
        for item in items:
            if not is_left_out(item, values):
                found.setdefault(item.element.attributes.get("name", ""), set()).add(
                    item.element.attributes.get("value", item.element.attributes.get("default", ""))
                )
    return {name: next(iter(texts)) for name, texts in found.items() if len(texts) == 1 and name not in nested}


def _find_properties(root: Element) -> set[str]:
    return {element.attributes.get("name", "") for element in root.walk() if element.tag == PROPERTY}


class _Evaluation:
    """An evaluation of expressions of names, texts, comparisons and choices.

    Args:
        values: the known values, by name.
    """

    def __init__(self, values: Mapping[str, str]) -> None:
        self._values = values
        self._results: dict[str, Any] = dict(_NAMES)

    def replace(self, text: str) -> str:
        """Return a text in which known expressions are replaced once."""
        return _SUBSTITUTION.sub(self._replace, text)

    def _replace(self, match: re.Match[str]) -> str:
        name = f"${match['argument']}" if match["argument"] else match["expression"].strip()
        if name in self._values or match["argument"]:
            return self._values.get(name, match[0])
        try:
            return str(self._evaluate(_parse(name)))
        except (ValueError, TypeError):
            return match[0]

    def _find(self, name: str) -> Any:
        """Return the value of a name.

        Raises:
            ValueError: it is unknown.
        """
        if name not in self._results:
            self._results[name] = None  # a value that names itself is unknown
            text = self._values.get(name, "$")
            for _ in range(_MAX_DEPTH):
                text = self.replace(text)
            self._results[name] = None if "$" in text else parse_literal(text)
        if self._results[name] is None:
            raise ValueError
        return self._results[name]

    def _evaluate(self, node: ast.expr) -> Any:
        """Return the value of an expression.

        Raises:
            ValueError: the expression has an unknown name, or is of another kind.
        """
        match node:
            case ast.Constant(value=str() | bool() | int() | float() as value):
                return value
            case ast.Name(id=name):
                return self._find(name)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return not self._evaluate(operand)
            case ast.BoolOp(op=operation, values=operands):
                results = [self._evaluate(operand) for operand in operands]
                is_or = isinstance(operation, ast.Or)
                return next((result for result in results if bool(result) is is_or), results[-1])
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._evaluate(body if self._evaluate(test) else other)
            case ast.BinOp(op=ast.Add(), left=left, right=right):
                return self._evaluate(left) + self._evaluate(right)
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as operation], comparators=[right]):
                return (self._evaluate(left) == self._evaluate(right)) is isinstance(operation, ast.Eq)
        raise ValueError


def _parse(expression: str) -> ast.expr:
    """Return the syntax of an expression.

    Raises:
        ValueError: it is not valid.
    """
    if len(expression) > _MAX_CHARACTERS:
        raise ValueError
    try:
        return ast.parse(expression, mode="eval").body
    except (SyntaxError, RecursionError, MemoryError) as error:
        raise ValueError from error
