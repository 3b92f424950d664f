"""The candidates for editing a number of an attribute, the most likely first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.descriptions.editing.definitions import Definitions
from linkwright.descriptions.editing.numbers import shortest_text
from linkwright.descriptions.editing.text_ranges import (
    Candidate,
    TextRange,
    added_constants,
    addition_candidate,
    is_constant,
    literal,
    replacement_candidate,
    words,
)
from linkwright.xacro.faults import Frame

_MAX_DEPTH = 8


def proposals(
    text_range: TextRange,
    index: int,
    frame: Frame | None,
    definitions: Definitions,
    *,
    present: Sequence[float],
    is_angle: bool,
) -> Iterator[Candidate]:
    """Yield the candidates for editing one number of an attribute, the most likely first.

    Args:
        text_range: the range of the attribute's text.
        index: the index of the number.
        frame: the macro call in which the attribute is evaluated.
        definitions: the definitions of named values.
        present: the current numbers of the attribute.
        is_angle: whether the numbers are angles.
    """
    determining_words = list(_find_determining_words(text_range, index, frame, definitions))
    for word in determining_words:
        yield from _numbers_in(word, present[index])
    for word in determining_words:
        yield from definitions.addable_arguments(word.text, index, frame)
    for word in determining_words:
        candidate = addition_candidate(word, is_angle=is_angle)
        if candidate is not None:
            yield candidate
    attribute_words = words(text_range)
    if len(attribute_words) == len(present):
        yield replacement_candidate(attribute_words[index], present[index])
    elif len(attribute_words) == 1:
        yield _make_whole_candidate(text_range, index, present)


def _find_determining_words(
    text_range: TextRange, index: int, frame: Frame | None, definitions: Definitions
) -> Iterator[TextRange]:
    """Yield the ranges of the words that determine a number.

    These are the word in the attribute itself, then the words in the definitions of its names, recursively.
    """
    visited: set[tuple[str, int]] = set()
    pending: list[tuple[TextRange, int]] = [(text_range, 0)]
    while pending:
        text, depth = pending.pop(0)
        if (text.source.name, text.start) in visited:
            continue
        visited.add((text.source.name, text.start))
        text_words = words(text)
        if len(text_words) > 1:
            text_words = text_words[index : index + 1] if len(text_words) in (3, 4) else []
        for word in text_words:
            yield word
            if "$" in word.text and depth < _MAX_DEPTH:
                pending.extend((definition, depth + 1) for definition in definitions.of_names(word.text, frame))


def _numbers_in(word: TextRange, value: float) -> Iterator[Candidate]:
    """Yield candidates for the literal numbers in a word."""
    literal_number = literal(word)
    if literal_number is not None:
        yield literal_number
        return
    candidates = list(added_constants(word))
    if is_constant(word) and (not candidates or ("pi" in word.text and "180" not in word.text)):
        candidates = [replacement_candidate(word, value)]
    yield from candidates


def _make_whole_candidate(text_range: TextRange, index: int, present: Sequence[float]) -> Candidate:
    """Return a candidate that replaces a single expression with all numbers of the attribute."""

    def write(number: float, tolerance: float) -> str:
        return " ".join(
            shortest_text(number, tolerance) if i == index else shortest_text(current_number, 0.0)
            for i, current_number in enumerate(present)
        )

    return Candidate(text_range, present[index], write)
