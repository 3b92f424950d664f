"""Translate diagnostics to the user's language.

The package chooses the language, and contains the catalogs of texts. Messages are written in English where they are
reported. A catalog maps their English templates to another language; a template that is not in it stays English.
Codes, positions and names from the user's input never change.
"""

from linkwright.diagnostics.translation.translate import (
    CHINESE,
    ENGLISH,
    LANGUAGES,
    TAGS,
    chosen_language,
    labels,
    language,
    language_of,
    localized,
    set_language,
    translate,
    translate_phrase,
    translated,
)

__all__ = [
    "CHINESE",
    "ENGLISH",
    "LANGUAGES",
    "TAGS",
    "chosen_language",
    "labels",
    "language",
    "language_of",
    "localized",
    "set_language",
    "translate",
    "translate_phrase",
    "translated",
]
