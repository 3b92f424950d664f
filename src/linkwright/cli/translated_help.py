"""The help of commands in the reader's language: what they say of themselves, and argparse's own words."""

from __future__ import annotations

import argparse
import gettext

from linkwright.diagnostics.phrase import TERMS
from linkwright.diagnostics.translation import language
from linkwright.diagnostics.translation.wording import wording


def said_in_help(text: str) -> str:
    """A help text in the reader's language; one that the catalogue does not know stays as it is."""
    lang = language()
    if lang == "en" or not text:
        return text
    words = wording(lang)
    found = words.gettext(text)
    return words.pgettext(TERMS, text) if found == text else found


def translate_help(parser: argparse.ArgumentParser) -> None:
    """Put the texts of a parser, and of the parsers below it, into the reader's language."""
    english = language() == "en"
    # The name by which argparse asks gettext for words of its own, such as "the following arguments are required".
    argparse._ = gettext.gettext if english else said_in_help  # type: ignore[attr-defined]  # gettext's, which argparse imports so
    if not english:
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
