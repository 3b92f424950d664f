"""The conversion of offsets to lines and columns and back."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import SourceText, Span

TEXT = SourceText("robot.urdf", "one\ntwo\r\n\n\tfour 四 轮\nlast")


PLACES = {0: (1, 1), 2: (1, 3), 3: (1, 4), 4: (2, 1), 9: (3, 1), 10: (4, 1), 11: (4, 2), 16: (4, 7), 20: (5, 1)}


@pytest.mark.parametrize(("offset", "place"), PLACES.items())
def test_positions_count_characters_from_one(offset, place):
    assert TEXT.position(offset) == place


@pytest.mark.parametrize(("offset", "place"), [(-5, (1, 1)), (24, (5, 5)), (1000, (5, 5))])
def test_offsets_beyond_the_text_are_clamped(offset, place):
    assert TEXT.position(offset) == place


@given(st.text("ab\n\r\t中", max_size=30), st.data())
def test_position_and_offset_undo_each_other(text, data):
    source = SourceText("x", text)
    offset = data.draw(st.integers(0, len(text)))
    assert source.offset(*source.position(offset)) == offset


@given(st.text("ab\n", max_size=30))
def test_lines_are_those_of_split(text):
    source = SourceText("x", text)
    assert [source.line(number + 1) for number in range(len(text.split("\n")))] == text.split("\n")


def test_a_line_is_without_its_end():
    assert TEXT.line(2) == "two"
    assert TEXT.line(4) == "\tfour 四 轮"


@pytest.mark.parametrize("number", [0, -1, 6])
def test_a_line_that_is_not_there_is_empty(number):
    assert TEXT.line(number) == ""


@pytest.mark.parametrize(("place", "offset"), [((0, 1), 0), ((99, 1), 20), ((5, 99), 24)])
def test_places_beyond_the_text_are_clamped(place, offset):
    assert TEXT.offset(*place) == offset


def test_spans():
    assert TEXT.span(4, 7) == Span("robot.urdf", 2, 1, 2, 4)
    assert TEXT.span(4) == Span("robot.urdf", 2, 1, 2, 2)
    assert TEXT.span(2, 12) == Span("robot.urdf", 1, 3, 4, 3)
    assert str(TEXT.span(11, 15)) == "robot.urdf:4:2"


def test_an_empty_text():
    empty = SourceText("x", "")
    assert empty.position(0) == (1, 1)
    assert empty.span(0) == Span("x", 1, 1, 1, 1)
    assert empty.line(1) == ""


def test_the_text_is_not_in_its_own_description():
    assert repr(TEXT) == "SourceText('robot.urdf', 24 characters)"
