"""Zones around a robot, as in nav2's collision_monitor.

A zone slows down, limits or stops the robot while sensor points are inside the zone.

Source: nav2_collision_monitor (``polygon.cpp``, ``collision_monitor_node.cpp``), Humble and Jazzy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.polygon import within_polygon
from linkwright.navigation.costmaps.footprints import Footprint
from linkwright.navigation.following.follower import Velocity

Points = NDArray[np.float64]
"""Points of sensors in the frame of the robot, in meters, of shape (points, 2)."""


class ZoneAction(IntEnum):
    """The actions of zones, numbered as in nav2_msgs/msg/CollisionMonitorState."""

    NOTHING = 0
    STOP = 1
    SLOWDOWN = 2
    APPROACH = 3
    LIMIT = 4


@dataclass(frozen=True, slots=True)
class Circle:
    """A circular zone around the origin of the robot.

    Attributes:
        radius: the radius in meters.
    """

    radius: float

    def contains(self, points: Points) -> NDArray[np.bool_]:
        """Return a mask of the points inside the circle, of shape (points,)."""
        is_inside: NDArray[np.bool_] = (points**2).sum(axis=1) < self.radius**2
        return is_inside


@dataclass(frozen=True, slots=True)
class Polygon:
    """A polygonal zone.

    Attributes:
        corners: the corners of the polygon in the frame of the robot, in meters.
    """

    corners: Footprint

    def contains(self, points: Points) -> NDArray[np.bool_]:
        """Return a mask of the points inside the polygon, of shape (points,)."""
        return within_polygon(points, self.corners)


Shape = Circle | Polygon


@dataclass(frozen=True, slots=True)
class ZoneRule:
    """The action of a zone and the action's parameters.

    Attributes:
        action: the action of the zone.
        min_points: the minimum number of points that count as an obstacle.
        slowdown_ratio: the factor applied to velocities, 0 to 1.
        linear_limit: the maximum linear speed, in m/s.
        angular_limit: the maximum angular speed, in rad/s.
        time_before_collision: how many seconds before a collision the robot starts to slow down.
        simulation_time_step: the time step of the collision check, in seconds.
    """

    action: ZoneAction
    min_points: int = 4
    slowdown_ratio: float = 0.5
    linear_limit: float = 0.5
    angular_limit: float = 0.5
    time_before_collision: float = 2.0
    simulation_time_step: float = 0.1

    def limit_velocity(self, shape: Shape, points: Points, velocity: Velocity) -> Velocity | None:
        """Return the permitted velocity, or None if the zone does not restrict `velocity`."""
        if self.action is ZoneAction.APPROACH:
            seconds = self._find_time_to_collision(shape, points, velocity)
            return None if seconds is None else _scale(velocity, seconds / self.time_before_collision)
        if self.action is ZoneAction.NOTHING or np.count_nonzero(shape.contains(points)) < self.min_points:
            return None
        if self.action is ZoneAction.STOP:
            return Velocity(0.0, 0.0, 0.0)
        if self.action is ZoneAction.SLOWDOWN:
            return _scale(velocity, self.slowdown_ratio)
        return _scale(velocity, self._compute_limit_ratio(velocity))

    def _compute_limit_ratio(self, velocity: Velocity) -> float:
        speed = hypot(velocity.x, velocity.y)
        linear_ratio = self.linear_limit / speed if speed else 1.0
        angular_ratio = self.angular_limit / abs(velocity.yaw) if velocity.yaw else 1.0
        return min(max(min(linear_ratio, angular_ratio), 0.0), 1.0)

    def _find_time_to_collision(self, shape: Shape, points: Points, velocity: Velocity) -> float | None:
        """Return the seconds until enough points are inside the shape at this velocity.

        Returns None if that does not happen within `time_before_collision`.
        """
        if not len(points):
            return None
        step, x, y, yaw = self.simulation_time_step, 0.0, 0.0, 0.0
        for count in range(int(self.time_before_collision / step + 1e-9) + 1):
            cosine, sine = np.cos(yaw), np.sin(yaw)
            relative_points = (points - (x, y)) @ np.array([[cosine, -sine], [sine, cosine]])
            if np.count_nonzero(shape.contains(relative_points)) >= self.min_points:
                return count * step
            x += float(velocity.x * cosine - velocity.y * sine) * step
            y += float(velocity.x * sine + velocity.y * cosine) * step
            yaw += velocity.yaw * step
        return None


@dataclass(frozen=True, slots=True)
class SpeedRange:
    """The shape of a zone for a range of velocities.

    Attributes:
        shape: the polygon that applies to velocities in these ranges.
        linear: the minimum and maximum velocity along x, in m/s; for a holonomic robot, the minimum and maximum speed
            in any direction.
        angular: the minimum and maximum angular velocity, in rad/s.
        direction: the range of directions in which a holonomic robot moves, counterclockwise, in rad; None for a robot
            that is not holonomic.
    """

    shape: Polygon
    linear: tuple[float, float]
    angular: tuple[float, float]
    direction: tuple[float, float] | None = None

    def covers(self, velocity: Velocity) -> bool:
        """Return whether a velocity is within the ranges, so that the shape applies."""
        speed = velocity.x if self.direction is None else hypot(velocity.x, velocity.y)
        if not self.linear[0] <= speed <= self.linear[1] or not self.angular[0] <= velocity.yaw <= self.angular[1]:
            return False
        if self.direction is None:
            return True
        (begin, end), angle = self.direction, atan2(velocity.y, velocity.x)
        return begin <= angle <= end if begin <= end else angle >= begin or angle <= end


@dataclass(frozen=True, slots=True)
class Verdict:
    """The combined result of all zones for a velocity.

    Attributes:
        velocity: the permitted velocity.
        action: the applied action.
        zone: the name of the zone that determined the action; empty if no zone acted.
    """

    velocity: Velocity
    action: ZoneAction = ZoneAction.NOTHING
    zone: str = ""


def limit_by_zones(velocity: Velocity, zones: Sequence[tuple[str, ZoneRule, Shape, Points]]) -> Verdict:
    """Limit a velocity by all zones, and return the lowest permitted velocity and its zone.

    After a zone that stops the robot, the remaining zones are not checked.

    Args:
        velocity: the requested velocity.
        zones: for each zone its name, rule and shape, and the points measured by its sensors.
    """
    verdict = Verdict(velocity)
    for name, rule, shape, points in zones:
        permitted = rule.limit_velocity(shape, points, velocity)
        if permitted is not None and (
            rule.action is ZoneAction.STOP or _squared_size(permitted) < _squared_size(verdict.velocity)
        ):
            verdict = Verdict(permitted, rule.action, name)
        if verdict.action is ZoneAction.STOP:
            break
    return verdict


def _scale(velocity: Velocity, ratio: float) -> Velocity:
    return Velocity(velocity.x * ratio, velocity.y * ratio, velocity.yaw * ratio)


def _squared_size(velocity: Velocity) -> float:
    return velocity.x**2 + velocity.y**2 + velocity.yaw**2
