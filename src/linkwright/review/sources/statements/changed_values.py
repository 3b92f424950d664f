"""Find literals that differ between two versions of a source: numbers, texts and constants."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.statements.argument_changes import find_argument_difference
from linkwright.review.sources.statements.call_pairs import pair_by_call
from linkwright.review.sources.statements.cpp import read_cpp_statements
from linkwright.review.sources.statements.literals import (
    Difference,
    Literal,
    Statement,
    add_context,
    find_expression,
    find_expression_difference,
    find_literal_differences,
    normalize_number,
)
from linkwright.review.sources.statements.operator_changes import describe_operator, find_operator_change
from linkwright.review.sources.statements.python import read_python_statements
from linkwright.review.sources.statements.tokens import Token, TokenKind, match_brackets

_DEFINITION = re.compile(r"\b([A-Z]\w+)(?=\s*(?:=(?!=)|[{\[,]))|define\s+(\w+)")
_QUOTED = re.compile("\"[^\"]*\"|'[^']*'")
_F_STRING = re.compile(r"\A[fF](?=[\"'])")
_MIN_SIMILARITY = 0.6
"""The minimum ratio of equal tokens of two versions of a statement."""
_VARIABLE = re.compile(r"(?:(?<=self \. )|(?<=this -> )|(?<!\S)(?<![.:>] ))[A-Za-z_]\w*(?!\S)(?! \()")
"""A name of a variable in the shape of a statement: not called, and not of another object."""
_WORD = re.compile(r"[A-Za-z_]")
_NAME_MARK = "\1"
"""The mark for a renamed variable. Sources do not contain this character."""
_Mask = Callable[[str], str]
_COUNTERS = frozenset({"0", "1"})
"""Numbers that also change with the form of a statement, such as in ``i + 1``."""
_COMPARISONS = frozenset({"<", "<=", ">", ">=", "==", "!="})
_MAX_EXPRESSIONS = 120
"""The maximum number of characters of two expressions that are shown in full."""
_MAX_COMPARED_PAIRS = 4_000_000
"""The maximum number of pairs of statements of a compared function."""
_DECLARATION = re.compile(r"declare_parameter\(\s*(?:name\s*=\s*)?[\"']([^\"']+)[\"']")
_DESCRIPTOR_TYPE = re.compile(r"(?:\w+\.)*ParameterDescriptor\(type=[\w.]+\)|(?:\w+\.)*Parameter\.Type\.\w+")
_OPTION_SEPARATOR = re.compile(r"(?<=[\w-]),(?=[\w-])")
"""The comma between the names of an option, such as ``frame,f``."""


def find_value_changes(old_path: Path, new_path: Path, reported: Sequence[str]) -> Iterator[tuple[Phrase, Span]]:
    """Yield the functions in which only literals differ.

    Each comes with the location of its first difference.

    Args:
        old_path: the old source.
        new_path: the new source.
        reported: the other lines about the source. Differences in these lines are left out.
    """
    old_source, new_source = try_read_source(old_path), try_read_source(new_path)
    if old_source is None or new_source is None:
        return
    is_cpp = new_path.suffix in CPP_SUFFIXES
    try:
        old, new = (
            read_cpp_statements(source.text) if is_cpp else read_python_statements(source.text)
            for source in (old_source, new_source)
        )
    except (ValueError, SyntaxError, RecursionError):
        return
    masks = _make_mask(new), _make_mask(old)
    for name, statements in new.items():
        items = [
            item
            for pair in _pair_statements(old.get(name, []), statements, masks)
            for item in (
                find_literal_differences(*pair)
                if _have_same_shape(*pair, masks)
                else _find_value_change(*pair, is_cpp=is_cpp)
            )
            if not _is_reported(item, reported) and not _is_renamed(item, old_source.text, new_source.text)
        ]
        if items:
            texts = joined_first(dict.fromkeys(item.text for item in items), MAX_NAMES)
            text = phrase("values in {name}: {values}", name=name, values=texts)
            if not name:
                text = phrase("values: {values}", values=texts)
            yield text, new_source.span(items[0].token.start, items[0].token.end)


def _make_mask(other: Mapping[str, Sequence[Statement]]) -> _Mask:
    """Return a function that replaces the names of variables which another version lacks in a shape.

    A shape whose value has no other name is returned unchanged: a new constant is not a renamed one.
    """
    known = {token.text for statements in other.values() for statement in statements for token in statement.tokens}

    def mask(shape: str) -> str:
        masked = _VARIABLE.sub(lambda match: match[0] if match[0] in known else _NAME_MARK, shape)
        return masked if _WORD.search(masked.rpartition(" = ")[2]) else shape

    return mask


def _have_same_shape(old: Statement, new: Statement, masks: tuple[_Mask, _Mask]) -> bool:
    """Return whether two statements differ only in literals and names of variables that the other version lacks."""
    return old.shape == new.shape or masks[0](old.shape) == masks[1](new.shape)


def _pair_statements(
    old: Sequence[Statement], new: Sequence[Statement], masks: tuple[_Mask, _Mask]
) -> Iterator[tuple[Statement, Statement]]:
    """Yield pairs of statements of a function that differ only in literals and renamed variables, or are similar.

    Between equal statements, the statements of the same shape are paired if both versions have the
    same number. So are the remaining statements. If only the number of all statements is equal, the others are paired
    by their order.
    """
    if len(old) * len(new) > _MAX_COMPARED_PAIRS:
        return
    matcher = SequenceMatcher(
        None, [statement.key for statement in old], [statement.key for statement in new], autojunk=False
    )
    for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        if tag != "replace":
            continue
        before, after = old[old_start:old_end], new[new_start:new_end]
        equal_shapes = {item.shape for item in before} & {item.shape for item in after}
        keys = [
            [item.shape if item.shape in equal_shapes else mask(item.shape) for item in items]
            for items, mask in zip((before, after), masks, strict=True)
        ]
        unpaired = (
            [item for item, key in zip(before, keys[0], strict=True) if key not in keys[1]],
            [item for item, key in zip(after, keys[1], strict=True) if key not in keys[0]],
        )
        if len(unpaired[0]) == len(unpaired[1]):
            yield from zip(*unpaired, strict=True)
        else:
            yield from pair_by_call(*unpaired)
        if len(unpaired[0]) != len(unpaired[1]) and len(before) != len(after):
            yield from _pair_by_argument(unpaired[0], after)
        settled = {key for key in keys[1] if keys[0].count(key) == keys[1].count(key)}
        if len(before) == len(after) and len(unpaired[0]) != len(unpaired[1]):  # statement by statement
            for old_item, new_item, *own in zip(before, after, *keys, strict=True):
                if not settled.issuperset(own) and (own[0] != own[1] or _are_versions(old_item, new_item)):
                    yield old_item, new_item
        for key in dict.fromkeys(keys[1]):
            same = [
                [item for item, own in zip(items, own_keys, strict=True) if own == key]
                for items, own_keys in zip((before, after), keys, strict=True)
            ]
            pairs = list(zip(*same, strict=False))
            if len(same[0]) == len(same[1]) and not _are_reordered(pairs):
                yield from (pair for pair in pairs if _are_versions(*pair))


def _pair_by_argument(old: Sequence[Statement], new: Sequence[Statement]) -> Iterator[tuple[Statement, Statement]]:
    """Yield pairs of statements that differ only in an argument, each with the first such statement."""
    remaining = list(new)
    for statement in old:
        match = next((other for other in remaining if any(find_argument_difference(statement, other))), None)
        if match is not None:
            remaining.remove(match)
            yield statement, match


def _find_value_change(old: Statement, new: Statement, *, is_cpp: bool) -> Iterator[Difference]:
    """Yield the assigned expression, the operator, or else the number that differs between two statements.

    Of sources in Python, an argument that differs is yielded, too.
    """
    differences = [*find_expression_difference(old, new)] or [*find_operator_change(old, new)]
    differences = differences or [*_find_number_change(old, new)]
    yield from differences or ([] if is_cpp else find_argument_difference(old, new))


def _find_number_change(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the number that differs between two statements.

    The statements also differ in other ways. If several numbers differ, nothing is yielded.
    """
    numbers = [
        [token for token in statement.tokens if token.kind is TokenKind.NUMBER and token.text not in _COUNTERS]
        for statement in (old, new)
    ]
    texts = [[token.text for token in tokens] for tokens in numbers]
    pairs = {(before, after) for before, after in zip(*texts, strict=False) if not _is_same_number(before, after)}
    if len(texts[0]) != len(texts[1]) or len(pairs) != 1:
        return
    ((before, after),) = pairs
    if not any(_are_in_same_place(old.tokens, new.tokens, *pair) for pair in pairs):
        return
    operators = _find_index(old.tokens, before) - 1, _find_index(new.tokens, after) - 1
    compared = {
        statement.tokens[index].text for statement, index in zip((old, new), operators, strict=True) if index >= 0
    }
    if len(compared) > 1 and compared <= _COMPARISONS:
        yield describe_operator(old, new, operators)  # the numbers alone do not show the condition
        return
    old_words, new_words = (
        [token.text for token in statement.tokens if token.kind is not TokenKind.NUMBER] for statement in (old, new)
    )
    if SequenceMatcher(None, old_words, new_words, autojunk=False).ratio() >= _MIN_SIMILARITY:
        token = next(token for token in numbers[1] if token.text == after)
        factors = [_find_expression_around(statement, text) for statement, text in ((old, before), (new, after))]
        if len({_count_factors(old.tokens, factors[0]), _count_factors(new.tokens, factors[1])}) == 1:
            yield Difference(f"{before} -> {after}", before, after, token)
            return
        # the number became part of another product, so that the numbers alone do not show the value
        shown = old.get_text(*factors[0]), new.get_text(*factors[1])
        if sum(map(len, shown)) <= _MAX_EXPRESSIONS:
            expression = add_context(new, *factors[1], " -> ".join(shown), match_brackets(new.tokens))
            yield Difference(expression, *shown, new.tokens[factors[1][0]])


