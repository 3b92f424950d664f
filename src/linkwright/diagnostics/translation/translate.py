"""A diagnostic in another language."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from linkwright.diagnostics.diagnostic import Diagnostic, Note
from linkwright.diagnostics.translation.language import asked_language, language

if TYPE_CHECKING:
    from linkwright.diagnostics.translation.catalogue import Catalogue

_LABELS = {
    "en": {"error": "error", "warning": "warning", "info": "info", "note": "note", "hint": "hint", ":": ": "},
    "zh": {"error": "错误", "warning": "警告", "info": "信息", "note": "注意", "hint": "提示", ":": "："},
}


def labels(lang: str | None = None) -> Mapping[str, str]:
    """What a severity, ``note``, ``hint`` and the colon after them are called; in the reader's language if not told."""
    return _LABELS[language() if lang is None else lang]


def translated(diagnostics: Iterable[Diagnostic], *, for_programs: bool = False) -> Iterable[Diagnostic]:
    """The diagnostics in the reader's language.

    Args:
        diagnostics: in English, as they are made.
        for_programs: a program reads them; it gets English unless another language was asked for by name.
    """
    lang = (asked_language() or "en") if for_programs else language()
    return diagnostics if lang == "en" else [translate(each, lang) for each in diagnostics]


def translate(diagnostic: Diagnostic, lang: str) -> Diagnostic:
    """The diagnostic with its message, notes and hint in a language of `LANGUAGES`; texts not known stay English."""
    if lang == "en":
        return diagnostic
    from linkwright.diagnostics.translation.catalogue import catalogue  # here: most runs are in English

    return translate_with(catalogue(lang), diagnostic)


def localized(line: str) -> str:
    """A line about what a command does or has done, in the reader's language; one that is not known stays English."""
    lang = language()
    if lang == "en":
        return line
    from linkwright.diagnostics.translation.catalogue import catalogue

    return catalogue(lang).text(line, "status_lines")


def translate_with(texts: Catalogue, diagnostic: Diagnostic) -> Diagnostic:
    """The diagnostic in the language of a catalogue."""
    code, hint = diagnostic.code, diagnostic.hint
    return replace(
        diagnostic,
        message=texts.text(diagnostic.message, code, "messages"),
        notes=tuple(Note(texts.text(note.message, code, "notes"), note.span) for note in diagnostic.notes),
        hint=texts.text(hint, code, "hints") if hint else hint,
    )
