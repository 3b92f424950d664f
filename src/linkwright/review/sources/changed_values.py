"""The literals that differ between two versions of a source: numbers, texts and constants in equal statements."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.cpp_statements import cpp_statements
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.python_statements import python_statements
from linkwright.review.sources.reading import readable_source
from linkwright.review.sources.statements import Difference, Literal, Statement, differences
from linkwright.review.sources.tokens import TokenKind

_DEFINITION = re.compile(r"\b([A-Z]\w+)(?=\s*(?:=(?!=)|[{\[,]))|define\s+(\w+)")
_QUOTED = re.compile("\"[^\"]*\"|'[^']*'")
_ALIKE = 0.6
"""The ratio of equal tokens from which two statements with other tokens are versions of one statement."""
_COUNTERS = frozenset({"0", "1"})
"""Numbers that also change with the form of a statement, such as in ``i + 1``."""
_MAX_COMPARED = 4_000_000
"""The number of pairs of statements up to which the statements of a function are compared."""


def value_changes(old_path: Path, new_path: Path, told: Sequence[str]) -> Iterator[tuple[Phrase, Span]]:
    """Yield the functions with statements in which only literals differ, each with the place of the first one.

    Args:
        old_path: the old source.
        new_path: the new source.
        told: the other lines about the source. Differences that these lines tell are left out.
    """
    old_source, new_source = readable_source(old_path), readable_source(new_path)
    if old_source is None or new_source is None:
        return
    is_cpp = new_path.suffix in CPP_SUFFIXES
    try:
        old, new = (
            cpp_statements(each.text) if is_cpp else python_statements(each) for each in (old_source, new_source)
        )
    except (ValueError, SyntaxError, RecursionError):
        return
    for name, statements in new.items():
        items = [
            item
            for pair in _pairs(old.get(name, []), statements)
            for item in (differences(*pair) if pair[0].shape == pair[1].shape else _number_change(*pair))
            if not _is_told(item, told) and not _is_renamed(item, old_source.text, new_source.text)
        ]
        if items:
            texts = joined_first(dict.fromkeys(item.text for item in items), MAX_NAMES)
            text = phrase("values in {name}: {values}", name=name, values=texts)
            if not name:
                text = phrase("values: {values}", values=texts)
            yield text, new_source.span(items[0].token.start, items[0].token.end)


def _pairs(old: Sequence[Statement], new: Sequence[Statement]) -> Iterator[tuple[Statement, Statement]]:
    """Yield the statements of a function in which only literals differ, and those that are alike.

    Between two equal statements, the statements of one shape are pairs if both versions have equally many, and so are
    the others.
    """
    if len(old) * len(new) > _MAX_COMPARED:
        return
    matcher = SequenceMatcher(
        None, [statement.key for statement in old], [statement.key for statement in new], autojunk=False
    )
    for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        if tag != "replace":
            continue
        shapes = dict.fromkeys(statement.shape for statement in new[new_start:new_end])
        old_shapes = {statement.shape for statement in old[old_start:old_end]}
        lone = (
            [statement for statement in old[old_start:old_end] if statement.shape not in shapes],
            [statement for statement in new[new_start:new_end] if statement.shape not in old_shapes],
        )
        if len(lone[0]) == len(lone[1]):
            yield from zip(*lone, strict=True)
        for shape in shapes:
            before = [statement for statement in old[old_start:old_end] if statement.shape == shape]
            after = [statement for statement in new[new_start:new_end] if statement.shape == shape]
            pairs = list(zip(before, after, strict=False))
            if len(before) == len(after) and not _are_reordered(pairs):
                yield from (pair for pair in pairs if _is_same(*pair))


def _number_change(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the number that is another one in a statement that also differs in another way, if it is the only one."""
    numbers = [
        [token for token in each.tokens if token.kind is TokenKind.NUMBER and token.text not in _COUNTERS]
        for each in (old, new)
    ]
    texts = [[token.text for token in each] for each in numbers]
    pairs = {(before, after) for before, after in zip(*texts, strict=False) if before != after}
    if len(texts[0]) != len(texts[1]) or len(pairs) != 1:
        return
    ((before, after),) = pairs
    old_words, new_words = (
        [token.text for token in each.tokens if token.kind is not TokenKind.NUMBER] for each in (old, new)
    )
    if SequenceMatcher(None, old_words, new_words, autojunk=False).ratio() >= _ALIKE:
        token = next(token for token in numbers[1] if token.text == after)
        yield Difference(f"{before} -> {after}", before, after, token)


def _changed(old: Statement, new: Statement) -> list[tuple[Literal, Literal]]:
    return [pair for pair in zip(old.literals, new.literals, strict=True) if pair[0].differs_from(pair[1])]


def _are_reordered(pairs: Sequence[tuple[Statement, Statement]]) -> bool:
    """Return whether one literal loses a text and another literal gains it."""
    changed = [pair for statements in pairs for pair in _changed(*statements)]
    gone, come = ({pair[side].value for pair in changed if pair[side].is_text} for side in (0, 1))
    return not gone.isdisjoint(come)


def _is_same(old: Statement, new: Statement) -> bool:
    """Return whether two statements of one shape are probably the same one, with other literals."""
    changed = _changed(old, new)
    has_texts = any(literal.is_text for pair in changed for literal in pair)
    return bool(changed) and (len(old.literals) == 1 or not has_texts or 2 * len(changed) <= len(old.literals))


def _is_told(item: Difference, told: Sequence[str]) -> bool:
    """Return whether other lines already tell that a literal is replaced by another one."""
    old, new = (text.strip("\"'") for text in (item.old, item.new))
    for line in told:
        before, arrow, after = line.partition(" -> ")
        if arrow and _has_word(before, old) and _has_word(after, new):
            return True
    if item.new.endswith(("]", ")", "}")):
        texts = set(_QUOTED.findall(item.old)) ^ set(_QUOTED.findall(item.new))
        return bool(texts) and all(any(_has_word(line, text[1:-1], "") for line in told) for text in texts)
    is_text = item.new.endswith(("'", '"'))
    return is_text and all(any(f"'{text}'" in line for line in told) for text in (old, new))


def _has_word(line: str, word: str, joiner: str = ".") -> bool:
    return re.search(rf"(?<![\w{joiner}]){re.escape(word)}(?![\w.])", line) is not None


def _is_renamed(item: Difference, old_text: str, new_text: str) -> bool:
    """Return whether both literals are one constant of the source, under another name."""
    if re.fullmatch(r"\w+", item.old) is None or re.fullmatch(r"\w+", item.new) is None:
        return False
    return (
        _has_word(_defined(old_text), item.old)
        and not _has_word(new_text, item.old)
        and (_has_word(_defined(new_text), item.new) and not _has_word(old_text, item.new))
    )


def _defined(text: str) -> str:
    """Return the names of the constants that a source defines."""
    return " ".join(match[1] or match[2] for match in _DEFINITION.finditer(text))
