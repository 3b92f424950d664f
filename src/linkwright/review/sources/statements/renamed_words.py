"""Find variables, members and functions that were only renamed, because code that uses them has not changed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher

from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.texts.name_words import split_name

_TOKEN = re.compile(r""""(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|\w+|[^\w\s]""")
_LITERAL_OR_WORD = re.compile(r""""(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|\w+""")
_QUOTES = "\"'"
_NAME = re.compile(r"[a-z_]\w*")
_DECLARING_ENDS = frozenset({"=", ";", "{", ",", ")", ":", "["})
_TYPE_MARKS = frozenset({">", "&", "*"})
_NO_TYPES = frozenset(
    {*("return", "new", "else", "throw", "delete", "case", "goto", "and", "or", "not", "in", "is", "if", "while"),
     *("lambda", "yield", "await", "import", "from", "assert", "del", "raise", "co_return", "sizeof", "typename")}
)  # fmt: skip
_OPERATORS = frozenset({"=", "+", "-", "/", "%", ".", "return", "!", "?"})
"""The operators of expressions, in which ``a * b`` is a product."""
_MAX_COMPARED_PAIRS = 1_000_000


def find_renamed_words(old: Mapping[str, Code], new: Mapping[str, Code]) -> dict[str, str]:
    """Return the names that sources of both versions define, and that only differ in the name.

    A name that is renamed in two ways, or to which two names are renamed, is left out.

    Args:
        old: the code of the old sources, by path.
        new: the code of the new sources, by path.
    """
    pairs: set[tuple[str, str]] = set()
    for path, code in new.items():
        if path in old:
            variables = _find_variables(old[path], code, is_cpp=path.endswith(CPP_SUFFIXES))
            pairs |= {*variables, *_find_functions(old[path], code)}
    olds, news = [pair[0] for pair in pairs], [pair[1] for pair in pairs]
    return {before: after for before, after in sorted(pairs) if olds.count(before) == news.count(after) == 1}


def rename_words(old: Code, new: Code, words: Mapping[str, str]) -> Code:
    """Return old code with new names, without those that the new code still has or the old one had already."""
    sides = [
        {word for part in _list_parts(code) for word in _LITERAL_OR_WORD.findall(part.text)} for code in (old, new)
    ]
    own = {before: after for before, after in words.items() if before not in sides[1] and after not in sides[0]}
    if sides[0].isdisjoint(own):
        return old

    def rename(parts: Sequence[Part]) -> list[Part]:
        return [
            part._replace(text=_LITERAL_OR_WORD.sub(lambda match: own.get(match[0], match[0]), part.text))
            for part in parts
        ]

    functions = {name: rename(parts) for name, parts in old.functions.items()}
    return replace(old, functions=functions, outside={name: rename(parts) for name, parts in old.outside.items()})


def _find_variables(old: Code, new: Code, *, is_cpp: bool) -> Iterator[tuple[str, str]]:
    """Yield the variables, parameters and members whose definitions only differ in their names."""
    for before, after in ((old.functions, new.functions), (old.outside, new.outside)):
        for name, parts in after.items():
            for pair in _pair_parts(before.get(name, ()), parts):
                yield from _find_in_part(*pair, is_cpp=is_cpp)


def _pair_parts(old: Sequence[Part], new: Sequence[Part]) -> Iterator[tuple[list[str], list[str]]]:
    """Yield the tokens of statements that may be versions of one statement."""
    texts = [[part.text for part in parts] for parts in (old, new)]
    if texts[0] == texts[1] or len(old) * len(new) > _MAX_COMPARED_PAIRS:
        return
    matcher = SequenceMatcher(None, texts[0], texts[1], autojunk=False)
    for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        if tag == "replace" and old_end - old_start == new_end - new_start:
            pairs = zip(texts[0][old_start:old_end], texts[1][new_start:new_end], strict=True)
            yield from ((_TOKEN.findall(before), _TOKEN.findall(after)) for before, after in pairs)


def _find_in_part(old: Sequence[str], new: Sequence[str], *, is_cpp: bool) -> Iterator[tuple[str, str]]:
    """Yield the names that a statement defines in two versions that only differ in names."""
    if len(old) != len(new):
        return
    places = [index for index in range(len(old)) if old[index] != new[index]]
    variable = next(((old[index], new[index]) for index in places), None)
    others = [index for index in places if (old[index], new[index]) != variable]
    if variable is not None and all(_is_text_of(variable, old[index], new[index]) for index in others):
        places = [index for index in places if index not in others]
    if all(_NAME.fullmatch(old[index]) and _NAME.fullmatch(new[index]) for index in places):
        is_defined = _is_declared if is_cpp else _is_assigned
        yield from ((old[index], new[index]) for index in places if is_defined(new, index))


def _is_text_of(variable: tuple[str, str], old: str, new: str) -> bool:
    """Return whether two literals are texts with the old and the new name of a variable."""
    return old[0] in _QUOTES and new[0] in _QUOTES and (old[1:-1], new[1:-1]) == variable


def _is_declared(tokens: Sequence[str], index: int) -> bool:
    """Return whether a statement in C++ declares a name: its type is before it."""
    before, after = tokens[index - 1] if index else "", tokens[index + 1] if index + 1 < len(tokens) else ";"
    if after not in _DECLARING_ENDS or before in _NO_TYPES:
        return False
    if before not in _TYPE_MARKS:
        return re.fullmatch(r"[A-Za-z_]\w*", before) is not None
    head = tokens[: tokens.index("(")] if "(" in tokens[:index] else []
    is_expression = not _OPERATORS.isdisjoint(tokens[:index]) or tokens[0] in _NO_TYPES
    return not is_expression and (not head or len(head) > 1)


def _is_assigned(tokens: Sequence[str], index: int) -> bool:
    """Return whether a statement in Python assigns a variable or a private attribute, or has a parameter."""
    if tokens[:1] == ["def"]:
        return tokens[index - 1] in ("(", ",", "*")
    if tokens[index + 1 : index + 2] != ["="]:
        return False
    before = [token for token in tokens[:index] if not token.isdigit()]
    return not before or (before == ["self", "."] and tokens[index].startswith("_"))


def _find_functions(old: Code, new: Code) -> Iterator[tuple[str, str]]:
    """Yield the functions that have another name but the same scope and code."""
    removed = [name for name in old.functions if name not in new.functions]
    added = [name for name in new.functions if name not in old.functions]
    for name in removed:
        scope, short = _split(name)
        matching = [other for other in added if _split(other)[0] == scope and _is_version(old, name, new, other)]
        if len(matching) == 1:
            yield short, _split(matching[0])[1]


def _is_version(old: Code, name: str, new: Code, other: str) -> bool:
    """Return whether two functions have the same code, or names that only differ in their notation."""
    words = [split_name(_split(function)[1]) for function in (name, other)]
    return words[0] == words[1] or (bool(old.get_body(name)) and old.get_body(name) == new.get_body(other))


def _list_parts(code: Code) -> list[Part]:
    return [part for parts in (*code.functions.values(), *code.outside.values()) for part in parts]


def _split(name: str) -> tuple[str, str]:
    """Return the scope and the last part of a qualified name."""
    scope, _, short = name.rpartition("::" if "::" in name else ".")
    return scope, short
