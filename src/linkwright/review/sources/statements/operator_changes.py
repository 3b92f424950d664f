"""Find the operator that differs between two versions of a statement, such as ``<`` and ``<=`` or a sign."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher

from linkwright.review.sources.statements.literals import Difference, Statement, add_context
from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens, match_brackets
from linkwright.review.texts.excerpts import differing_excerpts

_OPERATORS = frozenset(
    {
        *("+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "!", "<<", ">>", "^"),
        *("+=", "-=", "*=", "/=", "++", "--", "and", "or", "not"),
    }
)
_SIGNS = frozenset({"-", "!", "not"})
"""The operators before one operand, which only one version may have."""
_OPENING = frozenset({"(", "[", "{"})
_JUNCTIONS = frozenset({"&&", "||", "and", "or"})
_SEPARATORS = frozenset({",", ";", "=", ":=", "?", ":", "return", "if", "elif", "while", "in", "else"})
_MAX_CHARACTERS = 60


def find_operator_change(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the operator in which two statements differ, with its operands. Other differences yield nothing."""
    place = _find_place(old.tokens, new.tokens)
    if place is not None:
        yield describe_operator(old, new, place)


def describe_operator(old: Statement, new: Statement, place: tuple[int, int]) -> Difference:
    """Return the operators at the given indexes of two statements, with their operands."""
    ranges = [_find_operands(statement.tokens, index) for statement, index in zip((old, new), place, strict=True)]
    texts = [
        join_tokens(statement.tokens[start:end]) for statement, (start, end) in zip((old, new), ranges, strict=True)
    ]
    shown = texts if max(map(len, texts)) <= _MAX_CHARACTERS else differing_excerpts(texts[0], texts[1])
    start, end = ranges[1]
    text = add_context(new, start, end - 1, " -> ".join(shown), match_brackets(new.tokens))
    return Difference(text, texts[0], texts[1], new.tokens[start])


def differ_by_operator(old: Sequence[Token], new: Sequence[Token]) -> bool:
    """Return whether two statements only differ in one operator."""
    return _find_place(old, new) is not None


def _find_place(old: Sequence[Token], new: Sequence[Token]) -> tuple[int, int] | None:
    """Return the indexes of the only operator that differs, or None."""
    texts = [[token.text for token in tokens] for tokens in (old, new)]
    if abs(len(old) - len(new)) > 1 or texts[0] == texts[1]:
        return None
    changes = [
        change
        for change in SequenceMatcher(None, texts[0], texts[1], autojunk=False).get_opcodes()
        if change[0] != "equal"
    ]
    if len(changes) != 1:
        return None
    tag, old_start, old_end, new_start, new_end = changes[0]
    changed = [*old[old_start:old_end], *new[new_start:new_end]]
    if old_end - old_start > 1 or new_end - new_start > 1 or any(token.text not in _OPERATORS for token in changed):
        return None
    if tag != "replace":
        tokens, index = (old, old_start) if tag == "delete" else (new, new_start)
        return (old_start, new_start) if changed[0].text in _SIGNS and _is_sign(tokens, index) else None
    is_template = any(_is_of_template(tokens, index) for tokens, index in ((old, old_start), (new, new_start)))
    return None if is_template else (old_start, new_start)


def _is_sign(tokens: Sequence[Token], index: int) -> bool:
    """Return whether an operator comes before its only operand."""
    before = tokens[index - 1] if index else None
    has_operand = index + 1 < len(tokens) and tokens[index + 1].text not in _SEPARATORS
    is_first = before is None or before.text in _OPENING | _SEPARATORS | _JUNCTIONS | _OPERATORS
    return has_operand and is_first


def _is_of_template(tokens: Sequence[Token], index: int) -> bool:
    """Return whether an operator may belong to a type, such as ``*`` and ``<`` in ``vector<int> * p``."""
    return index == 0 or (tokens[index - 1].kind is TokenKind.OPERATOR and tokens[index - 1].text not in (")", "]"))


def _find_operands(tokens: Sequence[Token], index: int) -> tuple[int, int]:
    """Return the start and end of the operator at an index with its operands."""
    brackets = match_brackets(tokens)
    separators = _SEPARATORS if tokens[index].text in _JUNCTIONS else _SEPARATORS | _JUNCTIONS
    start, end = index, index + (tokens[index].text in _OPERATORS)
    while start > 0 and tokens[start - 1].text not in _OPENING | separators:
        start = brackets.get(start - 1, start - 1)
    while end < len(tokens) and tokens[end].text not in separators | {")", "]", "}"}:
        end = brackets.get(end, end) + 1
    return start, end
