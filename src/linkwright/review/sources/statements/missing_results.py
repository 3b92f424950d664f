"""Find functions in C++ that have the type of a result but never return a value."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.statements.literals import find_template_start
from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens, match_brackets, tokenize_cpp

_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\r?\n|\\.)*", re.MULTILINE)
_SCOPES = frozenset({"namespace", "class", "struct", "union", "enum", "extern"})
_ACCESS = frozenset({"public", "private", "protected", "slots", "Q_SLOTS", "signals"})
_SPECIFIERS = frozenset({"static", "inline", "virtual", "constexpr", "extern", "friend", "const", "struct", "class"})
_QUALIFIERS = frozenset({"const", "noexcept", "override", "final", "volatile", "&", "&&"})
_NOT_RESULT = re.compile(
    r"~|auto|decltype|explicit|operator|noreturn|requires|[=(){};]|if|else|for|while|do|switch|catch|return|new|delete|case"
    r"|throw|using|typedef|[A-Z_][A-Z\d_]+"
)
"""Tokens that no known type of a result has: keywords, and macros, which may be anything."""
_ENDING = re.compile(r"return|throw|goto|asm|__asm\w*|co_\w+|__builtin_\w+")
_ENDING_CALL = re.compile(
    r"\w*(?:throw|abort|exit|fatal|die|fail|panic|terminate|unreachable|exec|longjmp|assert)\w*", re.IGNORECASE
)
"""Functions that may never come back."""
_MACRO = re.compile(r"(?!(?:ROS|RCLCPP|RCUTILS)_(?:DEBUG|INFO|WARN|ERROR)\w*$)[A-Z_][A-Z\d_]+")
_ENDLESS = re.compile(r"\b(?:for \( ; ;|while \( (?:true|1|rclcpp :: ok|ros :: ok))")


class FunctionResult(NamedTuple):
    """A function with the type of a result.

    Attributes:
        name: the name, as its definition spells it.
        type: the type of the result.
        start: the offset of the name.
        is_missing: whether the function certainly returns no value.
    """

    name: str
    type: str
    start: int
    is_missing: bool


def read_function_results(text: str) -> dict[str, FunctionResult]:
    """Return the functions that a source defines with the type of a result, by name and parameters.

    Constructors, functions without a result, those with a deduced type and those that macros define are left out.
    """
    code = _DIRECTIVE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), blank_disabled(text))
    tokens = tokenize_cpp(code)
    pairs = match_brackets(tokens)
    return dict(_read_definitions(tokens, pairs))


def _read_definitions(tokens: Sequence[Token], pairs: dict[int, int]) -> Iterator[tuple[str, FunctionResult]]:
    start = index = 0
    while index < len(tokens):
        token = tokens[index]
        text = token.text if token.kind is TokenKind.OPERATOR else ""
        if text in (";", "}") or (text == ":" and tokens[index - 1].text in _ACCESS):
            start = index + 1
        elif text in ("(", "["):
            index = pairs.get(index, index)
        elif text == "{":
            header = tokens[start:index]
            end = pairs.get(index)
            if end is None:
                return
            is_scope = any(part.text in _SCOPES for part in header) and all(part.text != "(" for part in header)
            if not is_scope:
                yield from _read_function(header, tokens[index + 1 : end])
                index = end
            start = index + 1
        index += 1


def _read_function(header: Sequence[Token], body: Sequence[Token]) -> Iterator[tuple[str, FunctionResult]]:
    """Yield the function of a header, with its name and parameters, unless it is something else."""
    header = _drop_template(header)
    pairs = match_brackets(header)
    opening = next((index for index, part in enumerate(header) if part.text == "(" and index), None)
    if opening is not None and header[opening - 1].text == "operator":  # operator()
        opening = pairs.get(opening, opening) + 1
    if opening is None or opening >= len(header) or opening not in pairs:
        return
    name_start = _find_name_start(header, opening)
    result = [part for part in header[:name_start] if part.text not in _SPECIFIERS]
    rest = header[pairs[opening] + 1 :]
    name = "".join(part.text for part in header[name_start:opening])
    if not result or not name or not all(part.text in _QUALIFIERS for part in rest) or name == "main":
        return
    if any(_NOT_RESULT.fullmatch(part.text) for part in result) or _MACRO.fullmatch(name):
        return
    if re.search(r"\bvoid\b(?! ?\*)", join_tokens(result)):
        return
    key = f"{name}{join_tokens(header[opening : pairs[opening] + 1])}{join_tokens(rest)}"
    type_name = join_tokens(result)
    yield key, FunctionResult(name, type_name, header[name_start].start, is_missing=not _may_return(body))


def _drop_template(header: Sequence[Token]) -> Sequence[Token]:
    """Return a header without the parameters of templates at its beginning."""
    while header and header[0].text == "template":
        depth, end = 0, len(header)
        for index, token in enumerate(header):
            depth += (token.text == "<") - (token.text == ">")
            if depth == 0 and index:
                end = index + 1
                break
        header = header[end:]
    return header


def _find_name_start(header: Sequence[Token], opening: int) -> int:
    """Return the index of the first token of the name before the parameters, with its class."""
    operators = [index for index in range(max(0, opening - 3), opening) if header[index].text == "operator"]
    index = operators[0] if operators else opening - 1
    while index > 1 and header[index - 1].text == "::":
        index -= 2
        if header[index].text == ">":
            index = find_template_start(header, index)
    return index


def _may_return(body: Sequence[Token]) -> bool:
    """Return whether a body may return a value, or never reaches its end."""
    for token, following in zip_longest(body, body[1:]):
        if token.kind is not TokenKind.WORD:
            continue
        is_called = following is not None and following.text in ("(", ";")
        if _ENDING.fullmatch(token.text) or (
            is_called and (_ENDING_CALL.fullmatch(token.text) or _MACRO.fullmatch(token.text))
        ):
            return True
    return _ENDLESS.search(" ".join(token.text for token in body)) is not None
