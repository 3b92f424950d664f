"""Split command lines with substitutions in XML and YAML launch files."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at, reading_markup_at
from linkwright.launch.model.substitution import Substitution, TextSubstitution

_ESCAPED_IN_DOUBLE_QUOTES = '"\\'


def parse_command_line(text: str, parser: Any) -> list[list[Substitution]]:
    """Return the arguments of a command line, each as a list of substitutions to join.

    Spaces, quotes and backslashes in literal text have the same meaning as in a shell. In the text that a substitution
    produces, they have no special meaning. A quote may be opened before a substitution and closed after it.

    Raises:
        ValueError: LAUNCH118, a quote is not closed.
    """
    splitter = _ArgumentSplitter()
    substitutions: list[Substitution] = parser.parse_substitution(text)
    for substitution in substitutions:
        if isinstance(substitution, TextSubstitution):
            with reading_markup_at(substitution.source_location):
                splitter.add_text(substitution.text)
        else:
            splitter.add_substitution(substitution)
    if splitter.quote:
        ros_error = ValueError("No closing quotation")
        message = phrase(
            "command '{text}' cannot be split into arguments, because the quote {quote} is not closed",
            text=text,
            quote=splitter.quote,
        )
        raise error_at(substitutions[-1].source_location, "LAUNCH118", message, ros_error=ros_error)
    splitter.end_argument()
    return splitter.arguments


class _ArgumentSplitter:
    """A splitter of literal text and substitutions into the arguments of a command.

    Attributes:
        arguments: the finished arguments, each as a list of substitutions.
        quote: the open quote; empty if no quote is open.
    """

    def __init__(self) -> None:
        self.arguments: list[list[Substitution]] = []
        self.quote = ""
        self._argument: list[Substitution] = []
        self._text = ""
        self._has_begun = False

    def add_substitution(self, substitution: Substitution) -> None:
        """Append a substitution to the current argument."""
        self._end_text()
        self._argument.append(substitution)
        self._has_begun = True

    def add_text(self, text: str) -> None:
        """Add literal text.

        The text may end the current argument and start others.
        """
        characters = iter(text)
        for character in characters:
            if self.quote == character:
                self.quote = ""
            elif not self.quote and character in "'\"":
                self.quote = character
                self._has_begun = True
            elif not self.quote and character.isspace():
                self.end_argument()
            elif character == "\\" and self.quote != "'":
                next_character = next(characters, "")
                keeps_backslash = self.quote and next_character not in _ESCAPED_IN_DOUBLE_QUOTES
                self._add(character + next_character if keeps_backslash else next_character)
            else:
                self._add(character)
        self._end_text()

    def end_argument(self) -> None:
        """End the current argument, if there is one."""
        self._end_text()
        if self._has_begun:
            self.arguments.append(self._argument or [TextSubstitution(text="")])
        self._argument, self._has_begun = [], False

    def _add(self, text: str) -> None:
        self._text += text
        self._has_begun = True

    def _end_text(self) -> None:
        if self._text:
            self._argument.append(TextSubstitution(text=self._text))
        self._text = ""
