"""Path following by sampling velocities: each is simulated for some time, and the best one is commanded.

This follower replaces both of nav2's sampling controllers, DWB and MPPI. Limits and times use the parameter names of
either; the scoring of the sampled motions is Linkwright's own.

Source: Fox, Burgard, Thrun, "The Dynamic Window Approach to Collision Avoidance" (1997).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.costmaps.costmap import INSCRIBED, UNKNOWN
from linkwright.navigation.following.follower import (
    Follower,
    FollowingError,
    Situation,
    Velocity,
    lengths_along,
    limited,
    predict_poses,
    to_robot_frame,
    wrapped,
)
from linkwright.navigation.following.pure_pursuit import is_free, rotation_speed

_LEAST, _MOST, _CHANGE = Velocity(0.0, 0.0, -1.0), Velocity(0.26, 0.0, 1.0), Velocity(2.5, 0.0, 3.2)


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of velocity and acceleration, in m/s, rad/s, m/s^2 and rad/s^2.

    Attributes:
        least: the minimum velocities along x, along y and about z.
        most: the maximum velocities along x, along y and about z.
        acceleration: the maximum acceleration of each velocity.
        deceleration: the maximum deceleration of each velocity; positive.
    """

    least: Velocity = _LEAST
    most: Velocity = _MOST
    acceleration: Velocity = _CHANGE
    deceleration: Velocity = _CHANGE


@dataclass(frozen=True, kw_only=True)
class SamplingParameters:
    """Settings of the sampling.

    Attributes:
        limits: the limits of the robot.
        samples: the number of velocities sampled along x, along y and about z.
        seconds: how long each motion is simulated.
        steps: the number of simulation steps.
        off_path: the cost per metre of distance from the path, in metres of the path.
        off_heading: the cost per radian of deviation from the direction of the path ahead, in metres of the path.
        near_obstacle: the weight of the highest cost that the motion touches in the costmap.
        turn_first: the angle to the path above which the robot turns in place, in radians.
    """

    limits: Limits = field(default_factory=Limits)
    samples: tuple[int, int, int] = (7, 5, 15)
    seconds: float = 1.7
    steps: int = 12
    off_path: float = 1.0
    off_heading: float = 0.12
    near_obstacle: float = 0.4
    turn_first: float = 1.2


_MOST_FOOTPRINTS = 60
"""The number of best velocities that are checked with the footprint, which takes longer."""
_LOOK_AHEAD = 0.35
"""The distance in metres along the path, ahead of a motion's end, that the robot should face."""


