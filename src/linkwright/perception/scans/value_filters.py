"""Filters of scans by their values: ranges, intensities, indices, and previous scans."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import nan
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.perception.scans.scan import Floats, Lookup, Scan, ScanFilter


@dataclass(slots=True)
class RangeFilter(ScanFilter):
    """``LaserScanRangeFilter``: replaces the ranges that are too short or too long."""

    lower_threshold: float = 0.0
    upper_threshold: float = 100000.0
    use_message_range_limits: bool = False
    lower_replacement_value: float = nan
    upper_replacement_value: float = nan

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        lower, upper = self.lower_threshold, self.upper_threshold
        if self.use_message_range_limits:
            lower, upper = scan.range_min, scan.range_max
        is_near, is_far = scan.ranges <= lower, scan.ranges >= upper
        scan.ranges[is_far] = self.upper_replacement_value
        scan.ranges[is_near] = self.lower_replacement_value
        return scan


@dataclass(slots=True)
class IntensityFilter(ScanFilter):
    """``LaserScanIntensityFilter``: removes points by two thresholds of intensity.

    Points outside the thresholds are removed, or with ``invert`` the points between them.
    """

    lower_threshold: float = 8000.0
    upper_threshold: float = 100000.0
    disp_histogram: int = 0
    invert: bool = False
    filter_override_range: bool = True
    filter_override_intensity: bool = False

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        count = len(scan.intensities)
        is_outside = (scan.intensities <= self.lower_threshold) | (scan.intensities >= self.upper_threshold)
        is_selected = is_outside != self.invert
        if self.filter_override_range:
            scan.ranges[:count][is_selected] = nan
        if self.filter_override_intensity:
            scan.intensities[is_selected] = 0.0
        return scan


@dataclass(slots=True)
class InterpolationFilter(ScanFilter):
    """``InterpolationFilter``: replaces invalid ranges with the mean of their neighbors.

    The neighbors are the nearest valid ranges on both sides. If there is no valid range on a side, a range just below
    ``range_max`` is used.
    """

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        default_range = scan.range_max - 0.01
        is_valid = (scan.ranges > scan.range_min) & (scan.ranges < scan.range_max)
        indices = np.arange(len(is_valid))
        previous_valid = np.maximum.accumulate(np.where(is_valid, indices, -1))
        next_valid = np.minimum.accumulate(np.where(is_valid, indices, len(is_valid))[::-1])[::-1]
        left_ranges = np.where(previous_valid >= 0, scan.ranges[np.maximum(previous_valid, 0)], default_range)
        right_ranges = np.where(
            next_valid < len(is_valid), scan.ranges[np.minimum(next_valid, len(is_valid) - 1)], default_range
        )
        scan.ranges[~is_valid] = ((left_ranges + right_ranges) / 2.0)[~is_valid]
        return scan


@dataclass(slots=True)
class MaskFilter(ScanFilter):
    """``LaserScanMaskFilter``: removes the ranges at the indices listed for the scan's frame."""

    masks: Mapping[str, Any]

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        indices = [int(index) for index in self.masks.get(scan.frame, ()) if 0 <= int(index) < len(scan.ranges)]
        scan.ranges[indices] = nan
        return scan


@dataclass(slots=True)
class ArrayFilter(ScanFilter):
    """``LaserArrayFilter``: replaces values with their median or mean over the last scans.

    The values are ranges and intensities.
    """

    range_filter_chain: Mapping[str, Any] = field(default_factory=dict)
    intensity_filter_chain: Mapping[str, Any] = field(default_factory=dict)
    _ranges: list[_Window] = field(init=False)
    _intensities: list[_Window] = field(init=False)

    def __post_init__(self) -> None:
        self._ranges = _make_windows(self.range_filter_chain)
        self._intensities = _make_windows(self.intensity_filter_chain)

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        for window in self._ranges:
            scan.ranges = window.add(scan.ranges)
        for window in self._intensities:
            scan.intensities = window.add(scan.intensities)
        return scan


class _Window:
    """The last arrays of a scan's values, and their median or mean."""

    def __init__(self, count: int, *, uses_median: bool) -> None:
        self._uses_median = uses_median
        self._arrays: deque[Floats] = deque(maxlen=count)

    def add(self, values: Floats) -> Floats:
        if self._arrays and len(self._arrays[0]) != len(values):
            self._arrays.clear()
        self._arrays.append(values.copy())
        ordered = np.sort(np.stack(self._arrays), axis=0)  # NaN is sorted to the end.
        if self._uses_median:
            # For an even count, use the larger of the two middle values, as the package filters does.
            median: Floats = ordered[len(ordered) // 2]
            return median.copy()
        return np.asarray(ordered.mean(axis=0), dtype=np.float32)


_ARRAY_FILTERS = ("MultiChannelMedianFilter", "MultiChannelMeanFilter")


def _make_windows(chain: Mapping[str, Any]) -> list[_Window]:
    windows = []
    for _, entry in sorted(chain.items()):
        type_name = str(entry.get("type", "")).rpartition("/")[2]
        count = entry.get("params", {}).get("number_of_observations", 1)
        if not type_name.startswith(_ARRAY_FILTERS) or not count >= 1:
            message = phrase(
                "filter '{kind}' does not exist for arrays, or does not support {count} observations",
                kind=type_name,
                count=count,
            )
            names = "filters/MultiChannelMedianFilterFloat, filters/MultiChannelMeanFilterFloat"
            raise LinkwrightError(Diagnostic("NODE451", message, hint=phrase("choose from {names}", names=names)))
        windows.append(_Window(int(count), uses_median="Median" in type_name))
    return windows
