"""Drive by commands: without an end, or for a time, a distance or an angle, measured by odometry if available."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, hypot, pi, tau
from typing import Any, Literal, TypeAlias

from linkwright.graph import Node
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.speech.commands.actions import Drive, Values, amount

_PERIOD = 0.05
_LONGEST_STEP = 0.2
_FRESH = 0.5
"""s: older odometry is ignored; the distance is then computed from the commands."""
_GAIN = 3.0
"""1/s: the ratio of speed to remaining distance, near the end."""
_SLOWEST = 0.15
"""The least share of the speed, however short the remaining distance."""
_CLOSE = {"distance": 0.005, "angle": 0.005}
"""m and rad: less is done."""
_PATIENCE = 3.0
"""A way takes no more times as long as it should, and 3 s."""
_SCALES = 0.2, 4.0

Ending: TypeAlias = Literal["done", "stuck"]


class Driver:
    """Publishes velocities.

    A distance or an angle is measured by ``odom`` (nav_msgs/msg/Odometry) if it is received; otherwise it is the speed
    multiplied by the time. Time is the node's time, which may be simulated.

    Args:
        node: the node that publishes.
        topic: the topic of the velocities.
        speed: the speed in m/s.
        turn_speed: the turning speed in rad/s.
        ended: called when a drive is finished or takes far too long.
    """

    def __init__(
        self, node: Node, topic: VelocityTopic, speed: float, turn_speed: float, ended: Callable[[Ending], None]
    ) -> None:
        self._node, self._topic, self._ended = node, topic, ended
        self._speed, self._turn_speed = speed, turn_speed
        self._usual_speed, self._scale = speed, 1.0
        self._drive: Drive | None = None
        self._odometer = _Odometer()
        node.create_subscription("nav_msgs/msg/Odometry", "odom", self._on_odometry, 10)
        self._timer = node.create_timer(_PERIOD, self._step, autostart=False)

    @property
    def is_moving(self) -> bool:
        """Whether the robot is driving."""
        return self._drive is not None

    @property
    def is_endless(self) -> bool:
        """Whether the robot is driving without an end."""
        return self._drive is not None and self._left is None

    def begin(self, drive: Drive, values: Values) -> None:
        """Start a drive, which replaces the previous one.

        Args:
            drive: the command.
            values: the values of its slots.
        """
        self._topic.review(may_change=self._drive is None)
        self._drive = drive
        amounts = {"duration": drive.duration, "distance": drive.distance, "angle": drive.angle}
        given = [(name, amount(each, values)) for name, each in amounts.items() if each is not None]
        self._kind, self._left = given[0] if given else ("", None)
        self._at_ns = self._now_ns()
        self._limit_ns = self._at_ns + round((3.0 + _PATIENCE * self._expected()) * 1e9)
        self._odometer.pop(self._kind)
        self._publish(1.0)
        self._timer.reset()

    def stop(self) -> None:
        """Stop the robot; a zero velocity is published even if it does not move."""
        self._drive = None
        self._timer.cancel()
        self._topic.review(may_change=False)
        self._topic.stop()

    def scale(self, factor: float) -> float:
        """Scale the speed within bounds; return the factor that now applies to all speeds."""
        self._scale = min(max(self._scale * factor, _SCALES[0]), _SCALES[1])
        return self._scale

    def set_speed(self, speed: float) -> float:
        """Set the speed in m/s; return the speed within the bounds."""
        self.scale(speed / (self._usual_speed * self._scale))
        return self._usual_speed * self._scale

    def _on_odometry(self, message: Any) -> None:
        position, q = message.pose.pose.position, message.pose.pose.orientation
        yaw = atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
        self._odometer.hear(self._now_ns(), position.x, position.y, yaw)

    def _step(self) -> None:
        if self._drive is None:
            return
        now_ns = self._now_ns()
        seconds = min(max((now_ns - self._at_ns) * 1e-9, 0.0), _LONGEST_STEP)
        self._at_ns = now_ns
        if self._left is None:
            self._publish(1.0)
            return
        rate = self._rate()
        measured = self._odometer.pop(self._kind) if self._odometer.is_fresh(now_ns) else None
        done = seconds if self._kind == "duration" else rate * self._part * seconds if measured is None else measured
        self._left -= done
        if self._left <= _CLOSE.get(self._kind, 0.0):
            self._finish("done")
        elif self._kind != "duration" and now_ns > self._limit_ns:
            self._finish("stuck")
        else:
            self._publish(1.0 if self._kind == "duration" else min(1.0, max(_GAIN * self._left / rate, _SLOWEST)))

    def _finish(self, ending: Ending) -> None:
        self.stop()
        self._ended(ending)

    def _rate(self) -> float:
        """Return the rate at which the distance or angle is covered."""
        assert self._drive is not None, "it drives"
        if self._kind == "angle":
            return abs(self._drive.turn) * self._turn_speed * self._scale
        return hypot(self._drive.x, self._drive.y) * self._speed * self._scale

    def _expected(self) -> float:
        """Return the expected duration in seconds of a distance or angle."""
        return self._left / self._rate() if self._left is not None and self._kind != "duration" else 0.0

    def _publish(self, part: float) -> None:
        """Publish the velocity of the drive, scaled by a factor."""
        assert self._drive is not None, "it drives"
        self._part = part
        speed, turn = part * self._speed * self._scale, part * self._turn_speed * self._scale
        self._topic.publish((self._drive.x * speed, self._drive.y * speed, 0.0), (0.0, 0.0, self._drive.turn * turn))

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds


class _Odometer:
    """Measures the motion since the last call."""

    def __init__(self) -> None:
        self._heard_ns: int | None = None
        self._pose: tuple[float, float, float] | None = None
        self._way = {"distance": 0.0, "angle": 0.0}

    def hear(self, now_ns: int, x: float, y: float, yaw: float) -> None:
        if self._pose is not None:
            self._way["distance"] += hypot(x - self._pose[0], y - self._pose[1])
            self._way["angle"] += abs((yaw - self._pose[2] + pi) % tau - pi)
        self._heard_ns, self._pose = now_ns, (x, y, yaw)

    def is_fresh(self, now_ns: int) -> bool:
        return self._heard_ns is not None and 0 <= now_ns - self._heard_ns < _FRESH * 1e9

    def pop(self, kind: str) -> float:
        way = self._way.get(kind, 0.0)
        self._way = {"distance": 0.0, "angle": 0.0}
        return way
