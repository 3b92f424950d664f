"""Boxes along the axes of a frame."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product

import numpy as np

from linkwright.geometry.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class Bounds:
    """A box along the axes of some frame: its lowest and highest corner in m, each of shape (3,)."""

    low: Array
    high: Array

    @property
    def size(self) -> Array:
        """The edges in m; shape (3,)."""
        edges: Array = self.high - self.low
        return edges

    @property
    def center(self) -> Array:
        """The middle in m; shape (3,)."""
        middle: Array = (self.low + self.high) / 2.0
        return middle

    @property
    def diagonal(self) -> float:
        """The distance of opposite corners in m."""
        return float(np.linalg.norm(self.size))

    def gap(self, other: Bounds) -> float:
        """How far two boxes are apart, in m; 0 where they touch."""
        apart = np.maximum(0.0, np.maximum(self.low - other.high, other.low - self.high))
        return float(np.linalg.norm(apart))

    def moved(self, matrix: Array) -> Bounds:
        """The box around this one in a parent frame; `matrix` is the frame in it, homogeneous, shape (4, 4)."""
        corners = np.array(list(product(*zip(self.low, self.high, strict=True))))
        return around(corners @ matrix[:3, :3].T + matrix[:3, 3])


def around(points: Array) -> Bounds:
    """The box around points; shape (points, 3)."""
    return Bounds(points.min(axis=0), points.max(axis=0))


def union(boxes: Iterable[Bounds]) -> Bounds | None:
    """The box around several; None without any."""
    listed = list(boxes)
    return around(np.array([corner for box in listed for corner in (box.low, box.high)])) if listed else None