def _find_expression_around(statement: Statement, number: str) -> tuple[int, int]:
    """Return the first and last token of the expression around a number."""
    index = next(index for index, token in enumerate(statement.tokens) if token.text == number)
    return find_expression(statement.tokens, Literal(number, index, index), match_brackets(statement.tokens))


def _count_factors(tokens: Sequence[Token], expression: tuple[int, int]) -> int:
    """Return the number of products and quotients in an expression."""
    first, last = expression
    return sum(token.kind is TokenKind.OPERATOR and token.text in ("*", "/") for token in tokens[first : last + 1])


def _are_in_same_place(old: Sequence[Token], new: Sequence[Token], before: str, after: str) -> bool:
    """Return whether two numbers follow the same token or comparison, so that one can replace the other."""
    places = []
    for tokens, text in ((old, before), (new, after)):
        index = _find_index(tokens, text)
        places.append(tokens[index - 1].text if index else "")
    return places[0] == places[1] or _COMPARISONS.issuperset(places)


def _find_index(tokens: Sequence[Token], text: str) -> int:
    """Return the index of the first token with a text."""
    return next(index for index, token in enumerate(tokens) if token.text == text)


def _is_same_number(old: str, new: str) -> bool:
    """Return whether two numbers have the same value and kind, such as ``0x0B`` and ``0x0b``."""
    return normalize_number(old, is_divided=True) == normalize_number(new, is_divided=True)


