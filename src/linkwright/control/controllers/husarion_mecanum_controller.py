"""``mecanum_drive_controller/MecanumDriveController`` of Husarion, which has that type name as well.

Robots of Husarion (ROSbot XL, Panther) come with it. It has the parameters and topics of diff_drive_controller, with
four wheels by name.

Source: husarion_controllers (parameters, defaults, topics). Other than there odometry corrects the wheelbase by the
multiplier of the wheelbase, as the wheels do, and a wheel that tells no number leaves the odometry where it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.diff_drive_controller import AngularLimits
from linkwright.control.controllers.drive_odometry import DriveOdometry, frame_prefix, variances
from linkwright.control.controllers.parameters import above, not_empty, parameter
from linkwright.control.controllers.speed_limits import NO_LIMITS, SpeedLimits
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.kinematics.drives import MecanumDrive
from linkwright.messages import Header, Time, Vector3, get_message

_NANOSECONDS = 1_000_000_000
_NONE = (0.0,) * 6


@dataclass(frozen=True, kw_only=True)
class LinearLimits:
    """Limits of linear velocities."""

    x: SpeedLimits = NO_LIMITS
    y: SpeedLimits = NO_LIMITS


_LINEAR, _ANGULAR = LinearLimits(), AngularLimits()


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the controller."""

    front_left_wheel_name: str = parameter("", description="a joint")
    front_right_wheel_name: str = parameter("", description="a joint")
    rear_left_wheel_name: str = parameter("", description="a joint")
    rear_right_wheel_name: str = parameter("", description="a joint")
    wheel_separation_x: float = parameter(0.0, description="between front and rear wheels, in m")
    wheel_separation_y: float = parameter(0.0, description="between left and right wheels, in m")
    wheel_radius: float = parameter(0.0, description="in m")
    wheel_separation_x_multiplier: float = parameter(1.0, description="corrects wheel_separation_x")
    wheel_separation_y_multiplier: float = parameter(1.0, description="corrects wheel_separation_y")
    wheel_radius_multiplier: float = parameter(1.0, description="corrects wheel_radius")
    tf_frame_prefix_enable: bool = parameter(True, description="whether frames have a prefix")
    tf_frame_prefix: str = parameter("", description="the prefix of frames; the namespace where it is empty")
    odom_frame_id: str = parameter("odom", description="the frame that the robot moves in")
    base_frame_id: str = parameter("base_link", description="the frame of the robot")
    pose_covariance_diagonal: tuple[float, ...] = parameter(_NONE, description="variances of the pose")
    twist_covariance_diagonal: tuple[float, ...] = parameter(_NONE, description="variances of the velocity")
    open_loop: bool = parameter(False, description="odometry by what wheels are told, not by what they do")
    position_feedback: bool = parameter(True, description="odometry by positions of wheels, not by velocities")
    enable_odom_tf: bool = parameter(True, description="whether the transform of odometry is published")
    cmd_vel_timeout: float = parameter(0.5, description="how long a command holds, in seconds")
    publish_limited_velocity: bool = parameter(False, description="whether ~/cmd_vel_out is published")
    velocity_rolling_window_size: int = parameter(10, description="odometry tells the mean of so many velocities")
    use_stamped_vel: bool = parameter(True, description="whether ~/cmd_vel_unstamped is not taken too")
    publish_rate: float = parameter(50.0, description="of odometry, in Hz")
    linear: LinearLimits = _LINEAR
    angular: AngularLimits = _ANGULAR


