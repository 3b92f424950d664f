"""Phrases with slots: ``turn left {angle}``, ``[go|drive] to [the] {place}``.

Words in brackets are optional; a bar separates alternatives.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from linkwright.diagnostics import phrase
from linkwright.speech.commands.quantities import GRAMMAR_VALUES, parse_quantity
from linkwright.speech.commands.words import Words, split_into_words

Value = float | str
"""The value of a slot: a quantity in meters, radians, seconds or meters per second, or a name in the file."""

Names = Mapping[str, Mapping[Words, str]]
"""The names that can fill each slot, by their spoken forms."""

_OPTIONAL_PATTERN = re.compile(r"\[([^\[\]{}]*)\]")
_SLOT_PATTERN = re.compile(r"\{(\w*)\}")
_MAX_OPTIONAL_PARTS = 6


class TemplateError(ValueError):
    """Raised if a phrase is malformed.

    The argument, a `Phrase`, is the reason.
    """


@dataclass(frozen=True, slots=True)
class Template:
    """A phrase with one alternative in place of each bracket.

    Attributes:
        text: the text of the phrase, with its slots in braces.
        pieces: the literal words before, between and after the slots; there is one more piece than there are slots.
        slots: the names of the slots, in order.
    """

    text: str
    pieces: tuple[Words, ...]
    slots: tuple[str, ...]

    @property
    def literal_count(self) -> int:
        """The number of words outside the slots."""
        return sum(map(len, self.pieces))

    def match(self, words: Words, names: Names) -> dict[str, Value] | None:
        """Return the values of the slots, or None if the words do not match."""
        return self._match_from(words, 0, names)

    def expand(self, values: Mapping[str, Sequence[str]]) -> Iterator[str]:
        """Yield the phrases with all combinations of slot values.

        Args:
            values: the possible spoken values of each slot.
        """
        for combination in product(*(values.get(slot, ()) for slot in self.slots)):
            text = self.text
            for slot, value in zip(self.slots, combination, strict=True):
                text = text.replace(f"{{{slot}}}", value)
            yield text

    def _match_from(self, words: Words, slot_index: int, names: Names) -> dict[str, Value] | None:
        literal_words = self.pieces[slot_index]
        if words[: len(literal_words)] != literal_words:
            return None
        words = words[len(literal_words) :]
        if slot_index == len(self.slots):
            return None if words else {}
        slot = self.slots[slot_index]
        for end in range(len(words), 0, -1):
            value = names[slot].get(words[:end]) if slot in names else parse_quantity(slot, words[:end])
            if value is None:
                continue
            remaining_values = self._match_from(words[end:], slot_index + 1, names)
            if remaining_values is not None:
                return {slot: value, **remaining_values}
        return None


def parse_templates(text: str, slots: Sequence[str]) -> list[Template]:
    """Expand the brackets of a phrase into templates.

    Args:
        text: the phrase in the file.
        slots: the slots that are allowed in addition to quantities.

    Raises:
        TemplateError: there are too many brackets, a bracket is not closed, a slot occurs twice or does not exist, or
            there is no literal word.
    """
    if len(_OPTIONAL_PATTERN.findall(text)) > _MAX_OPTIONAL_PARTS:
        raise TemplateError(
            phrase("it has more than {maximum} optional parts in brackets", maximum=_MAX_OPTIONAL_PARTS)
        )
    expanded = []
    for variant in _expand_brackets(text):
        if re.search(r"[\[\]{}]", _SLOT_PATTERN.sub("", variant)):
            raise TemplateError(phrase("a bracket or brace is not closed, or is nested in another one"))
        used_slots = tuple(_SLOT_PATTERN.findall(variant))
        for slot in used_slots:
            if slot not in GRAMMAR_VALUES and slot not in slots:
                known_slots = ", ".join([*GRAMMAR_VALUES, *slots])
                raise TemplateError(
                    phrase("there is no slot '{slot}'; the slots are {known}", slot=slot, known=known_slots)
                )
        if len(set(used_slots)) < len(used_slots):
            raise TemplateError(phrase("a slot occurs twice"))
        pieces = tuple(split_into_words(piece) for piece in _SLOT_PATTERN.split(variant)[::2])
        if not any(pieces):
            raise TemplateError(phrase("it must have a word outside the slots"))
        expanded.append(Template(" ".join(variant.split()), pieces, used_slots))
    return expanded


def _expand_brackets(text: str) -> list[str]:
    match = _OPTIONAL_PATTERN.search(text)
    if match is None:
        return [text]
    prefix, suffixes = text[: match.start()], _expand_brackets(text[match.end() :])
    return [prefix + alternative + suffix for alternative in (*match[1].split("|"), "") for suffix in suffixes]