def _find_changed_literals(old: Statement, new: Statement) -> list[tuple[Literal, Literal]]:
    return [pair for pair in zip(old.literals, new.literals, strict=True) if pair[0].differs_from(pair[1])]


def _are_reordered(pairs: Sequence[tuple[Statement, Statement]]) -> bool:
    """Return whether a text only moves from one literal to another."""
    changed = [pair for statements in pairs for pair in _find_changed_literals(*statements)]
    removed, added = ({pair[side].value for pair in changed if pair[side].is_text} for side in (0, 1))
    return not removed.isdisjoint(added)


def _are_versions(old: Statement, new: Statement) -> bool:
    """Return whether two statements of the same shape are probably versions of one statement."""
    changed = _find_changed_literals(old, new)
    has_texts = any(literal.is_text for pair in changed for literal in pair)
    return bool(changed) and (len(old.literals) == 1 or not has_texts or 2 * len(changed) <= len(old.literals))


def _is_reported(item: Difference, reported: Sequence[str]) -> bool:
    """Return whether other lines already report the replacement of a literal."""
    old, new = (_F_STRING.sub("", text).strip("\"'") for text in (item.old, item.new))
    if _is_declared_type(item, reported):
        return True
    for line in reported:
        before, arrow, after = line.partition(" -> ")
        if arrow and all(not text or _has_value(side, text) for side, text in ((before, old), (after, new))):
            return True
        if all(text and re.search(rf"= {re.escape(text)}(?![\w.])", line) for text in (item.old, item.new)):
            return True  # a removed and an added constant
        if _is_text(item.old) != _is_text(item.new) and all(text and _has_word(line, text) for text in (old, new)):
            return True  # a name that is computed now, or no longer
    if item.new.endswith(("]", ")", "}")):
        texts = set(_QUOTED.findall(item.old)) ^ set(_QUOTED.findall(item.new))
        words = [text[1:-1].rpartition(":=")[2] for text in texts]  # without the old name of a remapping
        return bool(words) and all(any(_has_word(line, word, "") for line in reported) for word in words)
    # the line may show the name in the namespace of its node handle, such as '~' for a private one, or the namespace,
    # or an option with its dashes, without its letter
    # or other parts of a sum
    names = [max(_OPTION_SEPARATOR.split(text), key=len).lstrip("/") for text in (old, new)]
    patterns = [re.compile(rf"['\"](?:[\w~/<>.]*[~/>]|--?)?{re.escape(name)}(?:/[\w~/]*)?['\"]") for name in names]
    return _is_text(item.new) and all(any(pattern.search(line) for line in reported) for pattern in patterns)