class HusarionMecanumController(Controller[Parameters]):
    """A mecanum drive: wheel velocities from the commanded velocity, sideways too, and odometry from the wheels."""

    PARAMETERS = Parameters

    def _wheels(self, kind: str) -> list[str]:
        said = self.parameters
        names = said.front_left_wheel_name, said.front_right_wheel_name, said.rear_left_wheel_name
        return [f"{name}/{kind}" for name in (*names, said.rear_right_wheel_name)]

    def command_interfaces(self) -> InterfaceNames:
        """The velocities of the wheels: front left, front right, rear left, rear right."""
        return self._wheels(VELOCITY)

    def state_interfaces(self) -> InterfaceNames:
        """Positions or velocities of the wheels; none in open loop."""
        if self.parameters.open_loop:
            return ()
        return self._wheels(POSITION if self.parameters.position_feedback else VELOCITY)

    def on_configure(self) -> None:
        """Check the parameters, make the topics.

        Raises:
            ControllerError: wheels or their sizes are missing, or limits are none.
        """
        said, node = self.parameters, self.node
        self._said = said
        self._check()
        self._drive = MecanumDrive(
            said.wheel_separation_x_multiplier * said.wheel_separation_x / 2.0
            + said.wheel_separation_y_multiplier * said.wheel_separation_y / 2.0,
            said.wheel_radius_multiplier * said.wheel_radius,
        )
        axes = {"linear.x": said.linear.x, "linear.y": said.linear.y, "angular.z": said.angular.z}
        self._limiters = [limits.limiter(axis) for axis, limits in axes.items()]
        unstamped = "" if said.use_stamped_vel else "~/cmd_vel_unstamped"
        self._input = VelocityInput(node, "~/cmd_vel", timeout_s=said.cmd_vel_timeout, unstamped=unstamped)
        prefix = frame_prefix(node, said.tf_frame_prefix, enabled=said.tf_frame_prefix_enable)
        self._odometry = DriveOdometry(
            node,
            "~/odom",
            "/tf",
            frame=prefix + said.odom_frame_id,
            child=prefix + said.base_frame_id,
            of_pose=variances("pose_covariance_diagonal", said.pose_covariance_diagonal),
            of_velocity=variances("twist_covariance_diagonal", said.twist_covariance_diagonal),
            tells_transforms=said.enable_odom_tf,
            window=said.velocity_rolling_window_size,
            rate=said.publish_rate,
        )
        limited = said.publish_limited_velocity
        self._limited = node.publisher("geometry_msgs/msg/TwistStamped", "~/cmd_vel_out") if limited else None

    def _check(self) -> None:
        said = self._said
        corners = ("front_left", "front_right", "rear_left", "rear_right")
        names = [f"{corner}_wheel_name" for corner in corners]
        sizes = ("wheel_separation_x", "wheel_separation_y", "wheel_radius")
        wrong = [not_empty(name, getattr(said, name)) for name in names]
        wrong += [above(0.0)(name, getattr(said, name)) for name in sizes]
        for each in wrong:
            if each is not None:
                raise ControllerError(each)

    def on_activate(self) -> None:
        """Start at rest, and take commands."""
        for limiter in self._limiters:
            limiter.restart()
        self._odometry.odometer.stand()
        self._angles: list[float] | None = None
        self._input.open()

    def on_deactivate(self) -> None:
        """Stop the wheels."""
        self._input.close()
        for command in self.commands:
            command.value = 0.0

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry."""
        wanted = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        pairs = zip(self._limiters, wanted, strict=True)
        forward, sideways, turning = (limiter.follow(each, period_s) for limiter, each in pairs)
        speeds = self._drive.wheel_speeds(forward, sideways, turning)
        for command, value in zip(self.commands, speeds, strict=True):
            command.value = value
        if self._said.open_loop:
            self._odometry.odometer.assume((forward, sideways, turning), period_s)
        else:
            self._measure(period_s)
        self._odometry.tell(time_ns)
        if self._limited is not None and self._limited.is_wanted:
            twist = get_message("geometry_msgs/msg/Twist")(Vector3(forward, sideways, 0.0), Vector3(0.0, 0.0, turning))
            header = Header(Time(*divmod(time_ns, _NANOSECONDS)), "")
            self._limited.publish(get_message("geometry_msgs/msg/TwistStamped")(header, twist))

    def _measure(self, period_s: float) -> None:
        speeds = [state.value for state in self.states]
        if not all(map(isfinite, speeds)):
            return
        if self._said.position_feedback:
            before, self._angles = self._angles or speeds, speeds
            if period_s <= 0.0:
                return
            speeds = [(now - then) / period_s for now, then in zip(speeds, before, strict=True)]
        self._odometry.odometer.measure(self._drive.motion(*speeds), period_s)
