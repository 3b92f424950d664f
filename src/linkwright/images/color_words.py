"""Colors in class names, such as ``red_ball``."""

from __future__ import annotations

import re

RGB_BY_COLOR_WORD: dict[str, tuple[int, int, int]] = {
    "red": (225, 35, 40),
    "orange": (255, 140, 0),
    "yellow": (245, 215, 25),
    "green": (40, 175, 70),
    "cyan": (40, 205, 225),
    "blue": (45, 100, 240),
    "purple": (150, 70, 215),
    "pink": (240, 105, 185),
    "brown": (145, 85, 45),
    "white": (245, 245, 245),
    "grey": (145, 145, 145),
    "black": (30, 30, 30),
}
"""The red, green and blue, 0 to 255, of the colors that have a name."""

COLOR_WORD_SPELLINGS = {**{word: word for word in RGB_BY_COLOR_WORD}, "gray": "grey", "violet": "purple"}
"""The English words for colors, each with its name in `RGB_BY_COLOR_WORD`."""


def split_into_words(name: str) -> list[str]:
    """Return the words of a class name, in lower case."""
    return [word for word in re.split(r"[\s_\-]+", name.lower()) if word]


def find_color_word(name: str) -> str | None:
    """Return the color word in a class name, one of `RGB_BY_COLOR_WORD`, or None."""
    return next((COLOR_WORD_SPELLINGS[word] for word in split_into_words(name) if word in COLOR_WORD_SPELLINGS), None)


def find_rgb(name: str) -> tuple[int, int, int] | None:
    """Return red, green and blue, 0 to 255, of the color in a class name.

    Return None if the name contains no color.
    """
    color = find_color_word(name)
    return None if color is None else RGB_BY_COLOR_WORD[color]
