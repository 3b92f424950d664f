"""``--lang``, which every command takes, and the help of commands in the reader's language."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from linkwright.diagnostics.phrase import TERMS
from linkwright.diagnostics.translation import LANGUAGES, language, language_of, set_language
from linkwright.diagnostics.translation.wording import wording

LANGUAGE_HELP = "the language of messages: zh for Chinese, en for English (default: that of the environment)"

_OPTION = "--lang"


class UnknownLanguageError(Exception):
    """``--lang`` with no language, or with one that messages are not known in."""


def take_language(words: Sequence[str]) -> list[str]:
    """The words without ``--lang LANGUAGE``, which may stand anywhere before ``--``; the language is set.

    Raises:
        UnknownLanguageError: with what is wrong with it.
    """
    left: list[str] = []
    asked: str | None = None
    pending = iter(words)
    for word in pending:
        name, sign, value = word.partition("=")
        if name == _OPTION:
            asked = _language(value if sign else next(pending, ""))
        else:
            left.append(word)
        if word == "--":
            left += pending
    set_language(asked)
    return left


def _language(written: str) -> str:
    found = language_of(written)
    if found is None:
        what = f"there is no language '{written}'" if written else f"'{_OPTION}' needs a language"
        raise UnknownLanguageError(f"{what}; messages are in {' and '.join(LANGUAGES)}")
    return found


def said_in_help(text: str) -> str:
    """A help text in the reader's language; one that the catalogue does not know stays as it is."""
    lang = language()
    if lang == "en" or not text:
        return text
    words = wording(lang)
    found = words.gettext(text)
    return words.pgettext(TERMS, text) if found == text else found


# The name by which argparse asks for words of its own, such as "the following arguments are required". It is gettext's,
# which looks for catalogues that there are none of, and loads `locale` for that.
argparse._ = said_in_help  # type: ignore[attr-defined]  # argparse imports it so


def translate_help(parser: argparse.ArgumentParser) -> None:
    """Put the texts of a parser, and of the parsers below it, into the reader's language."""
    if language() != "en":
        _translate(parser)


def _translate(parser: argparse.ArgumentParser) -> None:
    parser.description = said_in_help(parser.description or "")
    for group in parser._action_groups:
        group.title = said_in_help(group.title or "")
    for action in parser._actions:
        if action.help and action.help != argparse.SUPPRESS:
            action.help = said_in_help(action.help)
        if isinstance(action, argparse._SubParsersAction):
            for choice in action._choices_actions:
                choice.help = said_in_help(choice.help or "")
            for below in action.choices.values():
                _translate(below)
