"""Find the argument of a call that differs between two statements that are otherwise equal."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple

from linkwright.review.sources.statements.literals import TEXTS_FOR_READERS, Difference, Statement
from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens, match_brackets
from linkwright.review.texts.excerpts import differing_excerpts

_CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]+")
_DEFINITIONS = frozenset({"def", "class", "async", "lambda", "for"})
"""The words at the beginning of statements that define something, or of loops."""
_JOINERS = frozenset({".", "::", "->"})
_MAX_CHARACTERS = 80
_MAX_LEFT_CHARACTERS = 30
"""The maximum number of characters of a shown argument before the one that differs."""
_MIN_PROSE_WORDS = 3
"""The minimum number of words of a text for human readers."""


class _Call(NamedTuple):
    """A call in a statement: its first token, its opening bracket and its arguments."""

    first: int
    opening: int
    arguments: list[Sequence[Token]]


def find_argument_difference(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the argument that a call has in place of another one, or that is added or removed.

    Their literals and constants differ; the names of variables are not compared.
    """
    if not new.tokens or new.tokens[0].text in _DEFINITIONS:
        return
    texts = [[token.text for token in statement.tokens] for statement in (old, new)]
    start = _count_equal(*texts)
    end = min(_count_equal(texts[0][::-1], texts[1][::-1]), len(texts[0]) - start, len(texts[1]) - start)
    brackets = [match_brackets(statement.tokens) for statement in (old, new)]
    opening = _find_opening(new.tokens, start, len(new.tokens) - end, brackets[1])
    if opening is None or brackets[0].get(opening, 0) != len(old.tokens) - (len(new.tokens) - brackets[1][opening]):
        return
    calls = [
        _read_call(statement.tokens, opening, pairs) for statement, pairs in zip((old, new), brackets, strict=True)
    ]
    arguments = [[join_tokens(argument) for argument in call.arguments] for call in calls]
    start = _count_equal(*arguments)
    end = min(_count_equal(arguments[0][::-1], arguments[1][::-1]), *(len(items) - start for items in arguments))
    changed = [call.arguments[start : len(call.arguments) - end] for call in calls]
    literals = [_list_literals(items) for items in changed]
    if calls[1].first == opening or max(map(len, changed)) > 1 or literals[0] == literals[1]:
        return
    if any(map(_is_for_readers, changed)):
        return
    before, after = (
        _format_call(statement.tokens, call, pairs[opening])
        for statement, call, pairs in zip((old, new), calls, brackets, strict=True)
    )
    token, old_value, new_value = new.tokens[opening], *map(_format_value, changed)
    if all(changed) and not any("(" in items[start] for items in arguments):  # with calls in it, it is hard to read
        left = [text if len(text) <= _MAX_LEFT_CHARACTERS else "..." for text in arguments[1][:start]]
        items = [*left, f"{arguments[0][start]} -> {arguments[1][start]}", *(["..."] if end else [])]
        yield Difference(f"{after[: after.index('(') + 1]}{', '.join(items)})", old_value, new_value, token)
        return
    is_long = max(len(before), len(after)) > _MAX_CHARACTERS
    yield Difference(
        " -> ".join(differing_excerpts(before, after) if is_long else (before, after)), old_value, new_value, token
    )


def _count_equal(old: Sequence[str], new: Sequence[str]) -> int:
    """Return the number of equal items at the beginning."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(old, new, strict=False)))


def _find_opening(tokens: Sequence[Token], start: int, end: int, brackets: Mapping[int, int]) -> int | None:
    """Return the innermost bracket around a range of tokens if it is that of a call, or None."""
    opening = next(
        (index for index in range(start - 1, -1, -1) if brackets.get(index, -1) >= max(end, index + 1)), None
    )
    is_call = opening is not None and opening > 0 and tokens[opening].text == "("
    return opening if is_call and opening is not None and tokens[opening - 1].kind is TokenKind.WORD else None


def _read_call(tokens: Sequence[Token], opening: int, brackets: Mapping[int, int]) -> _Call:
    first = opening
    while first > 0 and tokens[first - 1].kind is TokenKind.WORD:
        first -= 1
        if first > 1 and tokens[first - 1].text in _JOINERS:
            first -= 1
        else:
            break
    arguments, start, index = [], opening + 1, opening + 1
    while index <= brackets[opening]:
        if index == brackets[opening] or tokens[index].text == ",":
            arguments += [tokens[start:index]] if start < index else []
            start = index + 1
        index = max(brackets.get(index, index), index) + 1 if index != brackets[opening] else index + 1
    return _Call(first, opening, arguments)


def _is_for_readers(arguments: Sequence[Sequence[Token]]) -> bool:
    """Return whether an argument is a text for human readers."""
    return any(
        argument[0].text in TEXTS_FOR_READERS
        or any(token.kind is TokenKind.TEXT and len(token.text.split()) >= _MIN_PROSE_WORDS for token in argument)
        for argument in arguments
    )


def _list_literals(arguments: Sequence[Sequence[Token]]) -> list[str]:
    """Return the literals and constants in arguments."""
    return [
        token.text
        for argument in arguments
        for token in argument
        if token.kind in (TokenKind.TEXT, TokenKind.NUMBER) or _CONSTANT.fullmatch(token.text) is not None
    ]


def _format_value(arguments: Sequence[Sequence[Token]]) -> str:
    """Return the value of the only argument without its keyword, or an empty text if there is none."""
    if not arguments:
        return ""
    (tokens,) = arguments
    return join_tokens(tokens[2:] if [token.text for token in tokens[1:2]] == ["="] else tokens)


def _format_call(tokens: Sequence[Token], call: _Call, closing: int) -> str:
    """Return a call with the keyword of the argument that it is."""
    text = join_tokens(tokens[call.first : closing + 1])
    before = [token.text for token in tokens[: call.first]]
    is_in_call = before.count("(") > before.count(")")
    if is_in_call and call.first > 2 and before[-1] == "=" and before[-3] in ("(", ","):
        return f"{tokens[call.first - 2].text}={text}"
    return text
