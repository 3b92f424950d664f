"""Compare and write expressions in values of launch files, without their layout."""

from __future__ import annotations

import ast
import hashlib
import re
from copy import deepcopy

from linkwright.packages.readers.python_values import parse_python_expression

_MAX_CHARACTERS = 10_000
"""The maximum number of characters kept of an expression. If names refer to names, the text can grow exponentially."""
_EXPRESSION = re.compile(r"\s*\$\(eval\s+(?P<text>.*)\)\s*", re.DOTALL)
_SUBSTITUTION = re.compile(r"\$\([^()]*\)")
_STRING_OR_BLANKS = re.compile(r"(?P<text>'[^']*'|\"[^\"]*\")|\s+")


def are_equal_expressions(old: str | None, new: str | None) -> bool:
    """Return whether two values are expressions with equal meaning.

    Such expressions differ only in blanks and unnecessary parentheses.
    """
    matches = [_EXPRESSION.fullmatch(text or "") for text in (old, new)]
    texts = [match["text"] for match in matches if match is not None]
    return len(texts) == 2 and _normalize_layout(texts[0]) == _normalize_layout(texts[1])


def _normalize_layout(text: str) -> str:
    """Return an expression in normalized layout, with names in place of substitutions."""
    substitutions: dict[str, str] = {}

    def replace_substitution(match: re.Match[str]) -> str:
        return substitutions.setdefault(match[0], f"_substitution_{len(substitutions)}")

    try:
        normalized = ast.unparse(parse_python_expression(_SUBSTITUTION.sub(replace_substitution, text).strip()))
    except (SyntaxError, ValueError, RecursionError):
        return _STRING_OR_BLANKS.sub(lambda match: match["text"] or "", text)
    return f"{normalized} {list(substitutions)}"


def unparse_on_one_line(node: ast.expr) -> str:
    """Return an expression on one line, with one notation for a value that is one of several constants."""
    if any(isinstance(part, (ast.BoolOp, ast.In)) for part in ast.walk(node)):
        node = _Memberships().visit(deepcopy(node))
    return " ".join(ast.unparse(node).split())


class _Memberships(ast.NodeTransformer):
    """Write ``a == 1 or a == 2``, and ``a in (2, 1)``, as ``a in [1, 2]``."""

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        self.generic_visit(node)
        pairs = [_find_constants(value) for value in node.values] if isinstance(node.op, ast.Or) else []
        known = [pair for pair in pairs if pair is not None]
        lefts = {ast.dump(left) for left, _ in known}
        if len(known) != len(node.values) or len(lefts) != 1:
            return node
        return _make_membership(known[0][0], [value for _, values in known for value in values])

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        self.generic_visit(node)
        found = _find_constants(node) if isinstance(node.ops[0], ast.In) else None
        return node if found is None else _make_membership(*found)


def _find_constants(node: ast.expr) -> tuple[ast.expr, list[ast.expr]] | None:
    """Return the value that a test compares, and the constants one of which it must be; None for other tests."""
    if not isinstance(node, ast.Compare) or len(node.ops) != 1:
        return None
    right = node.comparators[0]
    if isinstance(node.ops[0], ast.Eq):
        values = [right]
    elif isinstance(node.ops[0], ast.In) and isinstance(right, (ast.List, ast.Tuple, ast.Set)):
        values = right.elts
    else:
        return None
    return (node.left, values) if values and all(isinstance(value, ast.Constant) for value in values) else None


def _make_membership(left: ast.expr, values: list[ast.expr]) -> ast.Compare:
    distinct = {ast.unparse(value): value for value in values}
    items = ast.List([distinct[text] for text in sorted(distinct)], ast.Load())
    return ast.Compare(left, [ast.In()], [items])


def shorten_text(text: str) -> str:
    """Return a text, shortened if it is long, with a hash of the whole text."""
    if len(text) <= _MAX_CHARACTERS:
        return text
    return f"{text[:_MAX_CHARACTERS]}... ({hashlib.sha256(text.encode('utf-8', 'replace')).hexdigest()[:12]})"
