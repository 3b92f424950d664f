"""Velocity commands of drive controllers, from a topic."""

from __future__ import annotations

from math import isfinite
from typing import Any

from linkwright.control.controllers.node import ControllerNode
from linkwright.control.motion.odometer import Velocity
from linkwright.diagnostics import phrase
from linkwright.graph import QoSProfile, ReliabilityPolicy
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

REFERENCE_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""The profile of controllers' subscriptions to ``~/reference``."""


class VelocityInput:
    """Commands of a topic, ``geometry_msgs/msg/TwistStamped``, which expire after a time.

    A command counts from the time in its header; from the update that takes it where it has none, or one that is still
    to come, so that it grows old in any case. One that is not finite stops the drive.

    Args:
        node: the controller's.
        topic: its name.
        timeout_s: how long a command holds, in seconds; with 0 each holds for one update.
        unstamped: a topic of ``geometry_msgs/msg/Twist`` besides; empty for none. The same name has commands without
            headers only.
        qos: the quality of service of the subscriptions.

    Source: diff_drive_controller of ros2_controllers; other than there a header of the future does not hold for ever,
    and commands with headers are taken even where those without are asked for, as Jazzy takes no others.
    """

    def __init__(
        self, node: ControllerNode, topic: str, *, timeout_s: float, unstamped: str = "", qos: QoSProfile | int = 10
    ) -> None:
        self._logger = node.logger
        self._timeout = round(timeout_s * NANOSECONDS_PER_SECOND)
        self._is_open = False
        self.forget()
        commander = node.commander(self._lose)
        if topic != unstamped:
            node.subscribe("geometry_msgs/msg/TwistStamped", topic, self._receive_stamped, qos, commander=commander)
        if unstamped:
            node.subscribe("geometry_msgs/msg/Twist", unstamped, self._receive_twist, qos, commander=commander)

    def open(self) -> None:
        """Accept commands from now on."""
        self.forget()
        self._is_open = True

    def close(self) -> None:
        """Drop the last command, and accept no more."""
        self.forget()
        self._is_open = False

    def forget(self) -> None:
        """Drop the last command."""
        self._come: tuple[Velocity, int] | None = None
        self._command: tuple[Velocity, int] | None = None

    def _lose(self) -> bool:
        """Drop the command of a publisher that is lost; return whether it was still valid, and not zero."""
        velocity, _ = self._come or self._command or ((0.0,), 0)
        self.forget()
        return any(velocity)

    def velocity(self, time_ns: int) -> Velocity | None:
        """The command that is valid at a time in nanoseconds; None if there is none, or the last one is too old."""
        if self._come is not None:
            self._receive(*self._come, time_ns)
            self._come = None
        if self._command is None:
            return None
        velocity, since = self._command
        if 0 <= time_ns - since <= self._timeout:
            return velocity
        self._command = None
        return None

    def _receive_stamped(self, message: Any) -> None:
        stamp = message.header.stamp
        nanoseconds = stamp.sec * NANOSECONDS_PER_SECOND + stamp.nanosec
        if not nanoseconds and self._is_open:
            self._logger.warning(
                phrase(
                    "Received TwistStamped with zero timestamp, setting it to current time, "
                    "this message will only be shown once"
                ),
                once=True,
            )
        self._receive_twist(message.twist, nanoseconds)

    def _receive_twist(self, twist: Any, stamp: int = 0) -> None:
        if not self._is_open:
            self._logger.warning(phrase("Can't accept new commands. subscriber is inactive"))
            return
        self._come = (float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)), stamp

    def _receive(self, velocity: Velocity, stamp: int, now: int) -> None:
        since = stamp if 0 < stamp <= now else now
        if not all(map(isfinite, velocity)):
            self._command = None
            self._logger.warning(phrase("a command that is not a finite number is refused: the drive stops"))
        elif now - since <= self._timeout or self._timeout == 0:
            self._command = velocity, (now if self._timeout == 0 else since)
        else:
            self._logger.warning(
                phrase(
                    "Ignoring the received message (timestamp {stamp:.3f}) because it is older than the current time "
                    "by {age:.3f} seconds, which exceeds the allowed timeout ({timeout:.3f})",
                    stamp=stamp / NANOSECONDS_PER_SECOND,
                    age=(now - since) / NANOSECONDS_PER_SECOND,
                    timeout=self._timeout / NANOSECONDS_PER_SECOND,
                )
            )
