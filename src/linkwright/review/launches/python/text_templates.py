"""Format texts of Python with values in their fields, such as ``"/{}/scan".format(name)``."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from string import Formatter

_OLD_FIELD = re.compile(r"%(?:%|[-+ #0]*\d*(?:\.\d+)?[sdifgr])")
"""A field of a template of the operator ``%``."""
_CONVERSIONS = frozenset({"float", "int", "str"})


def format_template(node: ast.expr, format_value: Callable[[ast.expr], str]) -> str | None:
    """Return a text such as ``"/{}/scan".format(name)`` or ``"/%s/scan" % name`` with the values in their places.

    The result is None for other expressions, and for templates with fields such as ``{name[0]}``.

    Args:
        node: the expression.
        format_value: a function that returns the text of a value.
    """
    values: dict[str, ast.expr] = {}
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mod):
        template = node.left
        items = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
        values = {str(index): item for index, item in enumerate(items)}
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "format":
        template, items = node.func.value, node.args
        values = {keyword.arg or "": keyword.value for keyword in node.keywords}
        values |= {str(index): item for index, item in enumerate(items)}
    else:
        return None
    text = template.value if isinstance(template, ast.Constant) else None
    if not isinstance(text, str) or any(isinstance(item, (ast.Starred, ast.Dict)) for item in items) or "" in values:
        return None
    fields = list(_split_template(text, is_old_style=isinstance(node, ast.BinOp)))
    if any(field is not None and field not in values for _, field in fields):
        return None
    return "".join(literal + ("" if field is None else format_value(values[field])) for literal, field in fields)


def _split_template(text: str, *, is_old_style: bool) -> Iterator[tuple[str, str | None]]:
    """Yield each literal part of a template with the name or number of the field behind it, if there is one."""
    count = 0
    if is_old_style:
        start = 0
        for match in _OLD_FIELD.finditer(text):
            is_percent = match[0] == "%%"
            literal = text[start : match.start()] + ("%" if is_percent else "")
            yield literal, None if is_percent else str(count)
            count += not is_percent
            start = match.end()
        yield text[start:], None
        return
    try:
        parts = list(Formatter().parse(text))
    except ValueError:
        parts = [("", "?", "", None)]
    for literal, name, _, _ in parts:
        yield literal, str(count) if name == "" else name
        count += name == ""


def strip_conversion(node: ast.expr) -> ast.expr:
    """Return the argument of a call such as ``int(x)``, and any other expression unchanged."""
    is_conversion = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _CONVERSIONS
    return node.args[0] if isinstance(node, ast.Call) and is_conversion and len(node.args) == 1 else node
