"""Diagnostics in the user's language.

The package chooses the language, and has the catalogues of texts. Messages are written in English where they are
reported. A catalogue maps the English templates of each code to another language; a template that is missing from it
stays English. Codes, places and the user's own words never change.
"""

from linkwright.diagnostics.translation.translate import (
    CHINESE,
    ENGLISH,
    LANGUAGES,
    TAGS,
    asked_language,
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
    "asked_language",
    "labels",
    "language",
    "language_of",
    "localized",
    "set_language",
    "translate",
    "translate_phrase",
    "translated",
]
