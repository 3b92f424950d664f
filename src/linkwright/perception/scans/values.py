"""Filters by the values of a scan: ranges, intensities, indices, and values of previous scans."""

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
    """``LaserScanRangeFilter``: replaces ranges that are too small or too large."""

    lower_threshold: float = 0.0
    upper_threshold: float = 100000.0
    use_message_range_limits: bool = False
    lower_replacement_value: float = nan
    upper_replacement_value: float = nan

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        lower, upper = self.lower_threshold, self.upper_threshold
        if self.use_message_range_limits:
            lower, upper = scan.range_min, scan.range_max
        near, far = scan.ranges <= lower, scan.ranges >= upper
        scan.ranges[far] = self.upper_replacement_value
        scan.ranges[near] = self.lower_replacement_value
        return scan


@dataclass(slots=True)
class IntensityFilter(ScanFilter):
    """``LaserScanIntensityFilter``: removes points whose intensity is too small or too large."""

    lower_threshold: float = 8000.0
    upper_threshold: float = 100000.0
    disp_histogram: int = 0
    invert: bool = False
    filter_override_range: bool = True
    filter_override_intensity: bool = False

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        count = len(scan.intensities)
        outside = (scan.intensities <= self.lower_threshold) | (scan.intensities >= self.upper_threshold)
        taken = outside != self.invert
        if self.filter_override_range:
            scan.ranges[:count][taken] = nan
        if self.filter_override_intensity:
            scan.intensities[taken] = 0.0
        return scan


@dataclass(slots=True)
class InterpolationFilter(ScanFilter):
    """``InterpolationFilter``: fills gaps with the mean of the neighbouring ranges.

    A missing neighbour at an end of the scan counts as just below ``range_max``.
    """

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        far = scan.range_max - 0.01
        valid = (scan.ranges > scan.range_min) & (scan.ranges < scan.range_max)
        places = np.arange(len(valid))
        before = np.maximum.accumulate(np.where(valid, places, -1))
        after = np.minimum.accumulate(np.where(valid, places, len(valid))[::-1])[::-1]
        left = np.where(before >= 0, scan.ranges[np.maximum(before, 0)], far)
        right = np.where(after < len(valid), scan.ranges[np.minimum(after, len(valid) - 1)], far)
        scan.ranges[~valid] = ((left + right) / 2.0)[~valid]
        return scan


@dataclass(slots=True)
class MaskFilter(ScanFilter):
    """``LaserScanMaskFilter``: removes the ranges at given indices, which depend on the scan's frame."""

    masks: Mapping[str, Any]

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        places = [int(place) for place in self.masks.get(scan.frame, ()) if 0 <= int(place) < len(scan.ranges)]
        scan.ranges[places] = nan
        return scan


@dataclass(slots=True)
class ArrayFilter(ScanFilter):
    """``LaserArrayFilter``: computes the median or mean of the last scans' ranges and intensities."""

    range_filter_chain: Mapping[str, Any] = field(default_factory=dict)
    intensity_filter_chain: Mapping[str, Any] = field(default_factory=dict)
    _ranges: list[_Window] = field(init=False)
    _intensities: list[_Window] = field(init=False)

    def __post_init__(self) -> None:
        self._ranges = _windows(self.range_filter_chain)
        self._intensities = _windows(self.intensity_filter_chain)

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        for window in self._ranges:
            scan.ranges = window.add(scan.ranges)
        for window in self._intensities:
            scan.intensities = window.add(scan.intensities)
        return scan


class _Window:
    """A window of the last lists of numbers, and their median or mean."""

    def __init__(self, count: int, *, median: bool) -> None:
        self._median = median
        self._last: deque[Floats] = deque(maxlen=count)

    def add(self, values: Floats) -> Floats:
        if self._last and len(self._last[0]) != len(values):
            self._last.clear()
        self._last.append(values.copy())
        several = np.sort(np.stack(self._last), axis=0)  # NaN is sorted to the end.
        if self._median:
            # For an even count, use the larger of the two middle values, as the package filters does.
            chosen: Floats = several[len(several) // 2]
            return chosen.copy()
        return np.asarray(several.mean(axis=0), dtype=np.float32)


_OF_LISTS = ("MultiChannelMedianFilter", "MultiChannelMeanFilter")


def _windows(chain: Mapping[str, Any]) -> list[_Window]:
    windows = []
    for _, each in sorted(chain.items()):
        kind = str(each.get("type", "")).rpartition("/")[2]
        count = each.get("params", {}).get("number_of_observations", 1)
        if not kind.startswith(_OF_LISTS) or not count >= 1:
            message = phrase(
                "no filter '{kind}' of lists of numbers supports {count} observations", kind=kind, count=count
            )
            known = "filters/MultiChannelMedianFilterFloat, filters/MultiChannelMeanFilterFloat"
            raise LinkwrightError(Diagnostic("NODE451", message, hint=phrase("choose from {known}", known=known)))
        windows.append(_Window(int(count), median="Median" in kind))
    return windows
