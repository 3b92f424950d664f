"""The conversion of offsets to lines and columns and back."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import SourceText, Span

TEXT = SourceText("robot.urdf", "one\ntwo\r\n\n\tfour 四 轮\nlast")


PLACES = {0: (1, 1), 2: (1, 3), 3: (1, 4), 4: (2, 1), 9: (3, 1), 10: (4, 1), 11: (4, 2), 16: (4, 7), 20: (5, 1)}


@pytest.mark.parametrize(("offset", "place"), PLACES.items())
def test_positions_are_one_based_and_count_characters(offset, place):
    assert TEXT.position(offset) == place


@pytest.mark.parametrize(("offset", "place"), [(-5, (1, 1)), (24, (5, 5)), (1000, (5, 5))])
def test_offsets_beyond_text_are_clamped(offset, place):
    assert TEXT.position(offset) == place


@given(st.text("ab\n\r\t中", max_size=30), st.data())
def test_position_and_offset_round_trip(text, data):
    source = SourceText("x", text)
    offset = data.draw(st.integers(0, len(text)))
    assert source.offset(*source.position(offset)) == offset


@given(st.text("ab\n", max_size=30))
def test_lines_match_split(text):
    source = SourceText("x", text)
    assert [source.line(number + 1) for number in range(len(text.split("\n")))] == text.split("\n")


def test_line_excludes_line_ending():
    assert TEXT.line(2) == "two"
    assert TEXT.line(4) == "\tfour 四 轮"


@pytest.mark.parametrize("number", [0, -1, 6])
def test_missing_line_is_empty(number):
    assert TEXT.line(number) == ""


@pytest.mark.parametrize(("place", "offset"), [((0, 1), 0), ((99, 1), 20), ((5, 99), 24)])
def test_positions_beyond_text_are_clamped(place, offset):
    assert TEXT.offset(*place) == offset


def test_span_converts_offsets_to_lines_and_columns():
    assert TEXT.span(4, 7) == Span("robot.urdf", 2, 1, 2, 4)
    assert TEXT.span(4) == Span("robot.urdf", 2, 1, 2, 2)
    assert TEXT.span(2, 12) == Span("robot.urdf", 1, 3, 4, 3)
    assert str(TEXT.span(11, 15)) == "robot.urdf:4:2"


def test_empty_text_has_one_empty_line():
    empty = SourceText("x", "")
    assert empty.position(0) == (1, 1)
    assert empty.span(0) == Span("x", 1, 1, 1, 1)
    assert empty.line(1) == ""


def test_repr_omits_text():
    assert repr(TEXT) == "SourceText('robot.urdf', 24 characters)"
