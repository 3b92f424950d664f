"""The types of properties: valid values, and their spellings in files."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.rviz.config.schema import MAX_TEXT_LENGTH, PropertySpec, accept_value, value_from_text, value_to_text

ALPHA = PropertySpec("Alpha", "float", 1.0, minimum=0.0, maximum=1.0)
LENGTH = PropertySpec("Length", "float", 0.0)
COUNT = PropertySpec("Count", "int", 10, minimum=1)
STYLE = PropertySpec("Style", "enum", "Lines", options=("Lines", "Billboards"))
COLOR = PropertySpec("Color", "color", "#a0a0a4")
FRAME = PropertySpec("Frame", "frame", "map")
BOX = PropertySpec("Box", "bool", True)
TEXT = PropertySpec("Text", "string", "")


@pytest.mark.parametrize(
    ("spec", "value", "expected"),
    [
        (ALPHA, 0.25, 0.25),
        (ALPHA, 1, 1.0),
        (ALPHA, 7.5, 1.0),
        (ALPHA, -1, 0.0),
        (COUNT, 3, 3),
        (COUNT, 3.0, 3),
        (COUNT, 0, 1),
        (STYLE, "Billboards", "Billboards"),
        (COLOR, "#A0b1C2", "#a0b1c2"),
        (FRAME, " /odom ", "odom"),
        (FRAME, "<Fixed Frame>", "<Fixed Frame>"),
        (BOX, False, False),
        (TEXT, "", ""),
    ],
)
def test_valid_values_are_accepted_and_clamped(spec, value, expected):
    accepted = accept_value(spec, value)
    assert accepted == expected
    assert type(accepted) is type(expected)


@pytest.mark.parametrize(
    ("spec", "value"),
    [
        (ALPHA, "0.5"),
        (ALPHA, True),
        (ALPHA, math.nan),
        (ALPHA, math.inf),
        (ALPHA, None),
        (ALPHA, 10**400),
        (COUNT, 2.5),
        (COUNT, True),
        (COUNT, 1e300),
        (STYLE, "lines"),
        (STYLE, 0),
        (COLOR, "red"),
        (COLOR, "#12345"),
        (FRAME, " "),
        (FRAME, "/"),
        (BOX, 1),
        (BOX, "true"),
        (TEXT, "x" * (MAX_TEXT_LENGTH + 1)),
        (TEXT, ["x"]),
        (PropertySpec("Group", "group"), "x"),
    ],
)
def test_invalid_values_are_rejected(spec, value):
    with pytest.raises(ValueError, match="expected"):
        accept_value(spec, value)


@pytest.mark.parametrize(
    ("spec", "text", "value"),
    [
        (ALPHA, "0.029999999329447746", 0.029999999329447746),
        (ALPHA, "1e-3", 0.001),
        (COUNT, "12", 12),
        (COLOR, "160; 160; 164", "#a0a0a4"),
        (COLOR, "0;0;999", "#0000ff"),
        (COLOR, "-1; 2 ;3; 128", "#000203"),
        (COLOR, "#ff0000", "#ff0000"),
        (COLOR, "#F0a", "#ff00aa"),
        (COLOR, "SkyBlue", "#87ceeb"),
        (BOX, "True", True),
        (BOX, "0", False),
        (BOX, "", False),
        (BOX, "on", True),
        (COUNT, "1e+06", 1_000_000),
        (ALPHA, "nan", 1.0),
        (ALPHA, "-.NaN", 1.0),
        (ALPHA, "inf", 1.0),
        (LENGTH, "-Infinity", -3.4028234663852886e38),
        (LENGTH, ".inf", 3.4028234663852886e38),
        (FRAME, "/base_footprint", "base_footprint"),
    ],
)
def test_spellings_in_files_are_parsed(spec, text, value):
    assert value_from_text(spec, text) == value


INVALID_SPELLINGS = [
    (ALPHA, "much"),
    (ALPHA, "1,5"),
    (COUNT, "1_000"),
    (COUNT, "0x10"),
    (COUNT, "٣"),
    (COUNT, "inf"),
    (BOX, "maybe"),
    (BOX, "off"),
    (COLOR, "1; 2"),
    (COLOR, "255, 0, 0"),
    (COLOR, "reddish"),
]


@pytest.mark.parametrize(("spec", "text"), INVALID_SPELLINGS)
def test_invalid_spellings_are_rejected(spec, text):
    with pytest.raises(ValueError, match="expected"):
        value_from_text(spec, text)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_floats_survive_round_trip(value):
    spec = PropertySpec("x", "float", 0.0)
    assert value_from_text(spec, value_to_text(spec, value)) == value


@given(st.from_regex(r"#[0-9a-f]{6}", fullmatch=True))
def test_colors_survive_round_trip(color):
    assert value_from_text(COLOR, value_to_text(COLOR, color)) == color
