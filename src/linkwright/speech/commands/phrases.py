"""Phrases with slots: ``turn left {angle}``, ``[go|drive] to [the] {place}``.

Words in brackets are optional; a bar separates alternatives.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from linkwright.diagnostics import phrase
from linkwright.speech.commands.quantities import SAYABLE, quantity
from linkwright.speech.commands.words import Words, words_of

Value = float | str
"""The value of a slot: a quantity in metres, radians, seconds or metres a second, or a name of the file."""

Names = Mapping[str, Mapping[Words, str]]
"""Slot of names -> spoken form -> the name."""

_OPTIONAL = re.compile(r"\[([^\[\]{}]*)\]")
_SLOT = re.compile(r"\{(\w*)\}")
_MANY_OPTIONAL = 6


class TemplateError(ValueError):
    """Raised when a phrase is malformed; its text, a `Phrase`, gives the reason."""


@dataclass(frozen=True, slots=True)
class Template:
    """A phrase whose brackets are expanded.

    Attributes:
        text: the text in the file.
        pieces: the literal words before, between and after the slots; one more than there are slots.
        slots: the slots in their order.
    """

    text: str
    pieces: tuple[Words, ...]
    slots: tuple[str, ...]

    @property
    def literal_count(self) -> int:
        """The number of words that are not slots."""
        return sum(map(len, self.pieces))

    def values(self, words: Words, names: Names) -> dict[str, Value] | None:
        """Return the values of the slots, or None if the words do not match."""
        return self._rest(words, 0, names)

    def spoken(self, values: Mapping[str, Sequence[str]]) -> Iterator[str]:
        """Yield all phrases of the template, with all values of its slots.

        Args:
            values: the possible values by slot.
        """
        for chosen in product(*(values.get(slot, ()) for slot in self.slots)):
            text = self.text
            for slot, value in zip(self.slots, chosen, strict=True):
                text = text.replace(f"{{{slot}}}", value)
            yield text

    def _rest(self, words: Words, at: int, names: Names) -> dict[str, Value] | None:
        piece = self.pieces[at]
        if words[: len(piece)] != piece:
            return None
        words = words[len(piece) :]
        if at == len(self.slots):
            return None if words else {}
        slot = self.slots[at]
        for end in range(len(words), 0, -1):
            value = names[slot].get(words[:end]) if slot in names else quantity(slot, words[:end])
            if value is None:
                continue
            rest = self._rest(words[end:], at + 1, names)
            if rest is not None:
                return {slot: value, **rest}
        return None


def templates(text: str, slots: Sequence[str]) -> list[Template]:
    """Expand the brackets of a phrase into templates.

    Args:
        text: the phrase in the file.
        slots: the slots that exist in addition to those for quantities.

    Raises:
        TemplateError: a bracket is not closed, a slot occurs twice or is unknown, or no literal word is left.
    """
    if len(_OPTIONAL.findall(text)) > _MANY_OPTIONAL:
        raise TemplateError(phrase("it has more than {most} parts in brackets", most=_MANY_OPTIONAL))
    found = []
    for plain in _without_brackets(text):
        if re.search(r"[\[\]{}]", _SLOT.sub("", plain)):
            raise TemplateError(phrase("a bracket or brace is not closed, or is nested in another one"))
        used = tuple(_SLOT.findall(plain))
        for slot in used:
            if slot not in SAYABLE and slot not in slots:
                known = ", ".join([*SAYABLE, *slots])
                raise TemplateError(phrase("there is no slot '{slot}'; the slots are {known}", slot=slot, known=known))
        if len(set(used)) < len(used):
            raise TemplateError(phrase("a slot occurs twice"))
        pieces = tuple(words_of(piece) for piece in _SLOT.split(plain)[::2])
        if not any(pieces):
            raise TemplateError(phrase("it needs a word outside the slots"))
        found.append(Template(" ".join(plain.split()), pieces, used))
    return found


def _without_brackets(text: str) -> list[str]:
    match = _OPTIONAL.search(text)
    if match is None:
        return [text]
    before, after = text[: match.start()], _without_brackets(text[match.end() :])
    return [before + alternative + rest for alternative in (*match[1].split("|"), "") for rest in after]
