"""Spoken numbers and quantities: tables of their values."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.speech.commands.numbers import parse_number
from linkwright.speech.commands.quantities import GRAMMAR_VALUES, parse_quantity
from linkwright.speech.commands.words import split_into_words

NUMBERS = {
    "zero": 0,
    "seven": 7,
    "twenty one": 21,
    "twenty-one": 21,
    "ninety": 90,
    "a hundred": 100,
    "one hundred and eighty": 180,
    "three hundred sixty": 360,
    "one thousand two hundred and three": 1203,
    "point five": 0.5,
    "two point oh five": 2.05,
    "one and a half": 1.5,
    "two and a quarter": 2.25,
    "half a": 0.5,
    "three quarters of a": 0.75,
    "0.75": 0.75,
    "９０": 90,
    "零": 0,
    "十": 10,
    "十五": 15,
    "九十": 90,
    "两": 2,
    "一百零八": 108,
    "一百八": 180,
    "一百八十": 180,
    "三百六十": 360,
    "两千三": 2300,
    "一千零五": 1005,
    "一点五": 1.5,
    "零点二五": 0.25,
    "半": 0.5,
    "一个半": 1.5,
    "三个": 3,
}

NO_NUMBERS = [
    "",
    "left",
    "one two",
    "twenty eleven",
    "point",
    "one point ten",
    "and a half",
    "一二",
    "十十",
    "点五",
    "一点",
    "个",
]

QUANTITIES = [
    ("angle", "ninety degrees", pi / 2),
    ("angle", "90°", pi / 2),
    ("angle", "九十度", pi / 2),
    ("angle", "90度", pi / 2),
    ("angle", "九 十 度", pi / 2),
    ("angle", "一百八十度", pi),
    ("angle", "half a turn", pi),
    ("angle", "a quarter turn", pi / 2),
    ("angle", "两圈", 4 * pi),
    ("angle", "两圈半", 5 * pi),
    ("angle", "one point five radians", 1.5),
    ("distance", "half a meter", 0.5),
    ("distance", "one and a half meters", 1.5),
    ("distance", "a meter and a half", 1.5),
    ("distance", "two feet", 0.6096),
    ("distance", "fifty centimeters", 0.5),
    ("distance", "1.5 m", 1.5),
    ("distance", "半米", 0.5),
    ("distance", "一点五米", 1.5),
    ("distance", "一米半", 1.5),
    ("distance", "三十厘米", 0.3),
    ("speed", "half a meter per second", 0.5),
    ("speed", "每秒半米", 0.5),
    ("speed", "零点三米每秒", 0.3),
    ("speed", "thirty six kilometers per hour", 10.0),
    ("duration", "two and a half seconds", 2.5),
    ("duration", "三秒钟", 3.0),
    ("duration", "一分钟", 60.0),
    ("number", "twelve", 12),
]


@pytest.mark.parametrize(("text", "value"), NUMBERS.items())
def test_spoken_number_is_parsed(text: str, value: float) -> None:
    assert parse_number(split_into_words(text)) == value


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_text_that_is_not_a_number_is_rejected(text: str) -> None:
    assert parse_number(split_into_words(text)) is None


@pytest.mark.parametrize(("slot", "text", "value"), QUANTITIES)
def test_spoken_quantity_is_parsed(slot: str, text: str, value: float) -> None:
    assert parse_quantity(slot, split_into_words(text)) == pytest.approx(value)


@pytest.mark.parametrize(
    ("slot", "text"),
    [
        ("angle", "ninety"),
        ("distance", "degrees"),
        ("distance", "ninety degrees"),
        ("angle", "半"),
        ("distance", "half a meter and a half"),
    ],
)
def test_text_that_is_not_a_quantity_is_rejected(slot: str, text: str) -> None:
    assert parse_quantity(slot, split_into_words(text)) is None


@pytest.mark.parametrize("slot", GRAMMAR_VALUES)
def test_grammar_values_are_parsed(slot: str) -> None:
    assert [
        text
        for texts in GRAMMAR_VALUES[slot].values()
        for text in texts
        if parse_quantity(slot, split_into_words(text)) is None
    ] == []
