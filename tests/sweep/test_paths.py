"""Results that are paths."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.sweep.paths import name_recorded_paths, parse_path
from linkwright.testing.paths import MAX_POINTS


def test_rows_of_time_and_position_are_a_path():
    assert parse_path([(0, 1, 2), (0.5, 3, 4)]) == [(0.0, 1.0, 2.0), (0.5, 3.0, 4.0)]
    assert parse_path(np.array([[0.0, 1.0, 2.0]])) == [(0.0, 1.0, 2.0)]


@pytest.mark.parametrize(
    "value",
    [
        1.0,
        "path",
        b"path",
        [],
        [1.0, 2.0, 3.0],
        [(0.0, 1.0)],
        [(0.0, 1.0, 2.0), (0.0, 1.0, 2.0)],
        [(0.0, 1.0, float("nan"))],
        [(0.0, 1.0, "north")],
        [(0.0, 1.0, 2.0), (1.0, 2.0)],
    ],
)
def test_other_values_are_not_a_path(value):
    assert parse_path(value) is None


def test_long_path_keeps_both_ends():
    rows = [(0.1 * step, float(step), 0.0) for step in range(3 * MAX_POINTS + 2)]
    path = parse_path(rows)
    assert path is not None
    assert len(path) <= MAX_POINTS + 1
    assert (path[0], path[-1]) == (rows[0], rows[-1])


def test_recorded_paths_have_numbers_from_the_second_one():
    point = (0.0, 0.0, 0.0)
    assert name_recorded_paths([[point], [], [point]]) == {"robot": [point], "robot 2": [point]}
