"""Texts of lessons in one or more languages."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import LANGUAGES, translate_phrase


class LocalText:
    """A text in one or more languages.

    Attributes:
        texts: the text by language, at least one, such as ``{"en": "Save the file.", "zh": "保存文件。"}``.

    Raises:
        ValueError: there is no text, or a language is unknown.
    """

    def __init__(self, texts: Mapping[str, str]) -> None:
        unknown = sorted(set(texts) - set(LANGUAGES))
        if unknown:
            raise ValueError(f"there is no language '{unknown[0]}'; the languages are {', '.join(LANGUAGES)}")
        if not texts:
            raise ValueError(f"the text is missing; give it in one of the languages {', '.join(LANGUAGES)}")
        self.texts = dict(texts)

    @classmethod
    def from_phrase(cls, phrase: Phrase) -> LocalText:
        """Return a phrase of Linkwright's catalog in all languages."""
        return cls({language: translate_phrase(phrase, language) for language in LANGUAGES})

    def get(self, language: str) -> str:
        """Return the text in a language, or else in the first available language."""
        return self.texts.get(language) or next(iter(self.texts.values()))

    def __str__(self) -> str:
        return self.get(LANGUAGES[0])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, LocalText) and self.texts == other.texts

    def __hash__(self) -> int:
        return hash(tuple(sorted(self.texts.items())))

    def __repr__(self) -> str:
        return f"LocalText({self.texts!r})"
