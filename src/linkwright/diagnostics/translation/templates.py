"""Texts with holes: recognising one, and filling another with what was in its holes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence

_LATIN_MEETS_CHINESE = re.compile("[A-Za-z0-9<>)][\u4e00-\u9fff]|[\u4e00-\u9fff][A-Za-z0-9<(]")
_HOLE = re.compile(r"\{(\d*)(?::([A-Za-z0-9]+))?\}")

Convert = Callable[[str, str], str]
"""Turns what was in a hole into the other language: the name of the conversion, and the text."""


class Template:
    """An English text with ``{}`` for each hole, and its form in another language.

    Args:
        english: such as ``there is no macro '{}'``.
        translation: the same with ``{}``, or ``{0}`` and ``{1}`` where the order is another, or ``{:kind}`` and
            ``{1:kind}`` where what is in the hole is translated too.

    Raises:
        ValueError: the translation has holes that the English text has not, or leaves some out unnumbered.
    """

    __slots__ = ("_holes", "_literals", "_parts", "english", "translation", "weight")

    def __init__(self, english: str, translation: str) -> None:
        self.english = english
        self.translation = translation
        self._literals = literals = english.split("{}")
        self.weight = sum(map(len, literals))
        """How many characters are fixed; of two templates that match a text, the one with more says more."""
        holes = list(_HOLE.finditer(translation))
        self._parts = _between(translation, holes)
        self._holes: list[tuple[int, str | None]] = []
        for position, hole in enumerate(holes):
            number = int(hole[1]) if hole[1] else position
            if number >= len(literals) - 1:
                raise ValueError(f"'{translation}' has a hole {number} that '{english}' has not")
            self._holes.append((number, hole[2]))
        numbered = any(hole[1] for hole in holes)
        if not numbered and len(holes) != len(literals) - 1:
            raise ValueError(f"'{translation}' has {len(holes)} holes and '{english}' has {len(literals) - 1}")

    @property
    def conversions(self) -> set[str]:
        """The names of the conversions of its holes."""
        return {name for _, name in self._holes if name}

    def kept(self, values: Sequence[str]) -> list[str]:
        """Those of the values whose words the translation takes over as they are."""
        converted = {number for number, name in self._holes if name and name != "list"}
        return [value for number, value in enumerate(values) if number not in converted]

    def match(self, text: str) -> Sequence[str] | None:
        """What is in the holes of a text of this template, or None when it is no such text; in linear time."""
        if len(self._literals) == 1:
            return [] if text == self.english else None
        first, *middle, last = self._literals
        if not text.startswith(first):
            return None
        values = []
        at = len(first)
        for literal in middle:  # taking each as soon as it comes leaves the most room for the next
            found = text.find(literal, at)
            if found < 0:
                return None
            values.append(text[at:found])
            at = found + len(literal)
        end = len(text) - len(last)
        if end < at or not text.endswith(last):
            return None
        return [*values, text[at:end]]

    def fill(self, values: Sequence[str], convert: Convert) -> str:
        """The translation with these values in its holes."""
        text = self._parts[0]
        for (number, conversion), after in zip(self._holes, self._parts[1:], strict=True):
            value = values[number]
            if conversion:
                text = _spaced(_spaced(text, convert(conversion, value)), after)
            else:
                text += value + after
        return text


class Table:
    """The templates of one code or of one kind of phrase."""

    def __init__(self, pairs: Iterable[tuple[str, str]]) -> None:
        templates = [Template(english, translation) for english, translation in pairs]
        self._exact = {each.english: each for each in templates if "{}" not in each.english}
        self._open = sorted((each for each in templates if "{}" in each.english), key=lambda each: -each.weight)

    def __iter__(self) -> Iterator[Template]:
        yield from self._exact.values()
        yield from self._open

    def find(self, text: str) -> tuple[Template, Sequence[str]] | None:
        """The template of a text, with what is in its holes; the one that fixes most when several match."""
        exact = self._exact.get(text)
        if exact is not None:
            return exact, ()
        for template in self._open:
            values = template.match(text)
            if values is not None:
                return template, values
        return None


def _spaced(left: str, right: str) -> str:
    """Two texts in a row, with a blank between Latin and Chinese letters; the catalogue has it in its own texts."""
    return f"{left} {right}" if _LATIN_MEETS_CHINESE.fullmatch(left[-1:] + right[:1]) else left + right


def _between(text: str, holes: Sequence[re.Match[str]]) -> list[str]:
    ends = [0, *(hole.end() for hole in holes)]
    starts = [*(hole.start() for hole in holes), len(text)]
    return [text[end:start] for end, start in zip(ends, starts, strict=True)]
