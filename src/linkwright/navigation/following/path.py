"""A path and the robot's progress along it."""

from __future__ import annotations

from math import hypot

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.following.follower import compute_distances_along


class FollowedPath:
    """A path and the robot's progress along it.

    The robot is searched for only within a limited distance ahead of its last position, so a path that crosses itself
    is followed in order.

    Args:
        poses: the poses of the path, of shape (poses, 3): x, y (meters) and yaw (radians); at least two.
        search_distance: how far ahead along the path the robot is searched for, in meters.
    """

    def __init__(self, poses: NDArray[np.float64], search_distance: float) -> None:
        self.poses = poses
        self._lengths = compute_distances_along(poses)
        self._search_distance = search_distance
        self._index = 0

    def update_progress(self, x: float, y: float) -> None:
        """Update the progress from the robot's position, in meters."""
        end = int(np.searchsorted(self._lengths, self._lengths[self._index] + self._search_distance, side="right"))
        nearby_points = self.poses[self._index : max(end, self._index + 1), :2]
        self._index += int(np.argmin((nearby_points[:, 0] - x) ** 2 + (nearby_points[:, 1] - y) ** 2))

    def get_poses_ahead(self, distance: float) -> NDArray[np.float64]:
        """Return the poses from the robot up to a distance, in meters, ahead along the path.

        The result contains at least two poses.
        """
        end = int(np.searchsorted(self._lengths, self._lengths[self._index] + distance, side="right"))
        first = min(self._index, len(self.poses) - 2)
        return self.poses[first : max(end, first + 2)]

    def compute_remaining_distance(self, x: float, y: float) -> float:
        """Return the remaining distance from a position along the path to its end, in meters."""
        px, py = self.poses[self._index, :2]
        return hypot(px - x, py - y) + float(self._lengths[-1] - self._lengths[self._index])
