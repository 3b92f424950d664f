"""Velocity commands of drive controllers, received on topics."""

from __future__ import annotations

from math import isfinite
from typing import Any

from linkwright.control.controllers.node import ControllerNode
from linkwright.control.motion.odometer import Velocity
from linkwright.diagnostics import phrase
from linkwright.graph import QoSProfile, ReliabilityPolicy
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

REFERENCE_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""The QoS of the controllers' subscriptions to ``~/reference``."""


class VelocityInput:
    """The velocity commands of a topic, with a timeout.

    The topic's type is ``geometry_msgs/msg/TwistStamped``.

    The age of a command counts from the time in its header. If that time is zero or in the future, the age counts from
    the update that first uses the command, so every command expires. A command that is not finite stops the drive.

    Args:
        node: the controller's node.
        topic: the topic's name.
        timeout_s: how long a command stays valid, in seconds; 0 to use each command for one update.
        unstamped: an additional topic of type ``geometry_msgs/msg/Twist``; empty for none. If it has the same name as
            `topic`, only commands without headers are received.
        qos: the QoS of the subscriptions.

    Source: diff_drive_controller of ros2_controllers, with two differences: a command with a time in the future
    expires, too, and commands with headers are accepted even if commands without headers are requested, because Jazzy
    accepts only commands with headers.
    """

    def __init__(
        self,
        node: ControllerNode,
        topic: str,
        *,
        timeout_s: float,
        unstamped_topic: str = "",
        qos: QoSProfile | int = 10,
    ) -> None:
        self._logger = node.logger
        self._timeout_ns = round(timeout_s * NANOSECONDS_PER_SECOND)
        self._is_open = False
        self.discard_command()
        command_guard = node.command_guard(self._on_publisher_lost)
        if topic != unstamped_topic:
            node.subscribe("geometry_msgs/msg/TwistStamped", topic, self._on_stamped, qos, command_guard=command_guard)
        if unstamped_topic:
            node.subscribe("geometry_msgs/msg/Twist", unstamped_topic, self._on_twist, qos, command_guard=command_guard)

    def open(self) -> None:
        """Discard the last command, and start accepting commands."""
        self.discard_command()
        self._is_open = True

    def close(self) -> None:
        """Discard the last command, and stop accepting commands."""
        self.discard_command()
        self._is_open = False

    def discard_command(self) -> None:
        """Discard the last command."""
        self._new_command: tuple[Velocity, int] | None = None
        self._command: tuple[Velocity, int] | None = None

    def _on_publisher_lost(self) -> bool:
        """Discard the last command of a lost publisher, and return whether it was not zero."""
        velocity, _ = self._new_command or self._command or ((0.0,), 0)
        self.discard_command()
        return any(velocity)

    def velocity(self, time_ns: int) -> Velocity | None:
        """Return the command that is valid at a time in nanoseconds, or None if there is none."""
        if self._new_command is not None:
            self._receive(*self._new_command, time_ns)
            self._new_command = None
        if self._command is None:
            return None
        velocity, start_ns = self._command
        if 0 <= time_ns - start_ns <= self._timeout_ns:
            return velocity
        self._command = None
        return None

    def _on_stamped(self, message: Any) -> None:
        stamp = message.header.stamp
        stamp_ns = stamp.sec * NANOSECONDS_PER_SECOND + stamp.nanosec
        if not stamp_ns and self._is_open:
            self._logger.warning(
                phrase(
                    "Received TwistStamped with zero timestamp, setting it to current time, this message will "
                    "only be shown once"
                ),
                once=True,
            )
        self._on_twist(message.twist, stamp_ns)

    def _on_twist(self, twist: Any, stamp_ns: int = 0) -> None:
        if not self._is_open:
            self._logger.warning(phrase("Can't accept new commands. subscriber is inactive"))
            return
        self._new_command = (float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)), stamp_ns

    def _receive(self, velocity: Velocity, stamp_ns: int, now_ns: int) -> None:
        start_ns = stamp_ns if 0 < stamp_ns <= now_ns else now_ns
        if not all(map(isfinite, velocity)):
            self._command = None
            self._logger.warning(
                phrase("a velocity command that is not a finite number is rejected, and the drive stops")
            )
        elif now_ns - start_ns <= self._timeout_ns or self._timeout_ns == 0:
            self._command = velocity, (now_ns if self._timeout_ns == 0 else start_ns)
        else:
            self._logger.warning(
                phrase(
                    "Ignoring the received message (timestamp {stamp:.3f}) because it is older than the current time "
                    "by {age:.3f} seconds, which exceeds the allowed timeout ({timeout:.3f})",
                    stamp=stamp_ns / NANOSECONDS_PER_SECOND,
                    age=(now_ns - start_ns) / NANOSECONDS_PER_SECOND,
                    timeout=self._timeout_ns / NANOSECONDS_PER_SECOND,
                )
            )
