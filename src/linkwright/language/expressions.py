"""Python expressions in xacro files, as written."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro.expressions.template import TokenKind, tokenize
from linkwright.xacro.faults import Fault

_ENTITY = lazy_pattern(r"&(?:lt|gt|quot|apos|amp);")
_SUBSTITUTION = lazy_pattern(r"\$\([^()]*\)")
_CHARACTERS = {"&lt;": "<", "&gt;": ">", "&quot;": '"', "&apos;": "'", "&amp;": "&"}


class SourceExpression(NamedTuple):
    """An expression in ``${...}``.

    Attributes:
        start: the offset of the ``$`` in the text that contains it.
        end: the offset after the closing brace.
        source: the expression as written.
    """

    start: int
    end: int
    source: str

    @property
    def inner_range(self) -> tuple[int, int]:
        """The offsets of the text between the braces."""
        return self.end - 1 - len(self.source), self.end - 1


def decode_entities(text: str) -> str:
    """Replace each XML entity with its character, padded with spaces to the same length."""
    return _ENTITY.sub(lambda entity: _CHARACTERS[entity[0]].ljust(len(entity[0])), text)


def expressions_in(text: str) -> Iterator[SourceExpression]:
    """Yield the ``${...}`` of an attribute's value or of character data.

    Yields nothing if an expression is incomplete.

    Args:
        text: the text, as written.
    """
    if "$" not in text:
        return
    try:
        parts = tokenize(decode_entities(text))
    except Fault:  # The expression is still being typed.
        return
    for part in parts:
        if part.kind is TokenKind.EXPRESSION:
            yield SourceExpression(part.start, part.end, text[part.end - 1 - len(part.text) : part.end - 1])


def parse_expression(source: str) -> ast.expr | None:
    """Return the syntax tree of an expression as written, or None if it is not valid.

    Offsets in the tree refer to the source without leading spaces. A ``$(...)`` counts as a name.
    """
    body = _SUBSTITUTION.sub(
        lambda command: "_" * len(command[0]), re.sub(r"[\n\r\t]", " ", decode_entities(source)).strip()
    )
    try:
        return ast.parse(body, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def is_subexpression(source: str, start: int, end: int) -> bool:
    """Return whether a range of an expression is a self-contained subexpression.

    Such a subexpression uses no variable that the expression binds.

    Args:
        source: the expression as written.
        start: the offset of the first character of the range.
        end: the offset after its last character.
    """
    inner = parse_expression(source[start:end])
    if inner is None or isinstance(inner, (ast.Starred, ast.NamedExpr)):
        return False
    outer = parse_expression(f"{source[:start]}({source[start:end]}){source[end:]}")
    tree = parse_expression(source)
    if outer is None or tree is None or ast.dump(outer) != ast.dump(tree):
        return False
    bound = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
    bound |= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    return bound.isdisjoint(node.id for node in ast.walk(inner) if isinstance(node, ast.Name))


def substitute_name(source: str, start: int, end: int, new: str) -> str | None:
    """Replace a name in an expression by another expression.

    The other expression is put in parentheses where precedence requires them.

    Args:
        source: the expression as written.
        start: the offset of the name.
        end: the offset after the name.
        new: the other expression as written.

    Returns:
        The new expression, or None if one of them is not valid.
    """
    enclosed, bare = f"{source[:start]}({new}){source[end:]}", f"{source[:start]}{new}{source[end:]}"
    first, second = parse_expression(enclosed), parse_expression(bare)
    if first is None:
        return None
    return bare if second is not None and ast.dump(first) == ast.dump(second) else enclosed
