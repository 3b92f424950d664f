"""Convert phrases to the vocabulary of an engine, and its results to phrases."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, quoted_names

Words = tuple[str, ...]

_MAX_WORD_LENGTH = 8
"""The maximum length in characters of a Chinese word that is looked up in a vocabulary."""


@dataclass(frozen=True, slots=True)
class Phrasing:
    """Phrases in the vocabulary of an engine.

    Attributes:
        phrases: the phrases as the user wrote them, by their words in the engine's vocabulary.
    """

    phrases: Mapping[Words, str]

    @classmethod
    def of(cls, phrases: Iterable[str], in_vocabulary: Callable[[str], bool], model: Path | str) -> Phrasing:
        """Convert phrases to an engine's vocabulary.

        A word that is not in the vocabulary is tried in lower case. In a language that is written without spaces,
        such as Chinese, it is also divided into the fewest words of the vocabulary.

        Args:
            phrases: the phrases as the user wrote them.
            in_vocabulary: returns whether the engine's vocabulary contains a word.
            model: the name of the model, for errors.

        Raises:
            LinkwrightError: VOICE103, the vocabulary lacks some words.
        """
        converted: dict[Words, str] = {}
        missing: dict[str, None] = {}
        for text in phrases:
            words: list[str] = []
            for word in text.split():
                vocabulary_words = _spell_word(word, in_vocabulary)
                if vocabulary_words is None:
                    missing[word] = None
                else:
                    words += vocabulary_words
            if words:
                converted.setdefault(tuple(words), text)
        if missing:
            message = phrase(
                "the vocabulary of '{model}' does not contain {missing_words}",
                model=model,
                missing_words=quoted_names(missing),
            )
            hint = phrase("use other words, or the engine 'enrolled', which needs no vocabulary")
            raise LinkwrightError(Diagnostic("VOICE103", message, hint=hint))
        return cls(converted)

    def split_into_phrases(self, words: Sequence[str]) -> list[tuple[str, int, int]] | None:
        """Split recognized words into the smallest number of phrases.

        Returns:
            Each phrase with the indices of its first word and of the word after its last; None if the words are not a
            sequence of phrases.
        """
        longest = max(map(len, self.phrases), default=0)
        best_splits: list[list[tuple[str, int, int]] | None] = [[]]
        for end in range(1, len(words) + 1):
            shortest: list[tuple[str, int, int]] | None = None
            for start in range(max(0, end - longest), end):
                previous, phrase_text = best_splits[start], self.phrases.get(tuple(words[start:end]))
                if previous is None or phrase_text is None:
                    continue
                if shortest is None or len(previous) + 1 < len(shortest):
                    shortest = [*previous, (phrase_text, start, end)]
            best_splits.append(shortest)
        return best_splits[-1]


def _spell_word(word: str, in_vocabulary: Callable[[str], bool]) -> list[str] | None:
    """Split a word into the fewest words of a vocabulary, or return None if that is impossible."""
    for spelling in (word, word.lower()):
        if in_vocabulary(spelling):
            return [spelling]
    if word.isascii():
        return None
    best_splits: list[list[str] | None] = [[]]
    for end in range(1, len(word) + 1):
        shortest: list[str] | None = None
        for start in range(max(0, end - _MAX_WORD_LENGTH), end):
            previous, piece = best_splits[start], word[start:end]
            if (
                previous is not None
                and (shortest is None or len(previous) + 1 < len(shortest))
                and in_vocabulary(piece)
            ):
                shortest = [*previous, piece]
        best_splits.append(shortest)
    return best_splits[-1]
