r"""Parser for substitutions in text: ``$(name argument ...)``.

Arguments may contain quotes, escapes and nested substitutions. The rules are those of ``launch.frontend``. A backslash
escapes the next character. Spaces separate arguments, and an argument with spaces is written in single or double
quotes. Inside quotes, the same kind of quote needs a backslash, and the arguments of a substitution are not quoted.
"""

from __future__ import annotations

import re
from typing import Any, NoReturn

from linkwright.diagnostics import Phrase, did_you_mean, phrase
from linkwright.launch.errors.locations import MarkupLocation, SourceLocation, error_at, reading_markup_at
from linkwright.launch.frontend.instantiate import instantiate_substitution
from linkwright.launch.model.markup.entity import location_of
from linkwright.launch.model.markup.expose import substitution_parse_methods
from linkwright.launch.model.substitution import Substitution, TextSubstitution

_NAME = re.compile(r"[A-Za-z][\w-]*")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_BLANKS = " \t\r\n"
_ARGUMENT_ENDS = frozenset(_BLANKS + "()")


def replace_escaped_characters(data: str) -> str:
    """Return the text with backslash escapes resolved."""
    return _ESCAPE.sub(r"\1", data)


def parse_substitution(string_value: str) -> list[Substitution]:
    """Parse a text into a list of substitutions.

    Raises:
        ValueError: LAUNCH119, the text cannot be parsed.
        RuntimeError: LAUNCH119, there is no such substitution.
    """
    if not string_value:
        return [TextSubstitution(text=string_value)]
    return _TextParser(string_value, location_of(string_value)).parse_template()


def parse_if_substitutions(value: Any) -> Any:
    """Return a value with the substitutions in its strings parsed.

    Strings without substitutions are unchanged.

    Raises:
        ValueError: the items of a list have different types.
    """
    if not isinstance(value, list):
        return _parse_item(value)
    parsed_items = [_parse_item(item) for item in value]
    if len({str if isinstance(item, str) else type(item) for item in parsed_items if not isinstance(item, list)}) > 1:
        raise ValueError("The result is a non-uniform list")
    return parsed_items


def _parse_item(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    substitutions = parse_substitution(value)
    return (
        substitutions[0].text
        if len(substitutions) == 1 and isinstance(substitutions[0], TextSubstitution)
        else substitutions
    )


class _TextParser:
    """A parser of one text into substitutions.

    Args:
        text: the text, which may contain ``$(...)``.
        location: the location of the text, or None.
    """

    def __init__(self, text: str, location: SourceLocation | None) -> None:
        self._text = text
        self._at = 0
        self._location = location

    def parse_template(self) -> list[Substitution]:
        """Parse the entire text, and return its substitutions."""
        substitutions = self._parse_parts(closing_quote="", is_argument=False)
        assert self._at == len(self._text)
        return substitutions

    def _parse_parts(self, closing_quote: str, is_argument: bool) -> list[Substitution]:
        """Parse the text up to a closing character, and return its substitutions.

        Args:
            closing_quote: the closing quote, at which parsing stops; empty outside quotes.
            is_argument: whether the text is an unquoted argument, which a space or a parenthesis also ends.
        """
        substitutions: list[Substitution] = []
        start = self._at
        while self._at < len(self._text):
            character = self._text[self._at]
            if character == closing_quote or (is_argument and character in _ARGUMENT_ENDS):
                break
            if self._text.startswith("$(", self._at):
                self._add_text(substitutions, start)
                substitutions.append(self._parse_substitution(closing_quote))
                start = self._at
            elif is_argument and not closing_quote and character in "'\"":
                preceding_text = repr(self._text[start : self._at])
                message = phrase("there is an unexpected quote in an argument, after {before}", before=preceding_text)
                self._fail(message, phrase("quote the whole argument"))
            else:
                self._at += 2 if character == "\\" and self._at + 1 < len(self._text) else 1
        self._add_text(substitutions, start)
        return substitutions

    def _add_text(self, substitutions: list[Substitution], start: int) -> None:
        if start < self._at:
            with reading_markup_at(self._locate_range(start, self._at)):
                substitutions.append(TextSubstitution(text=replace_escaped_characters(self._text[start : self._at])))

    def _parse_substitution(self, quote: str) -> Substitution:
        start = self._at
        self._at += 2
        match = _NAME.match(self._text, self._at)
        if match is None:
            self._fail(phrase("'$(' is not followed by a name"), phrase("write \\$( for a literal $("))
        self._at = match.end()
        arguments = []
        while True:
            has_blank = self._skip_blanks()
            if self._at >= len(self._text) or self._text[self._at] == quote:
                end, self._at = self._at, start
                message = phrase("'{text}' has no closing parenthesis", text=self._text[start:end])
                self._fail(message, phrase("add ')' at its end"))
            if self._text[self._at] == ")":
                break
            if not has_blank:
                self._unexpected_character_error(match[0])
            arguments.append(self._parse_argument(quote))
        self._at += 1
        return instantiate_substitution(match[0], arguments, self._locate_range(start, self._at))

    def _parse_argument(self, quote: str) -> list[Substitution]:
        opening_quote = self._text[self._at]
        if quote or opening_quote not in "'\"":
            start = self._at
            substitutions = self._parse_parts(closing_quote=quote, is_argument=True)
            if self._at == start:
                self._fail(
                    phrase("an argument contains an opening parenthesis"),
                    phrase(r"put quotes around the argument, or write \("),
                )
            return substitutions
        start = self._at
        self._at += 1
        substitutions = self._parse_parts(closing_quote=opening_quote, is_argument=False)
        if self._at >= len(self._text):
            self._at = start
            self._fail(
                phrase("the quote {opening} is not closed", opening=opening_quote),
                phrase("close it, or write \\{opening} for the character", opening=opening_quote),
            )
        self._at += 1
        return substitutions

    def _skip_blanks(self) -> bool:
        start = self._at
        while self._at < len(self._text) and self._text[self._at] in _BLANKS:
            self._at += 1
        return self._at > start

    def _unexpected_character_error(self, name: str) -> NoReturn:
        character = self._text[self._at]
        hint = None if name in substitution_parse_methods else did_you_mean(name, substitution_parse_methods)
        if character == "(":
            hint = hint or phrase(r"put quotes around the argument, or write \(")
        self._fail(
            phrase(
                "there is an unexpected {character} after '{text}'",
                character=repr(character),
                text=self._text[: self._at][-20:],
            ),
            hint or phrase("separate arguments by spaces"),
        )

    def _locate_range(self, start: int, end: int) -> SourceLocation | None:
        return self._location.part(start, end) if isinstance(self._location, MarkupLocation) else self._location

    def _fail(self, message: Phrase, hint: Phrase) -> NoReturn:
        location = self._locate_range(self._at, self._at + 1)
        text = phrase("substitution in '{text}' cannot be parsed: {message}", text=self._text, message=message)
        raise error_at(location, "LAUNCH119", text, hint, ros_error=ValueError(text))
