"""The catalogs of translations, and the choice of the language."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import cache

from linkwright.diagnostics.diagnostic import Diagnostic, Note
from linkwright.diagnostics.phrase import Catalog, Phrase, term
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gettext import NullTranslations


ENGLISH, CHINESE = "en", "zh"
TAGS = {ENGLISH: "en", CHINESE: "zh-CN"}
"""The languages of messages, each with its tag in web pages: English and simplified Chinese."""

LANGUAGES = tuple(TAGS)

_LANGUAGE_VARIABLES = ("LINKWRIGHT_LANG", "LC_ALL", "LC_MESSAGES", "LANG")
"""The environment variables for the language. The first variable that is set is used. POSIX orders the last three."""

_chosen_language: str | None = None


def set_language(code: str | None) -> None:
    """Set the language of messages, one of `LANGUAGES`, for the rest of the process.

    None selects the language of the environment.
    """
    global _chosen_language  # noqa: PLW0603 - the language is one for the whole process, as the locale is
    if code is not None and code not in LANGUAGES:
        raise ValueError(f"there is no language '{code}'; the languages are {', '.join(LANGUAGES)}")
    _chosen_language = code


def chosen_language() -> str | None:
    """Return the language that was set with `set_language`, or None.

    Output for programs is in English unless a language was set.
    """
    return _chosen_language


def language() -> str:
    """Return the language of messages for people, one of `LANGUAGES`."""
    if _chosen_language is not None:
        return _chosen_language
    for name in _LANGUAGE_VARIABLES:
        value = os.environ.get(name)
        if value:
            return language_of(value) or ENGLISH
    return ENGLISH


def language_of(locale: str) -> str | None:
    """Return the language of messages for a locale such as ``zh_CN.UTF-8``.

    The result is None if there are no messages in the locale's language. Any Chinese locale selects simplified Chinese,
    because there is no other catalog for Chinese.
    """
    name = locale.strip().replace("-", "_").partition(".")[0].partition("_")[0].casefold()
    return name if name in LANGUAGES else None


@cache
def load_catalog(language: str) -> NullTranslations:
    """Return the catalog of a language.

    The catalog is read only once. It is empty if there is no compiled catalog, as in a fresh checkout.
    """
    from gettext import GNUTranslations, NullTranslations  # imported here, because English does not need it

    try:
        with open(f"{os.path.dirname(__file__)}/{language}.mo", "rb") as file:  # noqa: PTH120, PTH123 - pathlib is slow to import
            return GNUTranslations(file)
    except FileNotFoundError:
        return NullTranslations()


_LABELS = ("error", "warning", "info", "note", "hint", ": ")


def labels(lang: str | None = None) -> Mapping[str, str]:
    """Return the labels for severities, notes and hints, and the colon that follows them.

    The labels are in the language `lang`, one of `LANGUAGES`, or by default in the user's language.
    """
    lang = language() if lang is None else lang
    return {label: label if lang == "en" else term(label).translated_text(load_catalog(lang)) for label in _LABELS}


def translated(diagnostics: Iterable[Diagnostic], *, for_programs: bool = False) -> Iterable[Diagnostic]:
    """Return diagnostics in the language of their reader.

    Args:
        diagnostics: the diagnostics in English, as they are created.
        for_programs: whether a program reads them. A program gets English unless another language was requested by
            name.
    """
    lang = (chosen_language() or "en") if for_programs else language()
    return diagnostics if lang == "en" else [translate(diagnostic, lang) for diagnostic in diagnostics]


def translate(diagnostic: Diagnostic, lang: str) -> Diagnostic:
    """Return a diagnostic with its texts in a language of `LANGUAGES`.

    Texts without a translation stay English.
    """
    if lang == "en":
        return diagnostic
    catalog = load_catalog(lang)
    return diagnostic.with_changes(
        message=_translate_text(diagnostic.message, catalog),
        notes=tuple(Note(_translate_text(note.message, catalog), note.span) for note in diagnostic.notes),
        hint=_translate_text(diagnostic.hint, catalog) if diagnostic.hint else diagnostic.hint,
    )


def localized(text: str, lang: str | None = None) -> str:
    """Return a text in a language of `LANGUAGES`, by default the user's language.

    A plain string is returned unchanged.
    """
    lang = language() if lang is None else lang
    return text.translated_text(load_catalog(lang)) if lang != ENGLISH and isinstance(text, Phrase) else text


def translate_phrase(text: Phrase, lang: str) -> str:
    """Return the text of a phrase in a language of `LANGUAGES`, whatever language it is in."""
    return text.translated_text(load_catalog(lang))


def _translate_text(text: Phrase, catalog: Catalog) -> Phrase:
    return text.translated(catalog) if isinstance(text, Phrase) else text
