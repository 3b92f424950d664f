"""Whether a motion is free of collisions, also between the configurations that are checked.

Two shapes come nearer to each other by at most the distance that one of them moves in the frame of the other. Where
this is more than the distance between them, a motion is checked in smaller steps.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.collision_scene import CollisionScene, Nearness

RANGE_M = 0.003
"""The distance in m up to which shapes are near. Farther ones do not meet within a step of a motion."""
_MAX_SPLITS = 5
"""How many times a step is halved at most."""


class CheckedConfiguration(NamedTuple):
    """A configuration of a motion.

    Attributes:
        positions: the positions of all joints.
        distance: the smallest distance in m between shapes, at most the range; negative for a collision.
    """

    positions: Array
    distance: float


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
            if previous is not None:
                yield from self._checked_between(previous, sample, _MAX_SPLITS)
            yield sample.checked()
            previous = sample

    def _checked_between(self, first: _Sample, second: _Sample, splits: int) -> Iterator[CheckedConfiguration]:
        if not splits or not _can_meet(first.nearness, second.nearness):
            return
        middle = self._measure((first.positions + second.positions)[self._indexes] / 2.0)
        yield from self._checked_between(first, middle, splits - 1)
        yield middle.checked()
        yield from self._checked_between(middle, second, splits - 1)

    def _measure(self, configuration: Array) -> _Sample:
        positions = self._positions.copy()
        positions[self._indexes] = configuration
        return _Sample(positions, self._scene.measure_nearness(positions))


class _Sample(NamedTuple):
    positions: Array
    nearness: Nearness

    def checked(self) -> CheckedConfiguration:
        return CheckedConfiguration(self.positions, min(self.nearness.distances.values(), default=RANGE_M))


def _can_meet(first: Nearness, second: Nearness) -> bool:
    """Return whether two shapes may collide between two configurations."""
    for pair in first.distances.keys() | second.distances.keys():
        distance = first.distances.get(pair, RANGE_M) + second.distances.get(pair, RANGE_M)
        if distance < _relative_motion(first, second, *pair):
            return True
    return False


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
