"""The option ``--lang`` of every command, and the translation of help texts."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics.phrase import TERMS
from linkwright.diagnostics.translation import LANGUAGES, language, language_of, set_language
from linkwright.diagnostics.translation.translate import load_catalog

LANGUAGE_HELP = "the language of messages: zh for Chinese, en for English (default: the language of the environment)"

_OPTION = "--lang"


class UnknownLanguageError(Exception):
    """Raised when ``--lang`` has no value, or names a language without a translation."""


def take_language(words: Sequence[str]) -> list[str]:
    """Apply the option ``--lang LANGUAGE``, and return the arguments without it.

    The option is accepted anywhere before ``--``.

    Raises:
        UnknownLanguageError: there is no translation into this language.
    """
    remaining_arguments: list[str] = []
    requested: str | None = None
    argument_iterator = iter(words)
    for argument in argument_iterator:
        name, separator, value = argument.partition("=")
        if name == _OPTION:
            requested = _parse_language(value if separator else next(argument_iterator, ""))
        else:
            remaining_arguments.append(argument)
        if argument == "--":
            remaining_arguments += argument_iterator
    set_language(requested)
    return remaining_arguments


def _parse_language(text: str) -> str:
    code = language_of(text)
    if code is None:
        problem = f"there is no language '{text}'" if text else f"'{_OPTION}' needs a language"
        raise UnknownLanguageError(f"{problem}; messages are in {' and '.join(LANGUAGES)}")
    return code


def translate_help(text: str) -> str:
    """Return a help text in the user's language, or unchanged if it has no translation."""
    lang = language()
    if lang == "en" or not text:
        return text
    catalog = load_catalog(lang)
    translation = catalog.gettext(text)
    return catalog.pgettext(TERMS, text) if translation == text else translation
