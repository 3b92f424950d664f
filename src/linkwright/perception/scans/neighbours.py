"""Filters that compare neighbouring points to find shadows at edges, and speckles."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, radians, tan

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.perception.scans.scan import Flags, Lookup, Scan, ScanFilter, clear_ranges


@dataclass(slots=True)
class ScanShadowsFilter(ScanFilter):
    """``ScanShadowsFilter``: removes points behind an edge.

    There the beam is split between foreground and background.

    If the line through two points of the window is nearly parallel to the ray (an angle below ``min_angle`` or above
    ``max_angle`` degrees), those of the ``neighbors`` of the first point that are farther away are removed as shadows.
    """

    min_angle: float
    max_angle: float
    window: int
    neighbors: int = 0
    remove_shadow_start_point: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.min_angle <= 90.0 <= self.max_angle <= 180.0:
            message = phrase(
                "min_angle ({least:g}) must be 0 to 90 degrees, and max_angle ({most:g}) 90 to 180 degrees",
                least=self.min_angle,
                most=self.max_angle,
            )
            raise LinkwrightError(Diagnostic("NODE433", message))

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        ranges = scan.ranges.astype(np.float64)
        edges = self._edges(ranges, scan.angle_increment)
        for shift in range(-self.neighbors, self.neighbors + 1):
            here, there = _pairs(len(ranges), shift)
            behind = edges[here] & (ranges[here] < ranges[there])
            scan.ranges[there][behind] = nan
        return clear_ranges(scan, edges) if self.remove_shadow_start_point else scan

    def _edges(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]], increment: float) -> Flags:
        least, most = abs(tan(radians(self.min_angle))), -abs(tan(radians(self.max_angle)))
        edges = np.zeros(len(ranges), dtype=bool)
        for shift in range(-self.window, self.window + 1):
            if shift:
                here, there = _pairs(len(ranges), shift)
                angle = shift * increment
                with np.errstate(all="ignore"):  # Missing measurements are NaN or infinite.
                    across = ranges[there] * abs(np.sin(angle))
                    slope = across / (ranges[here] - ranges[there] * np.cos(angle))
                edges[here] |= (slope < least) & (slope > most)
        return edges


@dataclass(slots=True)
class SpeckleFilter(ScanFilter):
    """``LaserScanSpeckleFilter``: removes isolated points nearer than ``max_range``.

    With ``filter_type`` 0, the ranges of ``filter_window`` consecutive rays must be similar for the points to be kept.
    With 1, that many of the surrounding points must be near.
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
        together = (
            self._differ_little(ranges) if self.filter_type == 0 else self._are_near(ranges, scan.angle_increment)
        )
        kept = ranges > self.max_range
        starts = np.flatnonzero(together[: len(ranges) - window + 1])
        for shift in range(window):
            kept[starts + shift] = True
        return clear_ranges(scan, ~kept)

    def _differ_little(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Flags:
        together: Flags = ~np.isnan(ranges)
        for shift in range(1, self.filter_window):
            here, there = _pairs(len(ranges), shift)
            with np.errstate(invalid="ignore"):
                together[here] &= np.abs(ranges[there] - ranges[here]) <= self.max_range_difference
        return together

    def _are_near(self, ranges: np.ndarray[tuple[int, ...], np.dtype[np.float64]], increment: float) -> Flags:
        near = np.zeros(len(ranges), dtype=int)
        for shift in range(-self.filter_window, self.filter_window + 1):
            if shift:
                here, there = _pairs(len(ranges), shift)
                first, second = ranges[here], ranges[there]
                with np.errstate(invalid="ignore"):
                    squared = first**2 + second**2 - 2.0 * first * second * np.cos(shift * increment)
                    near[here] += squared <= self.max_range_difference**2
        return near >= self.filter_window


def _pairs(count: int, shift: int) -> tuple[slice, slice]:
    """Return slices that select all pairs of indices below a count that differ by a shift."""
    if abs(shift) >= count:
        return slice(0, 0), slice(0, 0)
    if shift >= 0:
        return slice(0, count - shift), slice(shift, count)
    return slice(-shift, count), slice(0, count + shift)
