"""Drives by command, without a limit or for a time, a distance or an angle.

Odometry measures distances and angles if it is available.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, hypot, pi, tau
from typing import Any, Literal, TypeAlias

from linkwright.graph import Node
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.speech.commands.actions import Drive, Values, resolve_amount

_STEP_S = 0.05
_MAX_STEP_S = 0.2
_MAX_ODOMETRY_AGE_S = 0.5
"""The maximum age of odometry in s. Without fresh odometry, the distance is computed from the commands."""
_SPEED_GAIN = 3.0
"""The speed divided by the remaining distance, near the end, in 1/s."""
_MIN_SPEED_FRACTION = 0.15
"""The minimum fraction of the speed, however short the remaining distance is."""
_TOLERANCES = {"distance": 0.005, "angle": 0.005}
"""The remaining distance in m or angle in rad at which a drive is finished."""
_MAX_DURATION_RATIO = 3.0
"""The maximum duration of a drive, as a multiple of the expected duration, to which 3 s are added."""
_SCALE_RANGE = 0.2, 4.0

Ending: TypeAlias = Literal["done", "stuck"]


class Driver:
    """A controller that publishes the velocities of a drive until its limit is reached.

    A distance or an angle is measured with ``odom`` (nav_msgs/msg/Odometry). Without odometry, the distance or angle is
    computed from speed and time. Time is the node's time, which may be simulated.

    Args:
        node: the node that publishes.
        topic: the topic of the velocities.
        speed: the speed in m/s.
        turn_speed: the turning speed in rad/s.
        on_end: called with ``done`` when a drive has reached its limit, or with ``stuck`` when it takes far too long.
    """

    def __init__(
        self, node: Node, topic: VelocityTopic, speed: float, turn_speed: float, on_end: Callable[[Ending], None]
    ) -> None:
        self._node, self._topic, self._on_end = node, topic, on_end
        self._speed, self._turn_speed = speed, turn_speed
        self._initial_speed, self._scale = speed, 1.0
        self._drive: Drive | None = None
        self._odometer = _Odometer()
        node.create_subscription("nav_msgs/msg/Odometry", "odom", self._on_odometry, 10)
        self._timer = node.create_timer(_STEP_S, self._step, autostart=False)

    @property
    def is_moving(self) -> bool:
        """Whether the robot is driving."""
        return self._drive is not None

    @property
    def is_endless(self) -> bool:
        """Whether the robot is driving without a limit."""
        return self._drive is not None and self._remaining is None

    def begin(self, drive: Drive, values: Values) -> None:
        """Start a drive, replacing the current one.

        Args:
            drive: the command.
            values: the values of its slots.
        """
        self._topic.update_type(may_change=self._drive is None)
        self._drive = drive
        amounts = {"duration": drive.duration, "distance": drive.distance, "angle": drive.angle}
        limits = [(name, resolve_amount(limit, values)) for name, limit in amounts.items() if limit is not None]
        self._kind, self._remaining = limits[0] if limits else ("", None)
        self._last_step_ns = self._now_ns()
        self._deadline_ns = self._last_step_ns + round(
            (3.0 + _MAX_DURATION_RATIO * self._compute_expected_seconds()) * 1e9
        )
        self._odometer.pop(self._kind)
        self._publish(1.0)
        self._timer.reset()

    def stop(self) -> None:
        """Stop the robot.

        A zero velocity is published even if it does not move.
        """
        self._drive = None
        self._timer.cancel()
        self._topic.update_type(may_change=False)
        self._topic.stop()

    def scale_speed(self, factor: float) -> float:
        """Multiply the speeds by a factor, within bounds, and return the total factor."""
        self._scale = min(max(self._scale * factor, _SCALE_RANGE[0]), _SCALE_RANGE[1])
        return self._scale

    def set_speed(self, speed: float) -> float:
        """Set the speed in m/s, within bounds, and return the speed that now applies."""
        self.scale_speed(speed / (self._initial_speed * self._scale))
        return self._initial_speed * self._scale

    def _on_odometry(self, message: Any) -> None:
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        yaw = atan2(
            2.0 * (orientation.w * orientation.z + orientation.x * orientation.y),
            1.0 - 2.0 * (orientation.y * orientation.y + orientation.z * orientation.z),
        )
        self._odometer.add_message(self._now_ns(), position.x, position.y, yaw)

    def _step(self) -> None:
        if self._drive is None:
            return
        now_ns = self._now_ns()
        elapsed = min(max((now_ns - self._last_step_ns) * 1e-9, 0.0), _MAX_STEP_S)
        self._last_step_ns = now_ns
        if self._remaining is None:
            self._publish(1.0)
            return
        rate = self._compute_progress_rate()
        measured = self._odometer.pop(self._kind) if self._odometer.is_fresh(now_ns) else None
        progress = (
            elapsed if self._kind == "duration" else rate * self._part * elapsed if measured is None else measured
        )
        self._remaining -= progress
        if self._remaining <= _TOLERANCES.get(self._kind, 0.0):
            self._finish("done")
        elif self._kind != "duration" and now_ns > self._deadline_ns:
            self._finish("stuck")
        else:
            self._publish(
                1.0
                if self._kind == "duration"
                else min(1.0, max(_SPEED_GAIN * self._remaining / rate, _MIN_SPEED_FRACTION))
            )

    def _finish(self, ending: Ending) -> None:
        self.stop()
        self._on_end(ending)

    def _compute_progress_rate(self) -> float:
        """Return the rate at which the distance or angle is covered, in m/s or rad/s."""
        assert self._drive is not None, "it drives"
        if self._kind == "angle":
            return abs(self._drive.turn) * self._turn_speed * self._scale
        return hypot(self._drive.x, self._drive.y) * self._speed * self._scale

    def _compute_expected_seconds(self) -> float:
        """Return the expected duration in s of a drive over a distance or angle, or 0 for others."""
        return (
            self._remaining / self._compute_progress_rate()
            if self._remaining is not None and self._kind != "duration"
            else 0.0
        )

    def _publish(self, share: float) -> None:
        """Publish a fraction of the velocity of the drive."""
        assert self._drive is not None, "it drives"
        self._part = share
        speed, turn = share * self._speed * self._scale, share * self._turn_speed * self._scale
        self._topic.publish((self._drive.x * speed, self._drive.y * speed, 0.0), (0.0, 0.0, self._drive.turn * turn))

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds


class _Odometer:
    """The sum of the motion between two calls of `pop`."""

    def __init__(self) -> None:
        self._last_ns: int | None = None
        self._pose: tuple[float, float, float] | None = None
        self._motion = {"distance": 0.0, "angle": 0.0}

    def add_message(self, now_ns: int, x: float, y: float, yaw: float) -> None:
        if self._pose is not None:
            self._motion["distance"] += hypot(x - self._pose[0], y - self._pose[1])
            self._motion["angle"] += abs((yaw - self._pose[2] + pi) % tau - pi)
        self._last_ns, self._pose = now_ns, (x, y, yaw)

    def is_fresh(self, now_ns: int) -> bool:
        return self._last_ns is not None and 0 <= now_ns - self._last_ns < _MAX_ODOMETRY_AGE_S * 1e9

    def pop(self, kind: str) -> float:
        amount = self._motion.get(kind, 0.0)
        self._motion = {"distance": 0.0, "angle": 0.0}
        return amount
