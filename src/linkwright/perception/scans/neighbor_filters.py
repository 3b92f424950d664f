"""Filters that compare neighboring points to find shadows at edges, and speckles."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, radians, tan

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.perception.scans.scan import Lookup, Mask, Scan, ScanFilter, replace_ranges


@dataclass(slots=True)
class ScanShadowsFilter(ScanFilter):
    """``ScanShadowsFilter``: removes shadow points, which appear behind an edge.

    At an edge the beam is split between foreground and background.

    If the line through two points of the window is nearly parallel to the ray (an angle below ``min_angle`` or above
    ``max_angle`` degrees), the first point is at an edge. Of its ``neighbors``, those that are farther away are
    removed.
    """

    min_angle: float
    max_angle: float
    window: int
    neighbors: int = 0
    remove_shadow_start_point: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.min_angle <= 90.0 <= self.max_angle <= 180.0:
            message = phrase(
                "min_angle ({minimum:g}) must be 0 to 90 degrees, and max_angle ({maximum:g}) 90 to 180 degrees",
                minimum=self.min_angle,
                maximum=self.max_angle,
            )
            raise LinkwrightError(Diagnostic("NODE433", message))

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        ranges = scan.ranges.astype(np.float64)
        edges = self._find_edges(ranges, scan.angle_increment)
        for shift in range(-self.neighbors, self.neighbors + 1):
            first, second = _shifted_slices(len(ranges), shift)
            is_behind = edges[first] & (ranges[first] < ranges[second])
            scan.ranges[second][is_behind] = nan
        return replace_ranges(scan, edges) if self.remove_shadow_start_point else scan

    def _find_edges(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]], increment: float) -> Mask:
        min_slope, max_slope = abs(tan(radians(self.min_angle))), -abs(tan(radians(self.max_angle)))
        is_edge = np.zeros(len(ranges), dtype=bool)
        for shift in range(-self.window, self.window + 1):
            if shift:
                first, second = _shifted_slices(len(ranges), shift)
                angle = shift * increment
                with np.errstate(all="ignore"):  # missing measurements are NaN or infinite
                    perpendicular = ranges[second] * abs(np.sin(angle))
                    slope = perpendicular / (ranges[first] - ranges[second] * np.cos(angle))
                is_edge[first] |= (slope < min_slope) & (slope > max_slope)
        return is_edge


@dataclass(slots=True)
class SpeckleFilter(ScanFilter):
    """``LaserScanSpeckleFilter``: removes isolated points that are nearer than ``max_range``.

    With ``filter_type`` 0, points are kept if the ranges of ``filter_window`` consecutive rays are similar. With 1,
    points are kept if at least ``filter_window`` of the surrounding points are near.
    """

    filter_type: int = 0
    max_range: float = 2.0
    max_range_difference: float = 0.1
    filter_window: int = 2

    def __post_init__(self) -> None:
        if self.filter_type not in (0, 1) or self.filter_window < 1:
            message = phrase(
                "filter_type ({kind}) must be 0 or 1, and filter_window ({window}) must be 1 or more",
                kind=self.filter_type,
                window=self.filter_window,
            )
            raise LinkwrightError(Diagnostic("NODE433", message))

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        ranges, window = scan.ranges.astype(np.float64), self.filter_window
        if len(ranges) <= window + 1:
            return None
        is_cluster = (
            self._have_similar_ranges(ranges)
            if self.filter_type == 0
            else self._have_near_neighbors(ranges, scan.angle_increment)
        )
        is_kept = ranges > self.max_range
        starts = np.flatnonzero(is_cluster[: len(ranges) - window + 1])
        for shift in range(window):
            is_kept[starts + shift] = True
        return replace_ranges(scan, ~is_kept)

    def _have_similar_ranges(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Mask:
        is_similar: Mask = ~np.isnan(ranges)
        for shift in range(1, self.filter_window):
            first, second = _shifted_slices(len(ranges), shift)
            with np.errstate(invalid="ignore"):
                is_similar[first] &= np.abs(ranges[second] - ranges[first]) <= self.max_range_difference
        return is_similar

    def _have_near_neighbors(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]], increment: float) -> Mask:
        near_counts = np.zeros(len(ranges), dtype=int)
        for shift in range(-self.filter_window, self.filter_window + 1):
            if shift:
                first_slice, second_slice = _shifted_slices(len(ranges), shift)
                first, second = ranges[first_slice], ranges[second_slice]
                with np.errstate(invalid="ignore"):
                    squared_distances = first**2 + second**2 - 2.0 * first * second * np.cos(shift * increment)
                    near_counts[first_slice] += squared_distances <= self.max_range_difference**2
        return near_counts >= self.filter_window


def _shifted_slices(count: int, shift: int) -> tuple[slice, slice]:
    """Return two slices that select all pairs of indices below a count with a given difference."""
    if abs(shift) >= count:
        return slice(0, 0), slice(0, 0)
    if shift >= 0:
        return slice(0, count - shift), slice(shift, count)
    return slice(-shift, count), slice(0, count + shift)
