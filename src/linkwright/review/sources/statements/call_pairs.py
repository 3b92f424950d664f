"""Pair the calls of two versions of a function whose results go to variables with other names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from linkwright.review.sources.statements.literals import Statement, parse_statement
from linkwright.review.sources.statements.tokens import TokenKind

_JOINERS = frozenset({".", "::", "->"})
_MODIFIERS = frozenset({"new", "await"})
_SELF = frozenset({"self", "this"})


def pair_by_call(old: Sequence[Statement], new: Sequence[Statement]) -> Iterator[tuple[Statement, Statement]]:
    """Yield the calls that only differ in literals although other variables get their results.

    Each version may only have one such call of the function.
    """
    sides = [[call for item in items if (call := _read_call(item)) is not None] for items in (old, new)]
    for call in sides[0]:
        matching = [other for other in sides[1] if other.shape == call.shape]
        is_sole = len(matching) == 1 and sum(other.shape == call.shape for other in sides[0]) == 1
        if is_sole and any(literal.is_text for literal in call.literals) and matching[0].key != call.key:
            yield call, matching[0]


def _read_call(statement: Statement) -> Statement | None:
    """Return the call whose result a statement assigns, from the name of the function on; None if there is none."""
    texts = [token.text for token in statement.tokens]
    if "=" not in texts or "(" not in texts[texts.index("=") :]:
        return None
    start, opening = texts.index("="), texts.index("(", texts.index("="))
    path = [text for text in texts[start + 1 : opening] if text not in _MODIFIERS]
    is_plain = all((first in _JOINERS) != (second in _JOINERS) for first, second in pairwise(path))
    is_of_own = len(path) > 1 and path[0] in _SELF
    if not path or not is_plain or is_of_own or statement.tokens[opening - 1].kind is not TokenKind.WORD:
        return None
    return parse_statement(statement.tokens[opening - 1 :])
