r"""Parser for substitutions in text: ``$(name argument ...)``.

Arguments may contain quotes, escapes and nested substitutions. The rules are those of ``launch.frontend``. A backslash
escapes the next character. Spaces separate arguments, and an argument with spaces is written in single or double
quotes. Inside quotes, the same kind of quote needs a backslash, and the arguments of a substitution are not quoted.
"""

from __future__ import annotations

import re
from typing import Any, NoReturn

from linkwright.diagnostics import Phrase, did_you_mean, phrase
from linkwright.launch.errors.places import MarkupPlace, Place, error_at, reading_markup_at
from linkwright.launch.frontend.instantiate import instantiate_substitution
from linkwright.launch.model.markup.entity import place_of
from linkwright.launch.model.markup.expose import substitution_parse_methods
from linkwright.launch.model.substitution import Substitution, TextSubstitution

_NAME = re.compile(r"[A-Za-z][\w-]*")
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_BLANK = " \t\r\n"
_UNQUOTED_END = frozenset(_BLANK + "()")


def replace_escaped_characters(data: str) -> str:
    """Return the text with backslash escapes resolved."""
    return _ESCAPED.sub(r"\1", data)


def parse_substitution(string_value: str) -> list[Substitution]:
    """Parse a text into a list of substitutions.

    Raises:
        ValueError: LAUNCH119, the text cannot be parsed.
        RuntimeError: LAUNCH119, there is no such substitution.
    """
    if not string_value:
        return [TextSubstitution(text=string_value)]
    return _Reader(string_value, place_of(string_value)).template()


def parse_if_substitutions(value: Any) -> Any:
    """Parse the substitutions in the strings of a value.

    Strings without substitutions stay strings.

    Raises:
        ValueError: a list has plain values of several types.
    """
    if not isinstance(value, list):
        return _parse_if(value)
    parsed = [_parse_if(item) for item in value]
    if len({str if isinstance(item, str) else type(item) for item in parsed if not isinstance(item, list)}) > 1:
        raise ValueError("The result is a non-uniform list")
    return parsed


def _parse_if(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    parts = parse_substitution(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


class _Reader:
    """Parses one text into substitutions."""

    def __init__(self, text: str, place: Place | None) -> None:
        self._text = text
        self._at = 0
        self._place = place

    def template(self) -> list[Substitution]:
        """Parse the entire text."""
        parts = self._parts(until="", argument=False)
        assert self._at == len(self._text)
        return parts

    def _parts(self, until: str, argument: bool) -> list[Substitution]:
        """Parse text and substitutions up to a closing character.

        Args:
            until: the closing quote, which is not consumed; empty outside quotes.
            argument: whether the parts form an unquoted argument, which a space or a parenthesis also ends.
        """
        parts: list[Substitution] = []
        start = self._at
        while self._at < len(self._text):
            character = self._text[self._at]
            if character == until or (argument and character in _UNQUOTED_END):
                break
            if self._text.startswith("$(", self._at):
                self._add_text(parts, start)
                parts.append(self._substitution(until))
                start = self._at
            elif argument and not until and character in "'\"":
                before = repr(self._text[start : self._at])
                message = phrase("there is a quote inside the argument {before}", before=before)
                self._fail(message, phrase("quote the whole argument"))
            else:
                self._at += 2 if character == "\\" and self._at + 1 < len(self._text) else 1
        self._add_text(parts, start)
        return parts

    def _add_text(self, parts: list[Substitution], start: int) -> None:
        if start < self._at:
            with reading_markup_at(self._part(start, self._at)):
                parts.append(TextSubstitution(text=replace_escaped_characters(self._text[start : self._at])))

    def _substitution(self, quote: str) -> Substitution:
        start = self._at
        self._at += 2
        name = _NAME.match(self._text, self._at)
        if name is None:
            self._fail(phrase("there is no name after '$('"), phrase("write \\$( for the literal characters"))
        self._at = name.end()
        arguments = []
        while True:
            blank = self._skip_blanks()
            if self._at >= len(self._text) or self._text[self._at] == quote:
                end, self._at = self._at, start
                message = phrase("'{text}' has no closing parenthesis", text=self._text[start:end])
                self._fail(message, phrase("end it with ')'"))
            if self._text[self._at] == ")":
                break
            if not blank:
                self._unexpected(name[0])
            arguments.append(self._argument(quote))
        self._at += 1
        return instantiate_substitution(name[0], arguments, self._part(start, self._at))

    def _argument(self, quote: str) -> list[Substitution]:
        opening = self._text[self._at]
        if quote or opening not in "'\"":
            start = self._at
            parts = self._parts(until=quote, argument=True)
            if self._at == start:
                self._fail(
                    phrase("there is an opening parenthesis in an argument"),
                    phrase(r"put quotes around it, or write \("),
                )
            return parts
        start = self._at
        self._at += 1
        parts = self._parts(until=opening, argument=False)
        if self._at >= len(self._text):
            self._at = start
            self._fail(
                phrase("the quote {opening} is not closed", opening=opening),
                phrase("close it, or write \\{opening} for the character", opening=opening),
            )
        self._at += 1
        return parts

    def _skip_blanks(self) -> bool:
        start = self._at
        while self._at < len(self._text) and self._text[self._at] in _BLANK:
            self._at += 1
        return self._at > start

    def _unexpected(self, name: str) -> NoReturn:
        character = self._text[self._at]
        hint = None if name in substitution_parse_methods else did_you_mean(name, substitution_parse_methods)
        if character == "(":
            hint = hint or phrase(r"put quotes around it, or write \(")
        self._fail(
            phrase("there is {character} after '{text}'", character=repr(character), text=self._text[: self._at][-20:]),
            hint or phrase("separate arguments by spaces"),
        )

    def _part(self, start: int, end: int) -> Place | None:
        return self._place.part(start, end) if isinstance(self._place, MarkupPlace) else self._place

    def _fail(self, message: Phrase, hint: Phrase) -> NoReturn:
        place = self._part(self._at, self._at + 1)
        text = phrase("substitution in '{text}' cannot be parsed: {message}", text=self._text, message=message)
        raise error_at(place, "LAUNCH119", text, hint, ros_error=ValueError(text))
