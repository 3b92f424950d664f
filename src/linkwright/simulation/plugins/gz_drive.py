"""Commands, odometry topics and frames that all drives of gz use.

Source: gz-sim (parameters, topics, defaults).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.control.odometry import TRANSFORMS_DEPTH, TRANSFORMS_TYPE, OdometryTopics
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.limits import SpeedLimits
from linkwright.simulation.plugins.plugin import SimulatedPlugin

GZ_RATE_HZ = 100.0
"""The rate in Hz at which drives of gz process commands. In gz, they are processed before each step."""
GZ_MAX_TORQUE = 5.0
"""The maximum torque of a wheel in N m if a gz plugin specifies none. In gz, velocities are set without a limit."""
MOTOR_GAIN = 20.0
"""The gain of a wheel motor, in N m of torque per rad/s of velocity error."""


@dataclass(frozen=True, kw_only=True)
class GzDriveParameters(SpeedLimits):
    """Parameters that all drives of gz have in common."""

    topic: str = ""
    odom_topic: str = ""
    tf_topic: str = ""
    frame_id: str = ""
    child_frame_id: str = ""
    odom_publish_frequency: float = 50.0


class DriveCommands:
    """The commanded velocity of a drive, with limits.

    The components of the velocity are forward and left in m/s, and the yaw rate in rad/s.

    Args:
        limits: the limits of velocity, acceleration and jerk.

    Attributes:
        is_enabled: whether commands are accepted; otherwise the velocity decreases to zero.
    """

    def __init__(self, limits: SpeedLimits) -> None:
        self._limiters = tuple(limits.create_limiter(kind) for kind in ("linear", "linear", "angular"))
        self.is_enabled = True
        self.restart()

    def restart(self) -> None:
        """Set the velocity and the command to zero."""
        self._command = (0.0, 0.0, 0.0)
        for limiter in self._limiters:
            limiter.restart()

    def resume(self, previous: DriveCommands) -> None:
        """Adopt the velocity, the command and the enabled state of a previous instance.

        Both instances have equal limits.
        """
        self.is_enabled, self._command, self._limiters = previous.is_enabled, previous._command, previous._limiters

    def set_command(self, twist: Any) -> None:
        """Set the command from a ``geometry_msgs/msg/Twist``, unless the drive is disabled."""
        if self.is_enabled:
            self._command = (float(twist.linear.x), float(twist.linear.y), float(twist.angular.z))

    def stop(self) -> bool:
        """Set the command to zero, and return whether it was nonzero."""
        old_command, self._command = self._command, (0.0, 0.0, 0.0)
        return old_command != self._command

    def enable(self, message: Any) -> None:
        """Enable the drive, or disable and stop it, as a ``std_msgs/msg/Bool`` requests."""
        self.is_enabled = bool(message.data)
        if not self.is_enabled:
            self.stop()

    def next_velocity(self) -> tuple[float, float, float]:
        """Advance the limited velocity towards the command, and return the new velocity.

        Call this `GZ_RATE_HZ` times per simulated second.
        """
        limited_targets = zip(self._limiters, self._command, strict=True)
        forward, left, angular = (limiter.approach(target, 1.0 / GZ_RATE_HZ) for limiter, target in limited_targets)
        return forward, left, angular


def connect_drive(
    plugin: SimulatedPlugin[Any], parameters: GzDriveParameters, commands: DriveCommands
) -> OdometryTopics:
    """Subscribe to the commands of a drive, and create and return its odometry topics."""
    model, node = plugin.context.path, plugin.node
    frame = parameters.frame_id or f"{model}/odom"
    child_frame = parameters.child_frame_id or f"{model}/{plugin.first_link.rpartition(SEPARATOR)[2]}"
    odometry = node.publisher(
        "nav_msgs/msg/Odometry", parameters.odom_topic or f"/model/{model}/odometry", conventional_topic="/odom"
    )
    transforms = node.publisher(
        TRANSFORMS_TYPE, parameters.tf_topic or f"/model/{model}/tf", TRANSFORMS_DEPTH, conventional_topic="/tf"
    )
    topic = parameters.topic or f"/model/{model}/cmd_vel"
    command_guard = node.command_guard(commands.stop)
    node.subscribe(
        "geometry_msgs/msg/Twist",
        topic,
        commands.set_command,
        conventional_topic="/cmd_vel",
        command_guard=command_guard,
        stop_motion=commands.stop,
    )
    return OdometryTopics(frame, child_frame, odometry, transforms)
