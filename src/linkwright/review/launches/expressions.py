"""Expressions in values of launch files: whether two of them differ only in their layout."""

from __future__ import annotations

import ast
import re

_EXPRESSION = re.compile(r"\s*\$\(eval\s+(?P<text>.*)\)\s*", re.DOTALL)
_SUBSTITUTION = re.compile(r"\$\([^()]*\)")
_OUTSIDE_OF_TEXTS = re.compile(r"(?P<text>'[^']*'|\"[^\"]*\")|\s+")


def is_same_expression(old: str | None, new: str | None) -> bool:
    """Return whether two values are expressions that differ only in blanks and needless parentheses."""
    matches = [_EXPRESSION.fullmatch(text or "") for text in (old, new)]
    texts = [match["text"] for match in matches if match is not None]
    return len(texts) == 2 and _without_layout(texts[0]) == _without_layout(texts[1])


def _without_layout(text: str) -> str:
    """Return an expression in one form, in which other substitutions are names."""
    substitutions: dict[str, str] = {}

    def name_of(match: re.Match[str]) -> str:
        return substitutions.setdefault(match[0], f"_substitution_{len(substitutions)}")

    try:
        form = ast.unparse(ast.parse(_SUBSTITUTION.sub(name_of, text).strip(), mode="eval"))
    except (SyntaxError, ValueError, RecursionError):
        return _OUTSIDE_OF_TEXTS.sub(lambda match: match["text"] or "", text)
    return f"{form} {list(substitutions)}"
