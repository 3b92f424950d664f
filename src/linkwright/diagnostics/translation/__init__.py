"""Diagnostics in the reader's language: which one it is, and the catalogues of texts.

Messages are written in English where they are found. A catalogue maps the English templates of each code to another
language; what it does not know stays English. Codes, places and the user's own words are never touched.
"""

from linkwright.diagnostics.translation.language import LANGUAGES, asked_language, language, language_of, set_language
from linkwright.diagnostics.translation.translate import labels, localized, said_in, translate, translated

__all__ = [
    "LANGUAGES",
    "asked_language",
    "labels",
    "language",
    "language_of",
    "localized",
    "said_in",
    "set_language",
    "translate",
    "translated",
]
