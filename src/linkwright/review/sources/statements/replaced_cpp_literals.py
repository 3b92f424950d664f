"""Find literals of C++ sources that a parameter with another default replaces."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.sources.cpp.members import read_included_headers
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.cpp.values import InitialValues
from linkwright.review.sources.names import NameKind, SourceNames
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.statements.cpp import read_cpp_statements
from linkwright.review.sources.statements.literals import Statement
from linkwright.review.sources.statements.new_failures import find_read_parameters
from linkwright.review.sources.statements.tokens import Token, TokenKind

_NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?", re.IGNORECASE)
_BEFORE_SIGN = frozenset({"(", "[", "{", ",", "=", "return", "<", ">", "<=", ">=", "==", "!=", "*", "/", "?", ":"})
_MEMBER = re.compile(r"(?![A-Z][A-Z0-9_]*\Z)[A-Za-z_]\w*")
"""A name of a member or variable. Constants in capitals have lines of their own."""
_BOOLEANS = frozenset({"true", "false"})


def find_replaced_cpp_literals(
    old_path: Path, new_path: Path, names: SourceNames, reported: Sequence[str]
) -> Iterator[tuple[Phrase, Span]]:
    """Yield the literals of functions of both versions that a new parameter or member with another value replaces.

    Args:
        old_path: the old source.
        new_path: the new source.
        names: the names in the new source, with the defaults of its parameters.
        reported: the other lines about the source. Literals that one of them names with the parameter are left out.
    """
    old_source, new_source = try_read_source(old_path), try_read_source(new_path)
    if old_source is None or new_source is None:
        return
    known = set(re.findall(r"\w+", old_source.text))
    parameters = {
        variable: name
        for variable, name in find_read_parameters(blank_comments(new_source.text)).items()
        if variable not in known
    }
    try:
        old, new = read_cpp_statements(old_source.text), read_cpp_statements(new_source.text)
    except (ValueError, RecursionError):
        return
    members = _find_members(new_path, new_source.text, new, known | parameters.keys())
    variables = parameters | members
    found: dict[tuple[str, str, str], Token] = {}
    for function, statements in new.items():
        after = [_join_signs(statement.tokens) for statement in statements if function in old]
        kept = {_get_texts(tokens) for tokens in after}
        before = {_get_texts(_join_signs(statement.tokens)) for statement in old.get(function, [])} - kept
        for tokens in after if before and variables else ():
            for literal, variable, token in _find_replaced(before, tokens, variables):
                found.setdefault((function, literal, variable), token)
    for (function, literal, variable), token in found.items():
        if variable in members:
            if not _is_same(literal, members[variable]):
                values = {"variable": variable, "value": members[variable], "old": literal, "name": function}
                text = phrase("'{variable}' ({value}) replaces {old} in '{name}()'", **values)
                yield text, new_source.span(token.start, token.end)
            continue
        name = parameters[variable]
        default = _find_default(name, names)
        is_reported = any(f"'{name}'" in line and literal.strip('"') in line for line in reported)
        if not _is_same(literal, default) and not (literal.startswith('"') and is_reported):
            values = {"parameter": name, "old": literal, "name": function}
            text = phrase("parameter '{parameter}' replaces {old} in '{name}()'", **values)
            if default:
                text = phrase(
                    "parameter '{parameter}' replaces {old} in '{name}()': {default} by default",
                    **values,
                    default=default,
                )
            yield text, new_source.span(token.start, token.end)


def _find_members(
    path: Path, text: str, statements: Mapping[str, Sequence[Statement]], known: Collection[str]
) -> dict[str, str]:
    """Return the initial values of new members and variables that nothing else sets, by name.

    Args:
        path: the source.
        text: its text.
        statements: its statements by function.
        known: the names of other variables, which are left out.
    """
    words = {token.text for items in statements.values() for item in items for token in item.tokens} - set(known)
    names = {word for word in words if _MEMBER.fullmatch(word)}
    if not names:
        return {}
    values = InitialValues(blank_comments(text), [blank_comments(item) for item in read_included_headers(path)])
    found = {name: values.find_kept_value(name) for name in names}
    return {name: value for name, value in found.items() if value is not None}


def _join_signs(tokens: Sequence[Token]) -> list[tuple[str, Token]]:
    """Return the texts of tokens, each with its token: signs with their numbers, without ``const`` and ``this``."""
    joined: list[tuple[str, Token]] = []
    index = 0
    while index < len(tokens):
        token, text = tokens[index], tokens[index].text
        following = tokens[index + 1] if index + 1 < len(tokens) else None
        before = joined[-1][0] if joined else "("
        if following is not None and text == "this" and following.text == "->":
            index += 2
            continue
        if text == "const":
            index += 1
            continue
        if following is not None and text == "-" and following.kind is TokenKind.NUMBER and before in _BEFORE_SIGN:
            text = f"-{following.text}"
            index += 1
        joined.append((text, token))
        index += 1
    return joined


def _get_texts(tokens: Sequence[tuple[str, Token]]) -> tuple[str, ...]:
    return tuple(text for text, _ in tokens)


def _find_replaced(
    old: Iterable[Sequence[str]], new: Sequence[tuple[str, Token]], parameters: Mapping[str, str]
) -> list[tuple[str, str, Token]]:
    """Return the literals of the only old statement that differs from a new one in nothing else, with the variables."""
    if not any(text in parameters for text, _ in new):
        return []
    matching = []
    for statement in old:
        if len(statement) == len(new):
            differing = [(before, *after) for before, after in zip(statement, new, strict=True) if before != after[0]]
            if all(text in parameters and _is_literal(before) for before, text, _ in differing):
                matching.append(differing)
    return matching[0] if len(matching) == 1 else []


def _is_literal(text: str) -> bool:
    return text in _BOOLEANS or text.startswith('"') or _NUMBER.fullmatch(text.rstrip("fFlLuU")) is not None


def _find_default(name: str, names: SourceNames) -> str:
    """Return the default of a parameter; empty if it is unknown or none."""
    items = names.of_kind(NameKind.PARAMETER)
    defaults = {
        item.type for item in items if item.name == name or item.name.endswith((f"/{name}", f"~{name}", f".{name}"))
    }
    return defaults.pop() if len(defaults) == 1 else ""


def _is_same(literal: str, default: str) -> bool:
    """Return whether a literal and a default have the same value."""
    numbers = [text.rstrip("fFlLuU") for text in (literal, default)]
    if all(map(_NUMBER.fullmatch, numbers)):
        return float(numbers[0]) == float(numbers[1])
    return literal == default
