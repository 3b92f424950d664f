"""Find the keys, compared texts and constants that only one version of a source has."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain, pairwise
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, joined, joined_first, phrase
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.statements.cpp import read_cpp_statements
from linkwright.review.sources.statements.literals import Literal, Statement, format_literal, parse_statement
from linkwright.review.sources.statements.python import read_python_statements
from linkwright.review.sources.statements.tokens import Token, TokenKind
from linkwright.review.texts.excerpts import shorten_middle

_MAX_TEXTS = 8
"""The maximum number of keys, texts or constants in a line."""
_MAX_TEXT_LENGTH = 60
_COMPARISONS = ("==", "!=")
_READING_METHODS = frozenset(
    {
        *("get", "at", "find", "count", "contains", "has", "has_key", "HasMember", "hasMember", "isMember", "pop"),
        *("startswith", "endswith", "starts_with", "ends_with", "compare"),
    }
)
"""The methods whose first argument is a key or a text to compare with."""
_COMPARING_FUNCTIONS = frozenset({"strcmp", "strncmp", "strcasecmp", "strncasecmp", "iequals"})
_READING_FUNCTIONS = frozenset({"getenv", *_COMPARING_FUNCTIONS})
_OUTPUT_CALLS = frozenset({"param", "getParam", "get_parameter", "get_parameter_or"})
"""The functions that write the value of a parameter into the variable behind its name."""
_QUOTED = re.compile("\"([^\"]*)\"|'([^']*)'")
_CONSTANT_NAME = re.compile(r"_?[A-Z][A-Z0-9_]+")
_ARITHMETIC = frozenset("+-*/")
_PROGRAM_NAME = "__main__"
"""The name of a module of Python that is run as a program. It is not a key."""
_NO_VALUES = ("None", "nullptr", "NULL")
_CHANGES = frozenset({"=", "+=", "-=", "*=", "/=", "%=", "|=", "&=", "//=", "**=", ":=", "++", "--", "in", ","})
"""The tokens after a name that a statement assigns or changes, such as the name of a loop."""
_TYPE_PUNCTUATION = frozenset({"::", "*", "&", "<", ">", "[", "]"})


class OneSidedText(NamedTuple):
    """Something that only one version of a source has.

    Attributes:
        shown: the text with the code around it, or a constant with its value.
        word: the text or name by which the versions are compared.
        token: the token at its location.
    """

    shown: str
    word: str
    token: Token


class TextsChange(NamedTuple):
    """The keys and texts, or the constants, that only one version has.

    Attributes:
        sentence: the names.
        span: the location of the first one.
        is_old: whether the location is in the old version.
    """

    sentence: Phrase
    span: Span
    is_old: bool


def find_key_changes(
    paths: tuple[Path, Path], has_text: tuple[Callable[[str], bool], Callable[[str], bool]], reported: Sequence[str]
) -> Iterator[TextsChange]:
    """Yield the keys that a source reads, and the texts that it compares, if only one version has them.

    Args:
        paths: the old and the new source.
        has_text: functions that return whether the old or the new version has a text in any changed source.
        reported: the other lines about the source. Texts in these lines are left out.
    """
    added, removed = (
        _find_one_sided(path, _find_keys, has_other, reported)
        for path, has_other in zip(reversed(paths), has_text, strict=True)
    )
    parts = [phrase("keys and compared texts added: {texts}", texts=_join(added))] if added else []
    parts += [phrase("keys and compared texts removed: {texts}", texts=_join(removed))] if removed else []
    yield from _make_change(parts, paths, added, removed)


def find_constant_changes(
    paths: tuple[Path | None, Path],
    has_text: tuple[Callable[[str], bool], Callable[[str], bool]],
    reported: Sequence[str],
) -> Iterator[TextsChange]:
    """Yield the constants with a literal value outside of functions and classes that only one version has.

    Args:
        paths: the old source, or None for an added one, and the new source.
        has_text: functions that return whether the old or the new version has a name in any changed source.
        reported: the other lines about the source. Constants in these lines are left out.
    """
    added, removed = (
        [] if path is None else _find_one_sided(path, _find_constants, has_other, reported)
        for path, has_other in zip(reversed(paths), has_text, strict=True)
    )
    renamed = list(_pair_equal_values(removed, added))
    paired = [item for pair in renamed for item in pair]
    added, removed = ([item for item in items if item not in paired] for items in (added, removed))
    parts = []
    if renamed:
        names = [f"{old.word} -> {new.word}" for old, new in renamed]
        parts.append(phrase("constants renamed: {names}", names=joined_first(names, _MAX_TEXTS)))
    parts += [phrase("constants added: {constants}", constants=_join(added))] if added else []
    parts += [phrase("constants removed: {constants}", constants=_join(removed))] if removed else []
    yield from _make_change(parts, paths, [*(new for _, new in renamed), *added], removed)


def _make_change(
    parts: Sequence[Phrase],
    paths: tuple[Path | None, Path],
    added: Sequence[OneSidedText],
    removed: Sequence[OneSidedText],
) -> Iterator[TextsChange]:
    path = paths[1] if added else paths[0]
    source = None if path is None or not parts else try_read_source(path)
    if source is not None:
        token = (added or removed)[0].token
        yield TextsChange(joined(parts, "; "), source.span(token.start, token.end), is_old=not added)


def _join(items: Sequence[OneSidedText]) -> Phrase:
    return joined_first(list(dict.fromkeys(item.shown for item in items)), _MAX_TEXTS)


def _pair_equal_values(
    removed: Sequence[OneSidedText], added: Sequence[OneSidedText]
) -> Iterator[tuple[OneSidedText, OneSidedText]]:
    """Yield the removed and added constants whose value no other removed or added constant has."""
    for old in removed:
        value = old.shown.removeprefix(old.word)
        matching = [[item for item in items if item.shown == item.word + value] for items in (removed, added)]
        if len(matching[0]) == len(matching[1]) == 1:
            yield old, matching[1][0]


def _find_one_sided(
    path: Path,
    find: Callable[[Mapping[str, Sequence[Statement]]], Iterator[OneSidedText]],
    has_other: Callable[[str], bool],
    reported: Sequence[str],
) -> list[OneSidedText]:
    """Return what `find` yields for the statements of a source, without what the other version or another line has."""
    source = try_read_source(path)
    if source is None:
        return []
    try:
        scopes = (
            read_cpp_statements(source.text) if path.suffix in CPP_SUFFIXES else read_python_statements(source.text)
        )
    except (ValueError, SyntaxError, RecursionError):
        return []
    items = {item.word: item for item in reversed(list(find(scopes)))}
    return [
        item
        for item in sorted(items.values(), key=lambda item: item.token.start)
        if not has_other(item.word) and not any(_has_word(line, item.word) for line in reported)
    ]


def _has_word(line: str, word: str) -> bool:
    """Return whether a line has a word that is not the name of an argument, as in ``frame='map'``."""
    return re.search(rf"(?<!\w){re.escape(word)}(?![\w=])", line) is not None


# --- keys and compared texts ----------------------------------------------------------------------------------------


def _find_keys(scopes: Mapping[str, Sequence[Statement]]) -> Iterator[OneSidedText]:
    for statement in chain.from_iterable(scopes.values()):
        for literal in statement.literals:
            if not _is_key(statement.tokens, literal):
                continue
            shown = shorten_middle(format_literal(statement, literal), _MAX_TEXT_LENGTH)
            for token in statement.tokens[literal.first : literal.last + 1]:
                match = _QUOTED.search(token.text) if token.kind is TokenKind.TEXT else None
                word = (match[1] or match[2] or "") if match is not None else ""
                if word != _PROGRAM_NAME and any(character.isalnum() for character in word):
                    yield OneSidedText(shown, word, token)


def _is_key(tokens: Sequence[Token], literal: Literal) -> bool:
    """Return whether a literal is a key that is read, or texts with which something is compared."""
    before, after = (
        tokens[index].text if 0 <= index < len(tokens) else "" for index in (literal.first - 1, literal.last + 1)
    )
    if tokens[literal.first].text in ("[", "(", "{"):
        return before == "in"
    if not literal.is_text:
        return False
    if before in (*_COMPARISONS, "case") or after in (*_COMPARISONS, "in"):
        return True
    if after == "not":
        return tokens[literal.last + 2 : literal.last + 3] != () and tokens[literal.last + 2].text == "in"
    owner = tokens[literal.first - 2] if literal.first > 1 else None
    if owner is None:
        return False
    if before == "[" and after == "]":
        return owner.kind is TokenKind.WORD or owner.text in (")", "]")
    is_method = literal.first > 2 and tokens[literal.first - 3].text in (".", "->")
    if before == "," and _find_function(tokens, literal.first) in _COMPARING_FUNCTIONS:
        return True
    return before == "(" and (owner.text in _READING_FUNCTIONS or (is_method and owner.text in _READING_METHODS))


def _find_function(tokens: Sequence[Token], index: int) -> str:
    """Return the name of the function that takes the token at an index; empty if there is none."""
    depth = 0
    for place in range(index - 1, 0, -1):
        text = tokens[place].text
        depth += (text in (")", "]", "}")) - (text in ("(", "[", "{"))
        if depth < 0:
            return tokens[place - 1].text
    return ""


# --- constants ------------------------------------------------------------------------------------------------------


def _find_constants(scopes: Mapping[str, Sequence[Statement]]) -> Iterator[OneSidedText]:
    """Yield the statements that assign a literal to a name, which keeps it.

    They are outside of functions and classes, or in a class and say that the name is constant.
    """
    counts = Counter(name for statements in scopes.values() for item in statements for name in _list_assigned(item))
    constant = (
        statement
        for scope, statements in scopes.items()
        for statement in statements
        if not scope or (_is_class(statements) and _is_constant(statement))
    )
    for statement in constant:
        tokens = [token for token in statement.tokens if token.text != ";"]
        sign = next((index for index, token in enumerate(tokens) if token.text == "="), 0)
        name = _find_constant_name(tokens[:sign]) if sign else None
        if name is not None and counts[name.text] <= 1 and _has_constant_value(tokens, sign + 1):
            value = shorten_middle(statement.get_text(sign + 1, len(tokens) - 1), _MAX_TEXT_LENGTH)
            yield OneSidedText(f"{name.text} = {value}", name.text, name)


def _is_class(statements: Sequence[Statement]) -> bool:
    """Return whether statements are those of a class in C++, which begin with its head."""
    words = {token.text for token in statements[0].tokens} if statements else set()
    return not words.isdisjoint({"class", "struct"}) and "(" not in words


def _has_constant_value(tokens: Sequence[Token], first: int) -> bool:
    """Return whether the value of an assignment is a literal, or made of constants and literals by operators.

    Args:
        tokens: the tokens of the assignment.
        first: the index of the first token of the value.
    """
    literals = parse_statement(tokens).literals
    if len(literals) == 1 and (literals[0].first, literals[0].last) == (first, len(tokens) - 1):
        return not literals[0].constant and tokens[-1].text not in _NO_VALUES
    operands, operators = tokens[first::2], tokens[first + 1 :: 2]
    is_sum = len(operands) == len(operators) + 1 and all(token.text in _ARITHMETIC for token in operators)
    is_named = any(_CONSTANT_NAME.fullmatch(token.text) for token in operands)
    is_known = all(
        token.kind in (TokenKind.TEXT, TokenKind.NUMBER) or _CONSTANT_NAME.fullmatch(token.text) for token in operands
    )
    return is_sum and is_named and is_known and len(operands) > 1


def _is_constant(statement: Statement) -> bool:
    words = {token.text for token in statement.tokens}
    return "constexpr" in words or {"static", "const"} <= words


def _list_assigned(statement: Statement) -> Iterator[str]:
    """Yield the names that a statement assigns or changes outside of brackets, and those that a call may set."""
    tokens = statement.tokens
    for index, token in enumerate(tokens[1:], start=1):
        before = tokens[index - 1].text
        is_passed = before == "&" and index > 1 and tokens[index - 2].text in ("(", ",")
        is_read = (
            before == "," and index > 3 and tokens[index - 4].text in _OUTPUT_CALLS and tokens[index - 3].text == "("
        )
        if token.kind is TokenKind.WORD and (is_passed or is_read or before in ("++", "--")):
            yield token.text
    depth = 0
    for token, following in pairwise(statement.tokens):
        if token.kind is TokenKind.OPERATOR:
            depth += (token.text in "([{") - (token.text in ")]}")
        elif depth == 0 and token.kind is TokenKind.WORD and following.text in _CHANGES:
            yield token.text


def _find_constant_name(target: Sequence[Token]) -> Token | None:
    """Return the name of a constant, before an annotation or after a type; None for another target."""
    words = [token.text for token in target]
    if ":" in words:
        target = target[: words.index(":")]
    is_typed = all(token.kind is TokenKind.WORD or token.text in _TYPE_PUNCTUATION for token in target)
    is_element = "[" in words and ":" not in words
    named = target[: words.index("[")] if is_element else target
    names = [token for token in named if token.kind is TokenKind.WORD]
    if not is_typed or not names or names[-1].text.startswith("__") or "using" in words or "namespace" in words:
        return None
    return None if is_element and len(names) == 1 else names[-1]
