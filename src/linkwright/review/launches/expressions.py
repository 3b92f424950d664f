"""Compare expressions in values of launch files, without their layout."""

from __future__ import annotations

import ast
import re

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
        normalized = ast.unparse(ast.parse(_SUBSTITUTION.sub(replace_substitution, text).strip(), mode="eval"))
    except (SyntaxError, ValueError, RecursionError):
        return _STRING_OR_BLANKS.sub(lambda match: match["text"] or "", text)
    return f"{normalized} {list(substitutions)}"
