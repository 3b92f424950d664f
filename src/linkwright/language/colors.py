"""The colors in an XML text: URDF's ``rgba``, and the colors of SDF materials and lights."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.xmltree.tokens import Kind, tokens

_COLOR_TAGS = frozenset({"ambient", "diffuse", "specular", "emissive", "background", "grid_color"})
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_COLOR = re.compile(rf"\s*({_NUMBER})\s+({_NUMBER})\s+({_NUMBER})(?:\s+({_NUMBER}))?\s*")


class ColorLiteral(NamedTuple):
    """A color in a text.

    Attributes:
        start: the character offset of the first number.
        end: the offset after the last number.
        rgba: red, green, blue and alpha, from 0 to 1.
    """

    start: int
    end: int
    rgba: tuple[float, float, float, float]


def colors_in(text: str) -> Iterator[ColorLiteral]:
    """Yield the colors that consist of plain numbers from 0 to 1, in text order."""
    tag = ""
    for token in tokens(text):
        if token.kind is Kind.START:
            tag = token.name
            for attribute in token.attributes():
                if attribute.name in ("rgba", "rgb"):
                    yield from _parse_color(attribute.value or "", attribute.value_start)
        elif token.kind is Kind.TEXT and tag in _COLOR_TAGS:
            yield from _parse_color(token.text, token.start)


def format_color(rgba: tuple[float, float, float, float], *, with_alpha: bool) -> str:
    """Return the numbers of a color in the notation of descriptions, separated by spaces."""
    return " ".join(f"{value:.4g}" for value in rgba[: 4 if with_alpha else 3])


def _parse_color(value: str, start: int) -> Iterator[ColorLiteral]:
    match = _COLOR.fullmatch(value)
    if match is None:
        return
    red, green, blue, alpha = (float(number) for number in (*match.groups()[:3], match[4] or 1))
    if all(0 <= part <= 1 for part in (red, green, blue, alpha)):
        yield ColorLiteral(start + match.start(1), start + match.end(4 if match[4] else 3), (red, green, blue, alpha))
