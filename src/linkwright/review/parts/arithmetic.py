"""Evaluate numeric expressions, such as ``radians(90)``, in unexpanded descriptions."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping

from linkwright.packages.readers.python_values import parse_python_expression

_MAX_CHARACTERS = 200
_CONSTANTS = {"pi": math.pi}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "radians": math.radians,
    "degrees": math.degrees,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "sqrt": math.sqrt,
    "abs": abs,
    "float": float,
}
_OPERATORS: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def evaluate_number(expression: str, values: Mapping[str, str]) -> str | None:
    """Return the value of a numeric expression with 12 digits; None for other expressions.

    Args:
        expression: the expression, without ``${`` and ``}``.
        values: the values of properties, by name.
    """
    if len(expression) > _MAX_CHARACTERS:
        return None
    try:
        number = _evaluate(parse_python_expression(expression.strip()), values)
    except (ArithmeticError, SyntaxError, ValueError):
        return None
    return f"{number:.12g}" if math.isfinite(number) else None


def _evaluate(node: ast.expr, values: Mapping[str, str]) -> float:
    """Return the value of a node of a numeric expression.

    Raises:
        ValueError: the node is not a numeric expression.
        ArithmeticError: the value is not defined or too large.
    """
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return float(value)
        case ast.Name(id=name) if name in values:
            return float(values[name])
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_evaluate(operand, values)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(left, values), _evaluate(right, values))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_evaluate(argument, values))
    raise ValueError
