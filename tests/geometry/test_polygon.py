"""Polygons in a plane; the tests of the decomposition cover their triangles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.polygon import within_polygon

BRACKET = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
"""An L, whose notch is outside."""


@pytest.mark.parametrize("corners", [BRACKET, BRACKET[::-1], np.roll(BRACKET, 2, axis=0)])
@given(x=st.floats(-1.0, 4.0), y=st.floats(-1.0, 4.0))
def test_within_polygon_supports_concave_polygon(corners, x, y):
    distance = min(abs(x), abs(y), abs(x - 1.0), abs(y - 1.0), abs(x - 3.0), abs(y - 3.0))
    if distance > 1e-9:  # some points on the border count as inside
        in_bracket = 0.0 < x < 3.0 and 0.0 < y < 3.0 and (x < 1.0 or y < 1.0)
        assert bool(within_polygon(np.array([x, y]), corners)) == in_bracket


def test_within_polygon_keeps_shape_of_point_array():
    points = np.array([[[0.5, 0.5], [2.0, 2.0], [2.0, 0.5]], [[0.5, 2.0], [-1.0, 0.5], [0.5, 4.0]]])
    assert within_polygon(points, BRACKET).tolist() == [[True, False, True], [True, False, False]]
