"""Progress along a path: the part behind the robot, and the part ahead."""

from __future__ import annotations

from math import hypot

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.following.follower import lengths_along


class FollowedPath:
    """A path, and the robot's progress on it.

    The place of the robot is looked for only so far ahead of where it was, so that a path that crosses itself is
    driven in its order.

    Args:
        poses: of shape (poses, 3): x, y (metres) and yaw (radians); two at least.
        search: how far along the path the robot's place is looked for, in metres.
    """

    def __init__(self, poses: NDArray[np.float64], search: float) -> None:
        self.poses = poses
        self._lengths = lengths_along(poses)
        self._search = search
        self._index = 0

    def progress(self, x: float, y: float) -> None:
        """Update the progress by the robot's position, in metres."""
        limit = int(np.searchsorted(self._lengths, self._lengths[self._index] + self._search, side="right"))
        near = self.poses[self._index : max(limit, self._index + 1), :2]
        self._index += int(np.argmin((near[:, 0] - x) ** 2 + (near[:, 1] - y) ** 2))

    def ahead(self, distance: float) -> NDArray[np.float64]:
        """The poses ahead of the robot, up to a distance along the path in metres; two at least."""
        end = int(np.searchsorted(self._lengths, self._lengths[self._index] + distance, side="right"))
        first = min(self._index, len(self.poses) - 2)
        return self.poses[first : max(end, first + 2)]

    def remaining(self, x: float, y: float) -> float:
        """The distance along the path from a position to its end, in metres."""
        px, py = self.poses[self._index, :2]
        return hypot(px - x, py - y) + float(self._lengths[-1] - self._lengths[self._index])
