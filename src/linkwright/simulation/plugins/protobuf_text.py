"""The text format of protobuf, such as ``linear: {x: 3}``.

Descriptions for gz contain messages in this format.

Source: the specification of the text format (https://protobuf.dev/reference/protobuf/textformat-spec/).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from linkwright.messages import get_message
from linkwright.messages.field_values import set_fields
from linkwright.messages.message import Message

_TOKEN_PATTERN = re.compile(
    r"""\s+|\#[^\n]*|(?P<text>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')|(?P<word>[-+.\w]+)|(?P<mark>[:{}<>\[\],;])"""
)
_INTEGER_PATTERN = re.compile(r"[-+]?\d+")
_CLOSING_BRACKETS = {"{": "}", "<": ">"}
_KEYWORDS = {"true": True, "false": False}

Fields = dict[str, list[Any]]
"""The values of each field, in the order of the text; a field that occurs once has one value."""


class TextFormatError(ValueError):
    """Raised when a text is not in the text format."""


def parse_fields(text: str) -> Fields:
    """Return the values of the fields in a text.

    Values are strings, numbers, bools, and nested fields.

    Raises:
        TextFormatError: the text is not in the text format.
    """
    return _Parser(text).parse_fields_until("")


def message_from_fields(type_name: str, fields: Fields) -> Message:
    """Return a message of a ROS type from the values of its fields.

    Raises:
        FieldValueError: a field does not exist, or a value is not valid for it.
    """
    message: Message = get_message(type_name)()
    set_fields(message, _to_plain_values(message, fields))
    return message


def is_sequence(value: Any) -> bool:
    """Return whether the value of a field is a sequence, a repeated field in protobuf."""
    return not isinstance(value, (str, bytes, Message)) and (isinstance(value, Sequence) or hasattr(value, "__len__"))


def _to_plain_values(message: Any, fields: Fields) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, items in fields.items():
        default = getattr(message, name, None)
        plain_items = [_to_plain_values(default, item) if isinstance(item, dict) else item for item in items]
        values[name] = plain_items if is_sequence(default) else plain_items[-1]
    return values


class _Parser:
    """A parser of a text.

    Args:
        text: the text to parse.
    """

    def __init__(self, text: str) -> None:
        self._tokens: list[tuple[str, str]] = []
        position = 0
        while position < len(text):
            match = _TOKEN_PATTERN.match(text, position)
            if match is None:
                raise TextFormatError(text)
            if match.lastgroup is not None:
                self._tokens.append((match.lastgroup, match.group()))
            position = match.end()
        self._tokens.append(("end", ""))
        self._tokens.reverse()

    def parse_fields_until(self, end: str) -> Fields:
        """Parse fields up to a token."""
        fields: Fields = {}
        while self._tokens[-1][1] != end:
            kind, name = self._take_token()
            if kind != "word":
                raise TextFormatError(name)
            if self._tokens[-1][1] == ":":
                self._take_token()
            elif self._tokens[-1][1] not in _CLOSING_BRACKETS:
                raise TextFormatError(name)
            fields.setdefault(name, []).extend(self._parse_values())
            if self._tokens[-1][1] in (",", ";"):
                self._take_token()
        self._take_token()
        return fields

    def _take_token(self) -> tuple[str, str]:
        """Take the next token; the end of the text remains, so that every loop meets it."""
        return self._tokens.pop() if len(self._tokens) > 1 else self._tokens[0]

    def _parse_values(self) -> list[Any]:
        """Parse a value, or a list of values in brackets."""
        if self._tokens[-1][1] != "[":
            return [self._parse_value()]
        self._take_token()
        values = []
        while self._tokens[-1][1] != "]":
            values.append(self._parse_value())
            if self._tokens[-1][1] == ",":
                self._take_token()
        self._take_token()
        return values

    def _parse_value(self) -> Any:
        kind, text = self._take_token()
        if kind == "text":
            return re.sub(r"\\(.)", r"\1", text[1:-1])
        if text in _CLOSING_BRACKETS:
            return self.parse_fields_until(_CLOSING_BRACKETS[text])
        if kind != "word":
            raise TextFormatError(text)
        if text in _KEYWORDS:
            return _KEYWORDS[text]
        if _INTEGER_PATTERN.fullmatch(text):
            return int(text)
        try:
            return float(text)
        except ValueError:
            return text
