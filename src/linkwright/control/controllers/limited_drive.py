"""The base class of drive controllers that follow ``~/cmd_vel`` within limits.

Source: diff_drive_controller of ros2_controllers, on which Husarion's mecanum controller is also based.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

from linkwright.control.controllers.drive_controller import DriveController
from linkwright.control.controllers.drive_odometry import OdometryParameters, check_variances, create_odometry
from linkwright.control.controllers.speed_limits import NO_LIMITS, SpeedLimits
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.messages import Header, Time, Vector3, get_message
from linkwright.nodes.parameter_tables import HUMBLE, parameter

_NO_VARIANCES = (0.0,) * 6


@dataclass(frozen=True, kw_only=True)
class AngularLimits:
    """The limits of angular velocities."""

    z: SpeedLimits = NO_LIMITS


_NO_ANGULAR_LIMITS = AngularLimits()


@dataclass(frozen=True, kw_only=True)
class LimitedDriveParameters(OdometryParameters):
    """Parameters of all drives with limits."""

    pose_covariance_diagonal: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the pose")
    twist_covariance_diagonal: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the velocity")
    open_loop: bool = parameter(False, description="whether odometry uses wheel commands instead of wheel states")
    position_feedback: bool = parameter(True, description="whether odometry uses wheel positions instead of velocities")
    cmd_vel_timeout: float = parameter(0.5, description="how long a command is valid, in seconds")
    publish_limited_velocity: bool = parameter(False, description="whether ~/cmd_vel_out is published")
    velocity_rolling_window_size: int = parameter(10, description="the window of the rolling mean of odometry")
    use_stamped_vel: bool = parameter(True, description="false to receive ~/cmd_vel_unstamped, too", only=HUMBLE)
    publish_rate: float = parameter(50.0, description="the rate of odometry, in Hz")
    angular: AngularLimits = _NO_ANGULAR_LIMITS


P = TypeVar("P", bound=LimitedDriveParameters)


class LimitedDrive(DriveController[P], Generic[P]):
    """The base class of drives that follow ``~/cmd_vel`` within limits and publish odometry."""

    @abstractmethod
    def limits(self) -> Mapping[str, SpeedLimits]:
        """Return the limits of each velocity component by name, such as ``linear.x``."""

    def on_configure(self) -> None:
        """Create the limiters, the subscription and the publishers.

        Raises:
            ControllerError: a limit is invalid, or a list of variances has the wrong length.
        """
        parameters, node = self.parameters, self.node
        self._settings, self._has_angles = parameters, parameters.position_feedback
        self._limiters = [limits.create_limiter(axis) for axis, limits in self.limits().items()]
        unstamped = "" if parameters.use_stamped_vel else "~/cmd_vel_unstamped"
        self._input = VelocityInput(node, "~/cmd_vel", timeout_s=parameters.cmd_vel_timeout, unstamped_topic=unstamped)
        self._odometry = create_odometry(
            node,
            parameters,
            "~/odom",
            "/tf",
            pose_variances=check_variances("pose_covariance_diagonal", parameters.pose_covariance_diagonal),
            velocity_variances=check_variances("twist_covariance_diagonal", parameters.twist_covariance_diagonal),
            window=parameters.velocity_rolling_window_size,
            rate_hz=parameters.publish_rate,
        )
        publishes_limited = parameters.publish_limited_velocity
        self._limited_output = (
            node.publisher("geometry_msgs/msg/TwistStamped", "~/cmd_vel_out") if publishes_limited else None
        )

    def on_activate(self) -> None:
        """Reset the velocities to zero, and accept commands."""
        for limiter in self._limiters:
            limiter.restart()
        super().on_activate()

    def _publish(self, time_ns: int, forward: float, sideways: float, angular: float) -> None:
        """Publish the odometry and, if enabled, the limited velocity.

        Velocities are in m/s and rad/s.
        """
        self._odometry.publish(time_ns)
        if self._limited_output is not None and self._limited_output.is_wanted:
            twist = get_message("geometry_msgs/msg/Twist")(
                linear=Vector3(x=forward, y=sideways, z=0.0), angular=Vector3(x=0.0, y=0.0, z=angular)
            )
            header = Header(stamp=Time.from_nanoseconds(time_ns), frame_id="")
            self._limited_output.publish(get_message("geometry_msgs/msg/TwistStamped")(header=header, twist=twist))
