"""A stroke font for ASCII characters.

A character outside of ASCII is drawn as an empty box.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from linkwright.geometry.arrays import Array

LINE_HEIGHT = 8.0
"""The height of a line of text in units of the font, from the lowest point of small letters to the top of capitals."""
_LETTER_GAP = 1.8
_SPACE_WIDTH = 2.4

# Lines are separated by spaces; each point is a digit for x and one for y. The baseline of letters is y = 2, small
# letters reach y = 6, and capitals reach y = 8.
_GLYPHS = {
    "!": "0804 0302",
    '"': "0806 2826",
    "#": "1218 3238 0444 0646",
    "$": "4738180706153544433212 0312 2921",
    "%": "0248 08171607 43423233",
    "&": "4205071827260403123244",
    "'": "0806",
    "(": "19070311",
    ")": "09171301",
    "*": "2723 0634 0436",
    "+": "2723 0545",
    ",": "1301",
    "-": "0535",
    ".": "0302",
    "/": "0149",
    "0": "18070312324347381807 0347",
    "1": "062822 1232",
    "2": "0718384746020242",
    "3": "0718384746351535444332120303",
    "4": "3238043444",
    "5": "4808053544433212",
    "6": "381804031232434435150404",
    "7": "084812",
    "8": "1535464738180706150403123243443535",
    "9": "12324647381807061535464646",
    ":": "0605 0302",
    ";": "1615 1301",
    "<": "370533",
    "=": "0646 0444",
    ">": "073503",
    "?": "071838474624 2322",
    "@": "3313141636344447381807031242",
    "A": "022842 0434",
    "B": "0208384746350535444332020202",
    "C": "4738180703123243",
    "D": "08020232434738280808",
    "E": "48080242 0535",
    "F": "480802 0535",
    "G": "473818070312324345 2545",
    "H": "0208 4248 0545",
    "I": "0828 1812 0222",
    "J": "4843321203",
    "K": "0208 4804 1542",
    "L": "080242",
    "M": "0208254842",
    "N": "02084248",
    "O": "18070312324347381818",
    "P": "02083847463505",
    "Q": "18070312324347381818 2441",
    "R": "02083847463505 2542",
    "S": "473818070615354443321203",
    "T": "0848 2822",
    "U": "080312324348",
    "V": "082248",
    "W": "0812253248",
    "X": "0248 0842",
    "Y": "082548 2522",
    "Z": "08480242",
    "[": "19090111",
    "\\": "0941",
    "]": "09191101",
    "^": "062846",
    "_": "0141",
    "`": "0817",
    "a": "0616352504 35323212030414 3435",
    "b": "0802 051626353323120303",
    "c": "3626160503122232",
    "d": "3832 352616050312223333",
    "e": "04343526160503122232",
    "f": "28181712 0626",
    "g": "3631201000 352616050312223333",
    "h": "0802 0516263532",
    "i": "0602 0807",
    "j": "161100 1817",
    "k": "0802 3603 1532",
    "l": "08031222",
    "m": "0602 0516252522 25364542",
    "n": "0602 0516263532",
    "o": "1605031222333526161616",
    "p": "0600 051626353323120303",
    "q": "3630 352616050312223333",
    "r": "0602 041626",
    "s": "362616051424332212020202",
    "t": "18131222 0626",
    "u": "060312223336 3632",
    "v": "061236",
    "w": "0612243246",
    "x": "0236 0632",
    "y": "0612 361000",
    "z": "06360232",
    "{": "29181605140201 1405",
    "|": "0901",
    "}": "09181625140201 1425",
    "~": "0516344546",
}
_MISSING_GLYPH = "080242480808"


def is_drawable(text: str) -> bool:
    """Return whether the font contains all characters of a text."""
    return all(character == " " or character in _GLYPHS for character in text)


def make_text_lines(text: str) -> tuple[Array, float]:
    """Return the strokes of a text on a single line, and the width of the text.

    Returns:
        The lines from point to point, as x and y to the right and upward in units of the font, shape (n, 2, 2); and the
        width in the same units.
    """
    lines: list[tuple[tuple[float, float], tuple[float, float]]] = []
    position = 0.0
    for character in text:
        if character == " ":
            position += _SPACE_WIDTH
            continue
        width = 0.0
        for stroke in _GLYPHS.get(character, _MISSING_GLYPH).split():
            points = [(int(stroke[index]), int(stroke[index + 1])) for index in range(0, len(stroke), 2)]
            width = max(width, *(x for x, _ in points))
            placed = [(position + x, float(y)) for x, y in points]
            lines += pairwise(placed)
        position += width + _LETTER_GAP
    return np.array(lines, dtype=np.float64).reshape(-1, 2, 2), max(position - _LETTER_GAP, 0.0)
