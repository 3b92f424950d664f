"""Convert phrases to the vocabulary of an engine, and its results to phrases."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, quoted_names

Words = tuple[str, ...]

_LONGEST_WORD = 8
"""Characters of a Chinese word that are looked up as one."""


@dataclass(frozen=True, slots=True)
class Phrasing:
    """Phrases in the vocabulary of an engine.

    Attributes:
        phrases: the phrases as the user wrote them, by the words of the engine.
    """

    phrases: Mapping[Words, str]

    @classmethod
    def of(cls, phrases: Iterable[str], knows: Callable[[str], bool], model: Path | str) -> Phrasing:
        """Convert phrases to an engine's vocabulary.

        A word that the engine does not know is tried in lower case. In a language that is written without spaces, such
        as Chinese, it is also divided into the fewest known words.

        Args:
            phrases: the phrases as the user wrote them.
            knows: returns whether a word is in the engine's vocabulary.
            model: the name of the model, for errors.

        Raises:
            LinkwrightError: VOICE103, the engine does not know some words.
        """
        found: dict[Words, str] = {}
        missing: dict[str, None] = {}
        for text in phrases:
            words: list[str] = []
            for word in text.split():
                known = _known(word, knows)
                if known is None:
                    missing[word] = None
                else:
                    words += known
            if words:
                found.setdefault(tuple(words), text)
        if missing:
            message = phrase("'{model}' does not know {words}", model=model, words=quoted_names(missing))
            hint = phrase("use other words, or the engine 'enrolled', which needs no vocabulary")
            raise LinkwrightError(Diagnostic("VOICE103", message, hint=hint))
        return cls(found)

    def divided(self, words: Sequence[str]) -> list[tuple[str, int, int]] | None:
        """Split recognised words into the fewest phrases.

        Returns:
            Each phrase with the indices of its first word and of the word after its last; None if the words are not a
            sequence of phrases.
        """
        longest = max(map(len, self.phrases), default=0)
        best: list[list[tuple[str, int, int]] | None] = [[]]
        for end in range(1, len(words) + 1):
            shortest: list[tuple[str, int, int]] | None = None
            for first in range(max(0, end - longest), end):
                before, found = best[first], self.phrases.get(tuple(words[first:end]))
                if before is None or found is None:
                    continue
                if shortest is None or len(before) + 1 < len(shortest):
                    shortest = [*before, (found, first, end)]
            best.append(shortest)
        return best[-1]


def _known(word: str, knows: Callable[[str], bool]) -> list[str] | None:
    """Return the words of a vocabulary that make up a word, or None."""
    for spelling in (word, word.lower()):
        if knows(spelling):
            return [spelling]
    if word.isascii():
        return None
    best: list[list[str] | None] = [[]]
    for end in range(1, len(word) + 1):
        shortest: list[str] | None = None
        for first in range(max(0, end - _LONGEST_WORD), end):
            before, part = best[first], word[first:end]
            if before is not None and (shortest is None or len(before) + 1 < len(shortest)) and knows(part):
                shortest = [*before, part]
        best.append(shortest)
    return best[-1]
