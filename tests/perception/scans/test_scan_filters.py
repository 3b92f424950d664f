"""The filters of laser scans."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.perception.scans.neighbor_filters import ScanShadowsFilter, SpeckleFilter
from linkwright.perception.scans.position_filters import (
    AngularBoundsFilter,
    AngularBoundsInPlaceFilter,
    BoxFilter,
    FootprintFilter,
    PolygonFilter,
    SectorFilter,
)
from linkwright.perception.scans.scan import Scan
from linkwright.perception.scans.value_filters import (
    ArrayFilter,
    IntensityFilter,
    InterpolationFilter,
    MaskFilter,
    RangeFilter,
)


def make_scan(*ranges, intensities=(), angle_min=0.0, increment=0.1, time_increment=0.0):
    return Scan(
        ranges=np.array(ranges, np.float32),
        intensities=np.array(intensities, np.float32),
        angle_min=angle_min,
        angle_max=angle_min + increment * (len(ranges) - 1),
        angle_increment=increment,
        range_min=0.1,
        range_max=10.0,
        time_increment=time_increment,
        stamp_ns=5_000_000_000,
        frame="laser",
    )


def reject_lookup(target, source, time_ns):
    return None


def approx_ranges(expected):
    return pytest.approx(np.array(expected, np.float32), nan_ok=True)


def filtered_ranges(scan_filter, message, lookup=reject_lookup):
    return list(scan_filter.apply(message, lookup).ranges)


def test_range_filter_replaces_ranges_beyond_thresholds():
    assert filtered_ranges(RangeFilter(1.0, 5.0), make_scan(0.5, 1.0, 3.0, 5.0, inf, nan)) == approx_ranges(
        [nan, nan, 3.0, nan, nan, nan]
    )
    replacing = RangeFilter(use_message_range_limits=True, lower_replacement_value=-inf, upper_replacement_value=inf)
    assert filtered_ranges(replacing, make_scan(0.05, 3.0, 11.0)) == approx_ranges([-inf, 3.0, inf])


def test_intensity_filter_removes_ranges_outside_limits():
    message = make_scan(1.0, 2.0, 3.0, intensities=(5.0, 50.0, 500.0))
    assert filtered_ranges(IntensityFilter(10.0, 100.0), message) == approx_ranges([nan, 2.0, nan])
    message = make_scan(1.0, 2.0, 3.0, intensities=(5.0, 50.0, 500.0))
    assert filtered_ranges(IntensityFilter(10.0, 100.0, invert=True), message) == approx_ranges([1.0, nan, 3.0])
    assert filtered_ranges(IntensityFilter(10.0, 100.0), make_scan(1.0, 2.0)) == approx_ranges([1.0, 2.0])


def test_interpolation_filter_fills_gaps_with_mean():
    assert filtered_ranges(InterpolationFilter(), make_scan(2.0, inf, nan, 4.0)) == approx_ranges([2.0, 3.0, 3.0, 4.0])
    assert filtered_ranges(InterpolationFilter(), make_scan(inf, 4.01, 0.0)) == approx_ranges([7.0, 4.01, 7.0])


def test_mask_filter_removes_rays_of_its_frame():
    scan_filter = MaskFilter({"laser": [0, 2, 99], "other": [1]})
    assert filtered_ranges(scan_filter, make_scan(1.0, 2.0, 3.0)) == approx_ranges([nan, 2.0, nan])


def test_array_filter_applies_median_and_mean_of_last_scans():
    median = {"filter1": {"type": "filters/MultiChannelMedianFilterFloat", "params": {"number_of_observations": 3}}}
    mean = {"filter1": {"type": "filters/MultiChannelMeanFilterFloat", "params": {"number_of_observations": 2}}}
    scan_filter = ArrayFilter(median, mean)
    scan_filter.apply(make_scan(1.0, 5.0, intensities=(1.0, 1.0)), reject_lookup)
    scan_filter.apply(make_scan(9.0, 6.0, intensities=(2.0, 4.0)), reject_lookup)
    last = scan_filter.apply(make_scan(2.0, 7.0, intensities=(4.0, 8.0)), reject_lookup)
    assert list(last.ranges) == approx_ranges([2.0, 6.0])
    assert list(last.intensities) == approx_ranges([3.0, 6.0])
    assert list(scan_filter.apply(make_scan(8.0), reject_lookup).ranges) == approx_ranges([8.0])
    with pytest.raises(
        LinkwrightError, match="filter 'Magic' does not exist for arrays, or does not support 1 observations"
    ):
        ArrayFilter({"filter1": {"type": "Magic"}})


def test_angular_bounds_filter_crops_scan():
    input_scan = make_scan(0.0, 1.0, 2.0, 3.0, 4.0, intensities=range(5), time_increment=0.5)
    result = AngularBoundsFilter(0.05, 0.35).apply(input_scan, reject_lookup)
    assert list(result.ranges) == approx_ranges([1.0, 2.0, 3.0])
    assert list(result.intensities) == approx_ranges([1.0, 2.0, 3.0])
    assert (result.angle_min, result.angle_max, result.stamp_ns) == (
        pytest.approx(0.1),
        pytest.approx(0.3),
        5_500_000_000,
    )
    assert AngularBoundsFilter(2.0, 3.0).apply(make_scan(1.0), reject_lookup) is None


def test_angular_bounds_in_place_filter_removes_rays():
    input_scan = make_scan(1.0, 2.0, 3.0, intensities=(7.0, 8.0, 9.0))
    result = AngularBoundsInPlaceFilter(0.05, 0.15).apply(input_scan, reject_lookup)
    assert list(result.ranges) == approx_ranges([1.0, 11.0, 3.0])
    assert list(result.intensities) == approx_ranges([7.0, 0.0, 9.0])


def test_sector_filter_may_cross_pi():
    rear_sector = SectorFilter(angle_min=2.5, angle_max=-2.5, range_min=0.2, range_max=2.0)
    input_scan = make_scan(1.0, 1.0, 3.0, 1.0, angle_min=-3.0, increment=1.9)  # -3.0, -1.1, 0.8, 2.7
    assert filtered_ranges(rear_sector, input_scan) == approx_ranges([11.0, 1.0, 3.0, 11.0])
    input_scan = make_scan(1.0, 1.0, 3.0, 1.0, angle_min=-3.0, increment=1.9)
    rear_sector.invert = True
    assert filtered_ranges(rear_sector, input_scan) == approx_ranges([1.0, 11.0, 11.0, 1.0])


def laser_turned_left(target, source, time_ns):
    """Return the transform of a laser that looks left.

    The laser is half a meter in front of the body's center.
    """
    assert (target, source, time_ns) == ("base_link", "laser", 5_000_000_000)
    return (0.5, 0.0, 0.3, *quaternion_from_rpy((0.0, 0.0, pi / 2)))


def test_box_filter_transforms_points_to_its_frame():
    box_filter = BoxFilter("base_link", min_x=0.0, max_x=1.0, min_y=0.0, max_y=2.0, min_z=0.0, max_z=1.0)
    assert filtered_ranges(box_filter, make_scan(1.0, 3.0, nan, increment=0.0), laser_turned_left) == approx_ranges(
        [nan, 3.0, nan]
    )
    box_filter.invert = True
    assert filtered_ranges(box_filter, make_scan(1.0, 3.0, inf, increment=0.0), laser_turned_left) == approx_ranges(
        [1.0, nan, inf]
    )
    assert box_filter.apply(make_scan(1.0), reject_lookup) is None


def test_footprint_and_polygon_filters_remove_inner_points():
    assert filtered_ranges(
        FootprintFilter(0.6), make_scan(0.5, 0.7, increment=0.0), laser_turned_left
    ) == approx_ranges([nan, 0.7])
    triangle = PolygonFilter("[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]")
    assert filtered_ranges(triangle, make_scan(0.5, 1.5, increment=0.0), laser_turned_left) == approx_ranges([nan, 1.5])
    square = "[[0.4, 0.4], [0.4, -0.4], [-0.4, -0.4], [-0.4, 0.4]]"
    assert filtered_ranges(PolygonFilter(square), make_scan(0.3, increment=0.0), laser_turned_left) == approx_ranges(
        [0.3]
    )
    assert filtered_ranges(
        PolygonFilter(square, polygon_padding=0.2), make_scan(0.3, increment=0.0), laser_turned_left
    ) == approx_ranges([nan])
    with pytest.raises(LinkwrightError, match="must have three or more corners"):
        PolygonFilter("[[0.0, 0.0]]")


def test_shadows_filter_removes_points_between_edge_and_wall():
    scan_filter = ScanShadowsFilter(min_angle=10.0, max_angle=170.0, window=1, neighbors=1)
    near_ranges, wall = [1.0] * 5, [3.0] * 5
    distances = filtered_ranges(scan_filter, make_scan(*near_ranges, 2.0, *wall, increment=0.01))
    assert distances == approx_ranges([1.0] * 5 + [nan, nan] + [3.0] * 4)
    wall_scan = make_scan(*(1.0 / np.cos(np.arange(-5, 6) * 0.01)), angle_min=-0.05, increment=0.01)
    assert not np.isnan(filtered_ranges(scan_filter, wall_scan)).any()
    starts = ScanShadowsFilter(10.0, 170.0, 1, 0, remove_shadow_start_point=True)
    assert np.flatnonzero(
        np.isnan(filtered_ranges(starts, make_scan(*near_ranges, 2.0, *wall, increment=0.01)))
    ).tolist() == [
        4,
        5,
        6,
    ]
    with pytest.raises(LinkwrightError, match=r"min_angle \(95\) must be 0 to 90 degrees, and max_angle \(170\)"):
        ScanShadowsFilter(95.0, 170.0, 1)


def test_speckle_filter_removes_points_without_near_ranges():
    input_scan = make_scan(1.0, 1.02, 1.5, 1.9, 1.05, 1.06, 5.0, 1.0)
    assert filtered_ranges(SpeckleFilter(), input_scan) == approx_ranges([1.0, 1.02, nan, nan, 1.05, 1.06, 5.0, nan])
    assert SpeckleFilter().apply(make_scan(1.0, 1.0, 1.0), reject_lookup) is None
    with pytest.raises(LinkwrightError, match=r"filter_type \(3\) must be 0 or 1, and filter_window \(2\)"):
        SpeckleFilter(filter_type=3)


def test_speckle_filter_by_radius_counts_near_points():
    scan_filter = SpeckleFilter(filter_type=1, max_range_difference=0.2, filter_window=2)
    input_scan = make_scan(1.0, 1.0, 1.0, 1.9, 1.0, nan, nan, 1.5, nan, nan, increment=0.05)
    distances = filtered_ranges(scan_filter, input_scan)
    assert np.isnan(distances[7])
    assert distances[1] == 1.0


@settings(max_examples=60)
@given(st.lists(st.sampled_from([0.5, 1.0, 1.05, 1.5, 3.0, inf, nan]), min_size=5, max_size=12), st.integers(1, 3))
def test_speckle_filter_matches_reference_loop(values, window):
    distances = filtered_ranges(SpeckleFilter(filter_window=window), make_scan(*values))
    mask = [value > 2.0 for value in values]
    for start in range(len(values) - window + 1):
        group = values[start : start + window]
        alike = all(value == group[0] or abs(value - group[0]) <= 0.1 for value in group)
        if alike and not any(np.isnan(group)) and (window == 1 or not np.isinf(group).any()):
            mask[start : start + window] = [True] * window
    assert distances == approx_ranges([value if keep else nan for value, keep in zip(values, mask, strict=True)])
