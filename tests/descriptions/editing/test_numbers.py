"""The notation of numbers."""

from __future__ import annotations

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.descriptions.editing.numbers import format_pi_fraction, shortest_text


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.1 + 0.2, "0.3"), (2.0, "2"), (-0.0, "0"), (1e-12, "0"), (0.2617993877991494, "0.261799388"), (-1.5, "-1.5")],
)
def test_number_text_is_as_short_as_possible(value: float, text: str) -> None:
    assert shortest_text(value) == text


@given(st.floats(-1e5, 1e5))
def test_number_text_keeps_value_within_tolerance(value: float) -> None:
    assert abs(float(shortest_text(value)) - value) <= 1e-9
    assert float(shortest_text(value, 0.0)) == value


@pytest.mark.parametrize(
    ("angle", "text"),
    [(pi, "pi"), (-pi / 2, "-pi/2"), (2 * pi / 3, "2*pi/3"), (5 * pi / 12, "5*pi/12"), (0.1, None), (0.0, None)],
)
def test_fraction_of_pi_is_recognized(angle: float, text: str | None) -> None:
    assert format_pi_fraction(angle) == text
