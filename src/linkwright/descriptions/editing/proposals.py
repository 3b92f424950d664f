"""The candidates for editing a number of an attribute, starting with the most likely one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.descriptions.editing.definitions import Definitions
from linkwright.descriptions.editing.numbers import shortest
from linkwright.descriptions.editing.places import (
    Candidate,
    Place,
    added_constants,
    addition_candidate,
    is_constant,
    literal,
    replacement_candidate,
    words,
)
from linkwright.xacro.faults import Frame

_DEEPEST = 8


def proposals(
    place: Place,
    index: int,
    frame: Frame | None,
    definitions: Definitions,
    *,
    present: Sequence[float],
    is_angle: bool,
) -> Iterator[Candidate]:
    """Yield the candidates for editing one number of an attribute, the most likely first.

    Args:
        place: the range of the attribute's text.
        index: the index of the number.
        frame: the macro call in which the attribute is evaluated.
        definitions: the definitions of named values.
        present: the current numbers of the attribute.
        is_angle: whether the numbers are angles.
    """
    reached = list(_reached(place, index, frame, definitions))
    for word in reached:
        yield from _numbers_in(word, present[index])
    for word in reached:
        yield from definitions.given(word.text, index, frame)
    for word in reached:
        found = addition_candidate(word, is_angle=is_angle)
        if found is not None:
            yield found
    own = words(place)
    if len(own) == len(present):
        yield replacement_candidate(own[index], present[index])
    elif len(own) == 1:
        yield _whole(place, index, present)


def _reached(place: Place, index: int, frame: Frame | None, definitions: Definitions) -> Iterator[Place]:
    """Yield the ranges of the words that determine a number.

    These are the word in the attribute itself, then the words in the definitions of its names, recursively.
    """
    seen: set[tuple[str, int]] = set()
    pending: list[tuple[Place, int]] = [(place, 0)]
    while pending:
        text, depth = pending.pop(0)
        if (text.source.name, text.start) in seen:
            continue
        seen.add((text.source.name, text.start))
        found = words(text)
        if len(found) > 1:
            found = found[index : index + 1] if len(found) in (3, 4) else []
        for word in found:
            yield word
            if "$" in word.text and depth < _DEEPEST:
                pending.extend((of_name, depth + 1) for of_name in definitions.of_names(word.text, frame))


def _numbers_in(word: Place, value: float) -> Iterator[Candidate]:
    """Yield candidates for the literal numbers in a word."""
    known = literal(word)
    if known is not None:
        yield known
        return
    found = list(added_constants(word))
    if is_constant(word) and (not found or ("pi" in word.text and "180" not in word.text)):
        found = [replacement_candidate(word, value)]
    yield from found


def _whole(place: Place, index: int, present: Sequence[float]) -> Candidate:
    """Return a candidate that replaces a single expression with all numbers of the attribute."""

    def write(number: float, tolerance: float) -> str:
        return " ".join(
            shortest(number, tolerance) if i == index else shortest(each, 0.0) for i, each in enumerate(present)
        )

    return Candidate(place, present[index], write)
