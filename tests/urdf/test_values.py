"""Numbers and vectors, read as by the C++ streams of urdfdom."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from linkwright.urdf.values import looks_like_degrees, number, number_hint, numbers, shortest_text, vector3, vector_hint


def stream_reads(text: str) -> bool:
    """Return whether a C++ stream reads a double from the whole text.

    It reads character by character, as num_get does.
    """
    text = text.lstrip(" \t\n\v\f\r")
    position = 0

    def digits() -> int:
        nonlocal position
        start = position
        while position < len(text) and text[position] in "0123456789":
            position += 1
        return position - start

    if text[:1] in ("+", "-"):
        position += 1
    count = digits()
    if text[position : position + 1] == ".":
        position += 1
        count += digits()
    if not count:
        return False
    if text[position : position + 1] in ("e", "E"):
        position += 1
        if text[position : position + 1] in ("+", "-"):
            position += 1
        if not digits():
            return False
    return position == len(text) and not math.isinf(float(text))


def is_readable(text: str) -> bool:
    try:
        number(text)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("text", ["1", "-1", "+1", " 1", "\t1", "1e3", "1E-3", ".5", "5.", "-.5e+2", "007", "1e-400"])
def test_numbers_are_parsed(text):
    assert number(text) == float(text)


NO_NUMBERS = """inf -inf nan 0x10 0,5 1_0 1e 1e400 . + --1 1.2.3 ١ 1f 1d ${x} 1;"""


@pytest.mark.parametrize("text", ["", " ", "-1 ", "1 2", "1\t", "- 1", *NO_NUMBERS.split()])
def test_malformed_numbers_are_rejected(text):
    assert not is_readable(text)


@given(st.text("0123456789+-.eE \t\nxin,_", max_size=8))
@example("1e5e5")
def test_number_matches_cpp_stream(text):
    assert is_readable(text) == stream_reads(text)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_plain_number_round_trips(value):
    written = shortest_text(value)
    assert math.copysign(1, number(written)) == math.copysign(1, value)
    assert number(written) == value
    assert not written.endswith(".0")


@pytest.mark.parametrize("text", ["1 2 3", "  1   2 3  ", "1 \t2 3", "+1 -2e0 .5"])
def test_vectors_are_parsed(text):
    assert vector3(text) == tuple(float(piece) for piece in text.split())


@pytest.mark.parametrize(
    "text", ["", "1 2", "1 2 3 4", "1\t2\t3", "1 2\n3", "1, 2, 3", "1 2 3\t", "1 2 inf", "1 2 1e400"]
)
def test_malformed_vectors_are_rejected(text):
    with pytest.raises(ValueError):
        vector3(text)


@given(st.text("0123.e- \t\n,x", max_size=12))
def test_vector_pattern_matches_piecewise_parsing(text):
    try:
        pieces = numbers(text)
    except ValueError:
        pieces = ()
    if len(pieces) == 3:
        assert vector3(text) == pieces
    else:
        with pytest.raises(ValueError):
            vector3(text)


@given(st.text(max_size=20))
def test_hints_accept_any_text(text):
    number_hint(text)
    vector_hint(text, 3)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("", "give a number"),
        ("1 2", "give one number"),
        ("90 deg", "angles are in radians: '1.5708'"),
        ("5 mm", "lengths are in meters: '0.005'"),
        ("250g", "masses are in kilograms: '0.25'"),
        ("1e999", "only finite numbers are read"),
        ("foo", None),
    ],
)
def test_malformed_numbers_have_hints(text, hint):
    assert number_hint(text) == hint


@pytest.mark.parametrize(
    ("angles", "degrees"),
    [((0, 0, 90), True), ((-180, 180), True), ((3.14, 6.28), False), ((100.5,), False), ((9,), False), ((1e9,), False)],
)
def test_looks_like_degrees_detects_degree_values(angles, degrees):
    assert looks_like_degrees(*angles) is degrees