class SamplingFollower(Follower):
    """A path follower that samples velocities."""

    def __init__(self, parameters: SamplingParameters | None = None) -> None:
        self.parameters = parameters or SamplingParameters()
        self._top = self.parameters.limits.most.x
        self._turns = False

    def begin(self) -> None:
        """Reset for a new path."""
        self._turns = False

    def limit_speed(self, speed: float, *, is_percentage: bool = False) -> None:
        """Limit the speed; see `Follower.limit_speed`."""
        self._top = limited(self.parameters.limits.most.x, speed, is_percentage=is_percentage)

    def velocity(self, situation: Situation) -> Velocity:
        """Return the velocity for the next cycle; see `Follower.velocity`."""
        x, y, yaw = situation.pose
        goal = situation.path[-1]
        if hypot(goal[0] - x, goal[1] - y) < situation.xy_tolerance:
            return self._checked_turn(wrapped(float(goal[2]) - yaw), situation)
        angle = self._angle_to_path(situation)
        self._turns = abs(angle) > (self.parameters.turn_first / 3.0 if self._turns else self.parameters.turn_first)
        if self._turns and self.parameters.limits.most.y <= 0.0:
            return self._checked_turn(angle, situation)
        return self._best(situation)

    def _angle_to_path(self, situation: Situation) -> float:
        seen = to_robot_frame(situation.pose, situation.path[:, :2])
        index = min(int(np.searchsorted(lengths_along(situation.path), _LOOK_AHEAD)), len(seen) - 1)
        return atan2(float(seen[index, 1]), float(seen[index, 0]))

    def _checked_turn(self, angle: float, situation: Situation) -> Velocity:
        """Return the velocity to rotate in place by an angle, after a check for collisions.

        Raises:
            FollowingError: an obstacle is in the way.
        """
        limits, now = self.parameters.limits, situation.velocity
        wanted = Velocity(
            _brake(now.x, limits.deceleration.x, situation.period),
            _brake(now.y, limits.deceleration.y, situation.period),
            rotation_speed(angle, now.yaw, situation.period, limits.most.yaw, limits.acceleration.yaw),
        )
        turning = abs(wanted.yaw)
        seconds = min(self.parameters.seconds, abs(angle) / turning) if turning > 0.0 else 0.0
        if not is_free(situation, wanted, seconds):
            raise FollowingError("there is an obstacle where the robot would turn")
        return wanted

    def _best(self, situation: Situation) -> Velocity:
        """Return the next cycle's velocity towards the best collision-free candidate.

        Footprints are checked in the order of the scores, best first.

        Raises:
            FollowingError: every candidate that was checked leads to a collision.
        """
        parameters = self.parameters
        candidates = self._candidates(situation)
        ways = predict_poses(situation.pose, candidates, np.linspace(0.0, parameters.seconds, parameters.steps + 1)[1:])
        costs = situation.costmap.cost_at(ways[..., :2]).astype(np.float64)
        costs[costs == UNKNOWN] = 0.0
        highest: NDArray[np.float64] = costs.max(axis=1)
        free = np.flatnonzero(highest < INSCRIBED)
        judged = self._motion_costs(ways[free], highest[free] / INSCRIBED, situation)
        for index in free[np.argsort(judged)][:_MOST_FOOTPRINTS]:
            best = Velocity(*map(float, candidates[index]))
            if highest[index] <= 0.0 or is_free(situation, best, parameters.seconds):
                return self._reachable(best, situation)
        raise FollowingError("every velocity that was tried leads into an obstacle")

    def _candidates(self, situation: Situation) -> NDArray[np.float64]:
        """Return velocities that are reachable within the simulated time, of shape (candidates, 3)."""
        parameters, limits = self.parameters, self.parameters.limits
        highest = (min(limits.most.x, self._top), limits.most.y, limits.most.yaw)
        axes = []
        for axis, count in enumerate(parameters.samples):
            now, change = situation.velocity[axis], limits.acceleration[axis] * parameters.seconds
            low, high = max(limits.least[axis], now - change), min(highest[axis], now + change)
            values = np.linspace(low, max(low, high), count if high > low else 1)
            axes.append(np.append(values, 0.0) if low < 0.0 < high else values)
        mesh = np.meshgrid(*axes, indexing="ij")
        candidates: NDArray[np.float64] = np.stack([axis_samples.ravel() for axis_samples in mesh], axis=-1)
        return candidates

    def _reachable(self, wanted: Velocity, situation: Situation) -> Velocity:
        """Return the velocity that the robot can reach in the next cycle towards a wanted one.

        All components complete the same share of their change.
        """
        limits, now, period = self.parameters.limits, situation.velocity, situation.period
        share = 1.0
        for before, after, faster, slower in zip(now, wanted, limits.acceleration, limits.deceleration, strict=True):
            change = (slower if abs(after) < abs(before) else faster) * period
            if abs(after - before) > change:
                share = min(share, change / abs(after - before))
        return Velocity(*(before + share * (after - before) for before, after in zip(now, wanted, strict=True)))

    def _motion_costs(
        self, ways: NDArray[np.float64], costs: NDArray[np.float64], situation: Situation
    ) -> NDArray[np.float64]:
        """Return the costs of motions, in metres of the path, of shape (motions,).

        `ways` are the predicted poses, and `costs` are the highest costs in the costmap, from 0 to 1.
        """
        parameters = self.parameters
        path = situation.path
        lengths = lengths_along(path)
        checked = ways[:, [parameters.steps // 2, -1], :2]
        squared = ((checked[:, :, None] - path[None, None, :, :2]) ** 2).sum(axis=-1)
        nearest = squared.argmin(axis=-1)
        beside = np.sqrt(np.take_along_axis(squared, nearest[..., None], axis=-1))[..., 0].sum(axis=1)
        ends = nearest[:, 1]
        left = lengths[-1] - lengths[ends]
        at_end = np.hypot(*(ways[:, -1, :2] - path[-1, :2]).T)
        left = np.where(ends == len(path) - 1, at_end, left)
        ahead = np.minimum(np.searchsorted(lengths, lengths[ends] + _LOOK_AHEAD), len(path) - 1)
        towards = path[ahead, :2] - ways[:, -1, :2]
        turn = np.arctan2(towards[:, 1], towards[:, 0]) - ways[:, -1, 2]
        turn = np.abs(np.arctan2(np.sin(turn), np.cos(turn)))
        turn[np.hypot(towards[:, 0], towards[:, 1]) < _NO_WAY] = 0.0
        judged: NDArray[np.float64] = (
            left + parameters.off_path * beside + parameters.off_heading * turn + parameters.near_obstacle * costs
        )
        return judged


def _brake(speed: float, deceleration: float, period: float) -> float:
    """Return the speed after one cycle of braking, in m/s."""
    return float(np.sign(speed)) * max(0.0, abs(speed) - deceleration * period)


_NO_WAY = 0.05
"""The least distance in metres from which a direction follows."""
