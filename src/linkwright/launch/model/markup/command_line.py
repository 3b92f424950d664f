"""Splitting of command lines with substitutions in XML and YAML launch files."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.places import error_at, reading_markup_at
from linkwright.launch.model.substitution import Substitution, TextSubstitution

_ESCAPED_IN_DOUBLE_QUOTES = '"\\'


def parse_command_line(text: str, parser: Any) -> list[list[Substitution]]:
    """Split a command line into arguments, each a list of substitutions to join.

    Literal spaces, quotes and backslashes have the same meaning as in a shell, but not in the text that a substitution
    produces. A quote may be opened before a substitution and closed after it.

    Raises:
        ValueError: LAUNCH118, a quote is not closed.
    """
    divided = _Words()
    parts: list[Substitution] = parser.parse_substitution(text)
    for part in parts:
        if isinstance(part, TextSubstitution):
            with reading_markup_at(part.place):
                divided.add_text(part.text)
        else:
            divided.add_substitution(part)
    if divided.quote:
        ros_error = ValueError("No closing quotation")
        message = phrase(
            "command '{text}' cannot be split into words: the quote {quote} is not closed",
            text=text,
            quote=divided.quote,
        )
        raise error_at(parts[-1].place, "LAUNCH118", message, ros_error=ros_error)
    divided.end_word()
    return divided.words


class _Words:
    """Splits literal text and substitutions into the arguments of a command."""

    def __init__(self) -> None:
        self.words: list[list[Substitution]] = []
        self.quote = ""
        self._word: list[Substitution] = []
        self._text = ""
        self._began = False

    def add_substitution(self, part: Substitution) -> None:
        """Append a substitution to the current argument."""
        self._end_text()
        self._word.append(part)
        self._began = True

    def add_text(self, text: str) -> None:
        """Add literal text, which may end the current argument and start others."""
        characters = iter(text)
        for character in characters:
            if self.quote == character:
                self.quote = ""
            elif not self.quote and character in "'\"":
                self.quote = character
                self._began = True
            elif not self.quote and character.isspace():
                self.end_word()
            elif character == "\\" and self.quote != "'":
                following = next(characters, "")
                keeps = self.quote and following not in _ESCAPED_IN_DOUBLE_QUOTES
                self._add(character + following if keeps else following)
            else:
                self._add(character)
        self._end_text()

    def end_word(self) -> None:
        """End the current argument, if there is one."""
        self._end_text()
        if self._began:
            self.words.append(self._word or [TextSubstitution(text="")])
        self._word, self._began = [], False

    def _add(self, text: str) -> None:
        self._text += text
        self._began = True

    def _end_text(self) -> None:
        if self._text:
            self._word.append(TextSubstitution(text=self._text))
        self._text = ""
