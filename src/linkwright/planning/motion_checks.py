"""Whether a motion is free of collisions, also between the configurations that are checked.

Two shapes come nearer to each other by at most the distance that one of them moves in the frame of the other. Where
this is more than the distance between them, a motion is checked in smaller steps, unless the distance changes evenly:
neighboring links are often a few micrometers apart while they turn. A shape that dives into another one and out again
within a step changes the distance in the middle by at least the depth.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.collision_scene import ROUNDING_M, CollisionScene, Nearness

RANGE_M = 0.003
"""The distance in m up to which shapes are near. Farther ones do not meet within a step of a motion."""
_MAX_SPLITS = 7
"""How many times a step is halved at most."""
_TOLERANCE_M = 1e-6
"""The depth in m up to which shapes may collide without being noticed; MuJoCo's distances are not more accurate."""


class CheckedConfiguration(NamedTuple):
    """A configuration of a motion.

    Attributes:
        positions: the positions of all joints.
        distance: the smallest distance in m between shapes, at most the range; negative for a collision.
        is_reached_freely: whether certainly nothing collides on the way from the configuration before it.
    """

    positions: Array
    distance: float
    is_reached_freely: bool

    @property
    def collides(self) -> bool:
        """Whether shapes collide, and do not only touch."""
        return self.distance < -ROUNDING_M


class MotionCheck:
    """The check of motions of some joints.

    Args:
        scene: the robot among objects, which must measure distances up to `RANGE_M`.
        positions: the positions of all joints.
        indexes: the indexes of the joints that move.
    """

    def __init__(self, scene: CollisionScene, positions: Array, indexes: Array) -> None:
        self._scene, self._positions, self._indexes = scene, positions, indexes

    def check(self, motion: Iterable[Array]) -> Iterator[CheckedConfiguration]:
        """Yield the configurations of a motion, and more of them where shapes may meet between two of them.

        Args:
            motion: the positions of the joints that move, in small steps.
        """
        previous: _Sample | None = None
        for sample in map(self._measure, motion):
            if previous is None:
                yield sample.checked(is_reached_freely=True)
            else:
                yield from self._checked_until(previous, sample, _MAX_SPLITS)
            previous = sample

    def _checked_until(self, first: _Sample, last: _Sample, splits: int) -> Iterator[CheckedConfiguration]:
        """Yield the last configuration, after as many between both as are necessary."""
        pairs = _pairs_that_can_meet(first.nearness, last.nearness)
        if not pairs or not splits:
            yield last.checked(is_reached_freely=not pairs)
            return
        middle = self._measure((first.positions + last.positions)[self._indexes] / 2.0)
        if all(_changes_evenly(pair, first.nearness, middle.nearness, last.nearness) for pair in pairs):
            yield middle.checked(is_reached_freely=True)
            yield last.checked(is_reached_freely=True)
            return
        yield from self._checked_until(first, middle, splits - 1)
        yield from self._checked_until(middle, last, splits - 1)

    def _measure(self, configuration: Array) -> _Sample:
        positions = self._positions.copy()
        positions[self._indexes] = configuration
        return _Sample(positions, self._scene.measure_nearness(positions))


class _Sample(NamedTuple):
    positions: Array
    nearness: Nearness

    def checked(self, *, is_reached_freely: bool) -> CheckedConfiguration:
        distance = min(self.nearness.distances.values(), default=RANGE_M)
        return CheckedConfiguration(self.positions, distance, is_reached_freely)


def _pairs_that_can_meet(first: Nearness, last: Nearness) -> list[tuple[int, int]]:
    """Return the pairs of shapes that may collide between two configurations."""
    return [
        pair
        for pair in first.distances.keys() | last.distances.keys()
        if first.distances.get(pair, RANGE_M) + last.distances.get(pair, RANGE_M) + _TOLERANCE_M
        < _relative_motion(first, last, *pair)
    ]


def _changes_evenly(pair: tuple[int, int], first: Nearness, middle: Nearness, last: Nearness) -> bool:
    """Return whether the distance of a pair of shapes in the middle is the mean of those at both ends."""
    start, half, end = (nearness.distances.get(pair) for nearness in (first, middle, last))
    return start is not None and half is not None and end is not None and abs(half - (start + end) / 2) <= _TOLERANCE_M


def _relative_motion(first: Nearness, second: Nearness, larger: int, smaller: int) -> float:
    """Return an upper bound in m of the way of the smaller shape's points in the frame of the larger one."""
    (offset, rotation), (next_offset, next_rotation) = (
        (
            nearness.rotations[larger].T @ (nearness.centers[smaller] - nearness.centers[larger]),
            nearness.rotations[larger].T @ nearness.rotations[smaller],
        )
        for nearness in (first, second)
    )
    # The norm of the difference of two rotation matrices is at least the way of a point at a distance of 1 m.
    turn = np.linalg.norm(next_rotation - rotation)
    return float(np.linalg.norm(next_offset - offset) + turn * first.radii[smaller])
