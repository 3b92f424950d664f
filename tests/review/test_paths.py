"""Paths of robots: paired by seed and time, drawn with equal axes, the same bytes twice."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from linkwright.review.paths import PathComparison, compare_paths, find_differing_paths
from linkwright.review.reports.path_plots import draw_path_plot


def make_line(speed: float, period: float = 0.1, seconds: float = 4.0, y: float = 0.0) -> np.ndarray:
    """Return a path along the x axis."""
    times = np.arange(0.0, seconds + period / 2, period)
    return np.column_stack([times, speed * times, np.full(len(times), y)])


def make_comparison(*pairs: tuple[np.ndarray, np.ndarray]) -> PathComparison:
    return PathComparison("robot", "", [compare_paths(str(seed), *paths) for seed, paths in enumerate(pairs)])


def test_distance_is_between_positions_at_the_same_time():
    pair = compare_paths("0", make_line(1.0), make_line(1.5, period=0.07, seconds=3.5))
    assert (pair.distance, pair.time) == pytest.approx((1.75, 3.5))
    assert pair.ends == (pytest.approx((3.5, 0.0)), pytest.approx((5.25, 0.0)))


def test_same_path_sampled_at_other_times_does_not_differ():
    runs = [("0", make_line(1.0), make_line(1.0, period=0.25, seconds=3.0))]
    assert find_differing_paths({("robot", ""): runs}) == []


def test_paths_without_a_common_time_have_a_distance():
    later_path = make_line(1.0, y=2.0) + np.array([10.0, 0.0, 0.0])
    assert compare_paths("0", make_line(1.0), later_path).distance == pytest.approx(math.hypot(4.0, 2.0))


def test_largest_differences_come_first():
    groups = {
        ("robot", "speed=1"): [("0", make_line(1.0), make_line(1.1))],
        ("robot", "speed=2"): [("0", make_line(2.0), make_line(2.5))],
    }
    assert [difference.parameters for difference in find_differing_paths(groups)] == ["speed=2", "speed=1"]


def test_typical_pair_is_the_median_and_the_farthest_is_always_shown():
    path_comparison = make_comparison(*((make_line(1.0), make_line(1.0 + 0.01 * number)) for number in range(40)))
    assert path_comparison.typical.distance == pytest.approx(0.19 * 4.0)
    assert path_comparison.farthest in path_comparison.shown
    assert len(path_comparison.shown) == 25


def test_plot_has_the_same_scale_on_both_axes_and_each_path():
    square = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 1.0]])
    plot = draw_path_plot(make_comparison((square, square + np.array([0.0, 0.0, 0.1]))))
    points = re.findall(r"<polyline class='path old thick' points='([^']*)'", plot)[0]
    (x0, y0), (x1, y1), (x2, y2) = (map(float, point.split(",")) for point in points.split())
    assert (x1 - x0, y1 - y2) == pytest.approx((y1 - y2, x2 - x0), abs=0.2)
    assert y0 == y1
    assert plot.count("<polyline") == 4
    assert ">0.100 m<" in plot or ">0.1 m<" in plot


def test_plot_of_a_robot_that_stood_still_has_a_frame():
    standing_path = make_line(0.0)
    plot = draw_path_plot(make_comparison((standing_path, standing_path + np.array([0.0, 0.0, 0.001]))))
    assert "nan" not in plot
    assert ">0.001 m<" in plot


def test_path_names_are_escaped():
    path_comparison = PathComparison("<b>'", "n=<i>", [compare_paths("<s>", make_line(1.0), make_line(2.0))])
    plot = draw_path_plot(path_comparison)
    assert not re.search("<(b|i|s)>", plot)
    assert "aria-label='paths of both versions, &lt;b&gt;&#x27;, n=&lt;i&gt;'" in plot
