"""Filters by the positions of points: angles, sectors, boxes and polygons."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import tau

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.polygon import within_polygon
from linkwright.perception.scans.scan import Flags, Lookup, Scan, ScanFilter, clear_ranges

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


@dataclass(slots=True)
class AngularBoundsFilter(ScanFilter):
    """``LaserScanAngularBoundsFilter``: keeps only the rays between two angles, which shortens the scan."""

    lower_angle: float = 0.0
    upper_angle: float = 0.0

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        angles = scan.angles
        inside = np.flatnonzero((angles >= self.lower_angle) & (angles <= self.upper_angle))
        if not len(inside):
            return None
        first, last = int(inside[0]), int(inside[-1])
        count = len(scan.ranges)
        scan.ranges = scan.ranges[first : last + 1]
        if len(scan.intensities) == count:
            scan.intensities = scan.intensities[first : last + 1]
        scan.angle_min, scan.angle_max = float(angles[first]), float(angles[last])
        scan.stamp_ns += round(first * scan.time_increment * 1e9)
        return scan


@dataclass(slots=True)
class AngularBoundsInPlaceFilter(ScanFilter):
    """``LaserScanAngularBoundsFilterInPlace``: removes the rays between two angles."""

    lower_angle: float = 0.0
    upper_angle: float = 0.0

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        angles = scan.angles
        return _set_beyond_range(scan, (angles > self.lower_angle) & (angles < self.upper_angle))


@dataclass(slots=True)
class SectorFilter(ScanFilter):
    """``LaserScanSectorFilter``: removes the ranges between two angles and two distances, or all others."""

    angle_min: float = 0.0
    angle_max: float = 0.0
    range_min: float = 0.0
    range_max: float = 100000.0
    clear_inside: bool = True
    invert: bool = False

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        width, offset = self.angle_max - self.angle_min, scan.angles - self.angle_min
        if width < 0.0:
            width += tau
            offset = np.where(offset < 0.0, offset + tau, offset)
        inside = (offset > 0.0) & (offset < width) & (scan.ranges > self.range_min) & (scan.ranges < self.range_max)
        return _set_beyond_range(scan, inside == (self.clear_inside and not self.invert))


@dataclass(slots=True)
class BoxFilter(ScanFilter):
    """``LaserScanBoxFilter``: removes the points in a box in a given frame, or, inverted, the points outside it."""

    box_frame: str
    min_x: float
    max_x: float
    min_y: float
    max_y: float
    min_z: float
    max_z: float
    invert: bool = False

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        points = scan.points(self.box_frame, lookup)
        if points is None:
            return None
        least, most = np.array((self.min_x, self.min_y, self.min_z)), np.array((self.max_x, self.max_y, self.max_z))
        inside = ((points > least) & (points < most)).all(axis=-1)
        return clear_ranges(scan, (inside != self.invert) & scan.measured)


@dataclass(slots=True)
class FootprintFilter(ScanFilter):
    """``LaserScanFootprintFilter``: removes the points above a square around the origin of ``base_link``."""

    inscribed_radius: float

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        points = scan.points("base_link", lookup)
        if points is None:
            return None
        return clear_ranges(scan, (np.abs(points[:, :2]) <= self.inscribed_radius).all(axis=-1) & scan.measured)


@dataclass(slots=True)
class PolygonFilter(ScanFilter):
    """``LaserScanPolygonFilter``: removes the points above a polygon in a given frame, or, inverted, all others."""

    polygon: str
    polygon_frame: str = "base_link"
    invert: bool = False
    polygon_padding: float = 0.0
    _corners: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        numbers = [float(value) for value in _NUMBER.findall(self.polygon)]
        if len(numbers) < 6 or len(numbers) % 2:
            message = phrase("polygon '{text}' has fewer than three corners", text=self.polygon)
            hint = phrase("write it like '[[0.2, 0.2], [0.2, -0.2], [-0.2, 0.0]]'")
            raise LinkwrightError(Diagnostic("NODE433", message, hint=hint))
        corners = np.array(numbers).reshape(-1, 2)
        # Move each coordinate away from the origin, as costmaps pad footprints.
        self._corners = corners + np.sign(corners) * self.polygon_padding

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        points = scan.points(self.polygon_frame, lookup)
        if points is None:
            return None
        return clear_ranges(scan, (within_polygon(points, self._corners) != self.invert) & scan.measured)


def _set_beyond_range(scan: Scan, which: Flags) -> Scan:
    """Return the scan with some ranges set beyond the maximum, and their intensities set to 0."""
    if len(scan.intensities) == len(which):
        scan.intensities[which] = 0.0
    return clear_ranges(scan, which, scan.range_max + 1.0)
