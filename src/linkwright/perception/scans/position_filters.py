"""Filters of scans by the positions of points: angles, sectors, boxes and polygons."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import tau

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.polygon import within_polygon
from linkwright.perception.scans.scan import Lookup, Mask, Scan, ScanFilter, replace_ranges

_NUMBER_PATTERN = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


@dataclass(slots=True)
class AngularBoundsFilter(ScanFilter):
    """``LaserScanAngularBoundsFilter``: shortens the scan to the rays between two angles."""

    lower_angle: float = 0.0
    upper_angle: float = 0.0

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        angles = scan.angles
        indices = np.flatnonzero((angles >= self.lower_angle) & (angles <= self.upper_angle))
        if not len(indices):
            return None
        first, last = int(indices[0]), int(indices[-1])
        count = len(scan.ranges)
        scan.ranges = scan.ranges[first : last + 1]
        if len(scan.intensities) == count:
            scan.intensities = scan.intensities[first : last + 1]
        scan.angle_min, scan.angle_max = float(angles[first]), float(angles[last])
        scan.stamp_ns += round(first * scan.time_increment * 1e9)
        return scan


@dataclass(slots=True)
class AngularBoundsInPlaceFilter(ScanFilter):
    """``LaserScanAngularBoundsFilterInPlace``: removes the ranges between two angles.

    The scan keeps its length.
    """

    lower_angle: float = 0.0
    upper_angle: float = 0.0

    def apply(self, scan: Scan, lookup: Lookup) -> Scan:
        angles = scan.angles
        return _set_beyond_range(scan, (angles > self.lower_angle) & (angles < self.upper_angle))


@dataclass(slots=True)
class SectorFilter(ScanFilter):
    """``LaserScanSectorFilter``: removes the ranges in a sector, or all others.

    Two angles and two distances bound the sector.
    """

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
        is_inside = (offset > 0.0) & (offset < width) & (scan.ranges > self.range_min) & (scan.ranges < self.range_max)
        return _set_beyond_range(scan, is_inside == (self.clear_inside and not self.invert))


@dataclass(slots=True)
class BoxFilter(ScanFilter):
    """``LaserScanBoxFilter``: removes the points in a box, or all others.

    The box is in ``box_frame``, in meters. With ``invert``, the points outside the box are removed.
    """

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
        minimum, maximum = (
            np.array((self.min_x, self.min_y, self.min_z)),
            np.array((self.max_x, self.max_y, self.max_z)),
        )
        is_inside = ((points > minimum) & (points < maximum)).all(axis=-1)
        return replace_ranges(scan, (is_inside != self.invert) & scan.measured_mask)


@dataclass(slots=True)
class FootprintFilter(ScanFilter):
    """``LaserScanFootprintFilter``: removes the points in a square around ``base_link``.

    The height of the points is ignored.
    """

    inscribed_radius: float

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        points = scan.points("base_link", lookup)
        if points is None:
            return None
        return replace_ranges(scan, (np.abs(points[:, :2]) <= self.inscribed_radius).all(axis=-1) & scan.measured_mask)


@dataclass(slots=True)
class PolygonFilter(ScanFilter):
    """``LaserScanPolygonFilter``: removes the points in a polygon, or all others.

    The height of the points is ignored. With ``invert``, the points outside the polygon are removed.
    """

    polygon: str
    polygon_frame: str = "base_link"
    invert: bool = False
    polygon_padding: float = 0.0
    _corners: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        numbers = [float(value) for value in _NUMBER_PATTERN.findall(self.polygon)]
        if len(numbers) < 6 or len(numbers) % 2:
            message = phrase(
                "polygon '{polygon}' must have three or more corners of two numbers each", polygon=self.polygon
            )
            hint = phrase("write a list of points, such as [[0.2, 0.2], [0.2, -0.2], [-0.2, 0.0]]")
            raise LinkwrightError(Diagnostic("NODE433", message, hint=hint))
        corners = np.array(numbers).reshape(-1, 2)
        # Move each coordinate away from the origin, as costmaps pad footprints.
        self._corners = corners + np.sign(corners) * self.polygon_padding

    def apply(self, scan: Scan, lookup: Lookup) -> Scan | None:
        points = scan.points(self.polygon_frame, lookup)
        if points is None:
            return None
        return replace_ranges(scan, (within_polygon(points, self._corners) != self.invert) & scan.measured_mask)


def _set_beyond_range(scan: Scan, mask: Mask) -> Scan:
    """Set some ranges beyond the maximum and their intensities to 0, and return the scan."""
    if len(scan.intensities) == len(mask):
        scan.intensities[mask] = 0.0
    return replace_ranges(scan, mask, scan.range_max + 1.0)
