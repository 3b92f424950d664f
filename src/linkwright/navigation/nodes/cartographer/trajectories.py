"""The trajectories of a map, each with its state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.navigation.slam.poses import FloatArray

ACTIVE, FINISHED = 0, 1
"""States of cartographer_ros_msgs/TrajectoryStates."""
STATE_NAMES = ("ACTIVE", "FINISHED", "FROZEN", "DELETED")


@dataclass(slots=True)
class Trajectory:
    """A drive of the robot.

    Attributes:
        first: the number of the first scan of the trajectory in the graph.
        state: `ACTIVE` or `FINISHED`.
    """

    first: int
    state: int = ACTIVE


class Trajectories:
    """The trajectories in the order of their starts; at most one is active."""

    def __init__(self) -> None:
        self._all: list[Trajectory] = []

    @property
    def states(self) -> list[int]:
        """The states of all trajectories."""
        return [trajectory.state for trajectory in self._all]

    @property
    def active(self) -> int | None:
        """The number of the active trajectory, or None."""
        return len(self._all) - 1 if self._all and self._all[-1].state == ACTIVE else None

    def add(self, first: int) -> int:
        """Start a trajectory with a scan of the given number, and return the number of the trajectory."""
        self._all.append(Trajectory(first))
        return len(self._all) - 1

    def finish(self) -> None:
        """Finish the active trajectory."""
        if self.active is not None:
            self._all[-1].state = FINISHED

    def start_over(self) -> None:
        """Forget the finished trajectories, and let the active one start again."""
        self._all = [Trajectory(0)] if self.active is not None else []

    def split(self, poses: FloatArray) -> list[FloatArray]:
        """Return the poses of each trajectory, from those of all scans, of shape (n, 3)."""
        return np.split(poses, [min(trajectory.first, len(poses)) for trajectory in self._all[1:]]) if self._all else []
