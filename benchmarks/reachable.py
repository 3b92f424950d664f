"""Whether two configurations of an arm are connected, by a search of its own that has nothing of the planner.

Some random pairs of configurations have no path: the arm collides with itself or an obstacle between them. They say
nothing about a planner. A path that is found proves that there is one.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

Configuration = NDArray[np.float64]

_REACH = 0.5
"""The maximum length of an edge of a tree in rad or m over all joints."""
_STEP = 0.02
"""The maximum distance between two checked configurations."""


class _Tree:
    """A tree of configurations that straight lines connect to its root."""

    def __init__(self, root: Configuration) -> None:
        self._configurations = [root]

    def extend(self, target: Configuration, is_free: Callable[[Configuration], bool]) -> tuple[Configuration, bool]:
        """Grow from the nearest configuration toward a target as far as it is free.

        Returns:
            The last configuration, and whether it is the target.
        """
        known = np.array(self._configurations)
        current = known[np.linalg.norm(known - target, axis=1).argmin()]
        while (distance := float(np.linalg.norm(target - current))) > 0.0:
            following = target if distance <= _REACH else current + (target - current) * (_REACH / distance)
            count = int(np.ceil(np.linalg.norm(following - current) / _STEP))
            if not all(is_free(current + (following - current) * (number / count)) for number in range(1, count + 1)):
                return current, False
            self._configurations.append(following)
            current = following
        return current, True


def has_path(
    start: Configuration,
    end: Configuration,
    sample: Callable[[], Configuration],
    is_free: Callable[[Configuration], bool],
    timeout_s: float,
) -> bool:
    """Return whether a path between two free configurations is found in time.

    Args:
        start: positions of the joints, shape (joints,).
        end: positions of the joints, shape (joints,).
        sample: returns random positions within the limits.
        is_free: returns whether positions are free of collisions.
        timeout_s: the maximum time in s.
    """
    growing, waiting = _Tree(start), _Tree(end)
    deadline = perf_counter() + timeout_s
    while perf_counter() < deadline:
        last, _ = growing.extend(sample(), is_free)
        if waiting.extend(last, is_free)[1]:
            return True
        growing, waiting = waiting, growing
    return False
