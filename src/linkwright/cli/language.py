"""The option ``--lang`` of every command, and the translation of help texts."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics.phrase import TERMS
from linkwright.diagnostics.translation import LANGUAGES, language, language_of, set_language
from linkwright.diagnostics.translation.translate import wording

LANGUAGE_HELP = "the language of messages: zh for Chinese, en for English (default: that of the environment)"

_OPTION = "--lang"


class UnknownLanguageError(Exception):
    """Raised when ``--lang`` has no value, or names a language without a translation."""


def take_language(words: Sequence[str]) -> list[str]:
    """Apply the option ``--lang LANGUAGE``, and return the arguments without it.

    The option is accepted anywhere before ``--``.

    Raises:
        UnknownLanguageError: there is no translation into this language.
    """
    left: list[str] = []
    requested: str | None = None
    pending = iter(words)
    for word in pending:
        name, sign, value = word.partition("=")
        if name == _OPTION:
            requested = _language(value if sign else next(pending, ""))
        else:
            left.append(word)
        if word == "--":
            left += pending
    set_language(requested)
    return left


def _language(written: str) -> str:
    found = language_of(written)
    if found is None:
        what = f"there is no language '{written}'" if written else f"'{_OPTION}' needs a language"
        raise UnknownLanguageError(f"{what}; messages are in {' and '.join(LANGUAGES)}")
    return found


def translate_help(text: str) -> str:
    """Return a help text in the user's language, or unchanged if the catalogue does not contain it."""
    lang = language()
    if lang == "en" or not text:
        return text
    words = wording(lang)
    found = words.gettext(text)
    return words.pgettext(TERMS, text) if found == text else found
