"""Joint positions that no path can pass, because the links up to this joint always collide there.

The base of a robot often forbids some positions of the second or third joint, whatever the joints before it do. Two
configurations on both sides of such a position have no path between them, and a search would only end by its time
limit. A barrier is found by random positions of the joints before it, so a passage that is much smaller than one in a
thousand configurations counts as closed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.effort import CHECK_S, spend
from linkwright.planning.groups import JointGroup

_STEP = 0.05
"""The distance in rad or m between two positions of a joint that are examined."""
_SAMPLES = 1000
"""The number of configurations that all collide at a barrier."""


class Barrier(NamedTuple):
    """A position of a joint that the robot cannot pass.

    Attributes:
        position: in rad or m.
        pair: the two links or objects that collide there most often.
        is_only_pair: whether they always collide there.
    """

    joint: str
    position: float
    pair: tuple[str, str]
    is_only_pair: bool

    def __str__(self) -> str:
        first, second = self.pair
        pair = f"'{first}' and '{second}' collide"
        where = f"where {pair}" if self.is_only_pair else f"where links collide, such as '{first}' and '{second}'"
        return f"'{self.joint}' cannot pass {self.position:.2f}, {where}"


class Barriers:
    """The search for barriers between a start and goals.

    Continuous joints are left out, because they reach a position in two directions.

    Args:
        scene: the robot among objects.
        group: the joints to move.
        indexes: the indexes of the group's joints in the positions of all joints.
        start: the positions of all joints at the start.
    """

    def __init__(self, scene: CollisionScene, group: JointGroup, indexes: Array, start: Array) -> None:
        self._scene, self._group, self._indexes, self._start = scene, group, indexes, start
        self._random = np.random.default_rng(0)
        self._found: dict[tuple[int, int], Barrier | None] = {}
        self._shapes: dict[int, NDArray[np.bool_]] = {}

    def find(self, goal: Array) -> Barrier | None:
        """Return a barrier between the start and a goal, the positions of all joints, or None."""
        for number in range(len(self._indexes)):
            if self._group.is_continuous[number]:
                continue
            index = self._indexes[number]
            first, last = sorted((float(self._start[index]), float(goal[index])))
            for step in range(int(np.ceil(first / _STEP)), int(np.floor(last / _STEP)) + 1):
                key = number, step
                if key not in self._found:
                    self._found[key] = self._examine(number, step * _STEP)
                if (barrier := self._found[key]) is not None:
                    return barrier
        return None

    def _examine(self, number: int, position: float) -> Barrier | None:
        """Return the barrier at a position of a joint of the group, or None."""
        pairs: Counter[tuple[str, str]] = Counter()
        for pair in self._colliding_pairs(number, position):
            if pair is None:
                return None
            pairs[pair] += 1
        pair, count = pairs.most_common(1)[0]
        return Barrier(self._group.joint_names[number], position, pair, count == pairs.total())

    def _colliding_pairs(self, number: int, position: float) -> Iterable[tuple[str, str] | None]:
        """Yield what collides, or None, in random configurations of the joints before one."""
        shapes = self._shapes_up_to(number)
        positions = self._start.copy()
        positions[self._indexes[number]] = position
        for _ in range(_SAMPLES if number else 1):
            spend(CHECK_S)
            positions[self._indexes[:number]] = self._group.sample(self._random)[:number]
            yield self._scene.find_colliding_pair(positions, shapes)

    def _shapes_up_to(self, number: int) -> NDArray[np.bool_]:
        """Return which shapes stay where they are when the joints after one move, shape (shapes,)."""
        if number not in self._shapes:
            later = self._indexes[number + 1 :]
            positions = self._start.copy()
            before = self._scene.shape_frames(positions)
            positions[later] = self._group.sample(self._random)[number + 1 :]
            self._shapes[number] = np.all(np.abs(self._scene.shape_frames(positions) - before) < 1e-9, axis=1)
        return self._shapes[number]