def _is_declared_type(item: Difference, reported: Sequence[str]) -> bool:
    """Return whether a literal is the type of a declared parameter, which another line reports."""
    declaration = _DECLARATION.search(item.text)
    is_type = all(not text or _DESCRIPTOR_TYPE.fullmatch(text) for text in (item.old, item.new))
    return declaration is not None and is_type and any(f" '{declaration[1]}': type " in line for line in reported)


def _is_text(value: str) -> bool:
    return value.endswith(("'", '"'))


def _has_value(line: str, text: str) -> bool:
    """Return whether a line has a text, or the same number, such as ``0.5`` for ``.5``."""
    return _has_word(line, text) or (text.startswith(".") and text[1:].isdigit() and _has_word(line, f"0{text}"))


def _has_word(line: str, word: str, joiner: str = ".") -> bool:
    return re.search(rf"(?<![\w{joiner}]){re.escape(word)}(?![\w.])", line) is not None


def _is_renamed(item: Difference, old_text: str, new_text: str) -> bool:
    """Return whether both literals are the same constant of the source under different names."""
    if re.fullmatch(r"\w+", item.old) is None or re.fullmatch(r"\w+", item.new) is None:
        return False
    return (
        _has_word(_find_defined_names(old_text), item.old)
        and not _has_word(new_text, item.old)
        and (_has_word(_find_defined_names(new_text), item.new) and not _has_word(old_text, item.new))
    )


def _find_defined_names(text: str) -> str:
    """Return the names of the constants that a source defines."""
    return " ".join(match[1] or match[2] for match in _DEFINITION.finditer(text))
