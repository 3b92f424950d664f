"""Parsing default values and constants of interface files."""

from __future__ import annotations

import math
import re
from typing import cast

from linkwright.diagnostics import phrase
from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, FieldType, Primitive

Value = bool | int | float | str | bytes

_ITEM = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,]*?)\s*(?:,|$)""")
_ESCAPE = re.compile(r"\\(.)")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0", "\\": "\\", '"': '"', "'": "'"}


class LiteralFault(Exception):  # noqa: N818 - not an error of the program; the parser turns it into a diagnostic
    """A text is not a value of the type; the argument is the reason."""


def read_default(text: str, kind: FieldType) -> object:
    """Parse the default value of a field's line: one value, or a tuple of them.

    Raises:
        LiteralFault: the text is not a value of the type.
    """
    primitive = kind.primitive
    if primitive is None:
        raise LiteralFault(phrase("a field of type '{spelled}' cannot have a default value", spelled=kind.spelled()))
    if kind.container is Container.ONE:
        return _read_bounded(text, kind, primitive)
    if not (text.startswith("[") and text.endswith("]")):
        raise LiteralFault(phrase("the default of '{spelled}' is a list in square brackets", spelled=kind.spelled()))
    values = tuple(_read_bounded(item, kind, primitive) for item in split_list(text[1:-1]))
    if kind.container is Container.ARRAY and len(values) != kind.size:
        raise LiteralFault(
            phrase(
                "'{spelled}' takes {size} values, not {count}",
                spelled=kind.spelled(),
                size=kind.size,
                count=len(values),
            )
        )
    if kind.container is Container.SEQUENCE and kind.size is not None and len(values) > kind.size:
        raise LiteralFault(
            phrase(
                "'{spelled}' takes at most {size} values, not {count}",
                spelled=kind.spelled(),
                size=kind.size,
                count=len(values),
            )
        )
    return values


def read_constant(text: str, type_name: str) -> Value:
    """Parse the value of a constant.

    Raises:
        LiteralFault: the text is not a value of the type.
    """
    return _read(text, type_name, PRIMITIVES[type_name])


def split_list(text: str) -> list[str]:
    """The items of a list, at its commas; those inside of quotes do not count."""
    items: list[str] = []
    at = 0
    while at < len(text):
        match = _ITEM.match(text, at)
        if match is None:  # an unclosed quote: the rest is one item
            items.append(text[at:].strip())
            break
        items.append(match.group(1))
        at = match.end()
    if items and not items[-1] and len(items) > 1:  # a comma at the end
        items.pop()
    return items


def _read_bounded(text: str, kind: FieldType, primitive: Primitive) -> Value:
    value = _read(text, kind.base, primitive)
    if kind.string_bound is not None and len(cast(str, value)) > kind.string_bound:
        raise LiteralFault(phrase("the text is longer than {string_bound} characters", string_bound=kind.string_bound))
    return value


def _read(text: str, type_name: str, primitive: Primitive) -> Value:
    if primitive.python is str:
        return _read_text(text)
    if primitive.python is bool:
        return _read_bool(text)
    if primitive.python is float:
        return _read_float(text, type_name, primitive)
    number = _read_int(text)
    low, high = (0, 255) if primitive.python is bytes else (primitive.low, primitive.high)
    if not low <= number <= high:
        raise LiteralFault(
            phrase(
                "{text} is outside of {type_name}'s range, which is {low} to {high}",
                text=text,
                type_name=type_name,
                low=low,
                high=high,
            )
        )
    return bytes([number]) if primitive.python is bytes else number


def _read_bool(text: str) -> bool:
    word = text.lower()
    if word in {"true", "1"}:
        return True
    if word in {"false", "0"}:
        return False
    raise LiteralFault(phrase("'{text}' is neither true nor false", text=text))


def _read_int(text: str) -> int:
    digits = text.lstrip("+-")
    try:
        return int(text, 0 if digits[:1] == "0" and digits[1:2] in {"x", "X", "o", "O", "b", "B"} else 10)
    except ValueError:
        raise LiteralFault(phrase("'{text}' is not an integer", text=text)) from None


def _read_float(text: str, type_name: str, primitive: Primitive) -> float:
    try:
        number = float(text)
    except ValueError:
        raise LiteralFault(phrase("'{text}' is not a number", text=text)) from None
    if math.isfinite(number) and abs(number) > primitive.high:
        raise LiteralFault(phrase("{text} is outside of {type_name}'s range", text=text, type_name=type_name))
    return number


def _read_text(text: str) -> str:
    quote = text[:1]
    if quote not in {'"', "'"}:
        return text
    if len(text) < 2 or not text.endswith(quote) or _closes_early(text, quote):
        raise LiteralFault(phrase("the text that begins with {quote} does not end with it", quote=quote))
    return _ESCAPE.sub(lambda match: _ESCAPES.get(match.group(1), match.group(0)), text[1:-1])


def _closes_early(text: str, quote: str) -> bool:
    inside = re.sub(r"\\.", "  ", text[1:-1])
    return quote in inside or inside.endswith("\\")
