"""``diff_drive_controller/DiffDriveController``: differential drive by two sides of wheels.

Source: ros2_controllers for Humble and Jazzy (parameters, defaults, topics, texts). Other than there odometry in open
loop is that of the velocity within its limits, wheels may stand at any angle when it begins, and a command that is no
number stops the robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite, isnan, nan

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.drive_odometry import DriveOdometry, frame_prefix, variances
from linkwright.control.controllers.parameters import HUMBLE, above, parameter
from linkwright.control.controllers.speed_limits import NO_LIMITS, SpeedLimits
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import DifferentialDrive
from linkwright.messages import Header, Time, Vector3, get_message

_NANOSECONDS = 1_000_000_000
_NONE = (0.0,) * 6


@dataclass(frozen=True, kw_only=True)
class LinearLimits:
    """Limits of linear velocities."""

    x: SpeedLimits = NO_LIMITS


@dataclass(frozen=True, kw_only=True)
class AngularLimits:
    """Limits of angular velocities."""

    z: SpeedLimits = NO_LIMITS


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the controller."""

    left_wheel_names: tuple[str, ...] = parameter((), description="joints of the wheels on the left side")
    right_wheel_names: tuple[str, ...] = parameter((), description="joints of the wheels on the right side")
    wheel_separation: float = parameter(0.0, description="between the wheels of both sides, in m")
    wheels_per_side: int = parameter(0, description="of no effect: the names of the wheels tell", only=HUMBLE)
    wheel_radius: float = parameter(0.0, description="in m")
    wheel_separation_multiplier: float = parameter(1.0, description="corrects wheel_separation")
    left_wheel_radius_multiplier: float = parameter(1.0, description="corrects wheel_radius on the left")
    right_wheel_radius_multiplier: float = parameter(1.0, description="corrects wheel_radius on the right")
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
    use_stamped_vel: bool = parameter(True, description="whether ~/cmd_vel_unstamped is not taken too", only=HUMBLE)
    publish_rate: float = parameter(50.0, description="of odometry, in Hz")
    linear: LinearLimits = LinearLimits()
    angular: AngularLimits = AngularLimits()


class DiffDriveController(Controller[Parameters]):
    """A differential drive: wheel velocities from the commanded velocity, and odometry from the wheels."""

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """The velocities of the left wheels, then of the right ones."""
        said = self.parameters
        return [f"{wheel}/{VELOCITY}" for wheel in (*said.left_wheel_names, *said.right_wheel_names)]

    def state_interfaces(self) -> InterfaceNames:
        """Positions or velocities of the wheels; none in open loop."""
        said = self.parameters
        if said.open_loop:
            return ()
        kind = POSITION if said.position_feedback else VELOCITY
        return [f"{wheel}/{kind}" for wheel in (*said.left_wheel_names, *said.right_wheel_names)]

    def reference_interfaces(self) -> Sequence[str]:
        """The velocity forward in m/s, and around z in rad/s."""
        return ("linear/velocity", "angular/velocity")

    def on_configure(self) -> None:
        """Check the parameters, make the topics.

        Raises:
            ControllerError: wheels or their sizes are missing, or limits are none.
        """
        said, node = self.parameters, self.node
        self._said = said
        self._check_wheels()
        radius = said.wheel_radius
        self._drive = DifferentialDrive(
            said.wheel_separation_multiplier * said.wheel_separation,
            said.left_wheel_radius_multiplier * radius,
            said.right_wheel_radius_multiplier * radius,
        )
        self._limiters = said.linear.x.limiter("linear.x"), said.angular.z.limiter("angular.z")
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
        self._odometry.serve(node)
        limited = said.publish_limited_velocity
        self._limited = node.publisher("geometry_msgs/msg/TwistStamped", "~/cmd_vel_out") if limited else None

    def _check_wheels(self) -> None:
        said = self.parameters
        left, right = len(said.left_wheel_names), len(said.right_wheel_names)
        if left != right:
            raise ControllerError(
                phrase(
                    "The number of left wheels [{left}] and the number of right wheels [{right}] are different",
                    left=left,
                    right=right,
                )
            )
        if not left:
            raise ControllerError(phrase("Wheel names parameters are empty!"))
        for name in ("wheel_separation", "wheel_radius"):
            wrong = above(0.0)(name, getattr(said, name))
            if wrong is not None:
                raise ControllerError(wrong)

    def on_activate(self) -> None:
        """Start at rest, and take commands."""
        for limiter in self._limiters:
            limiter.restart()
        for reference in self.references:
            reference.value = nan
        self._odometry.odometer.stand()
        self._angles: tuple[float, float] | None = None
        self._input.open()

    def on_deactivate(self) -> None:
        """Stop the wheels."""
        self._input.close()
        for command in self.commands:
            command.value = 0.0

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the command into the references; zero where it is missing or too old."""
        velocity = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        forward, turning = self.references
        forward.value, turning.value = velocity[0], velocity[2]

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry.

        Raises:
            ControllerError: it moves, and a wheel tells no number.
        """
        wanted = [reference.value for reference in self.references]
        if not all(map(isfinite, wanted)):
            wanted = [0.0, 0.0]
        pairs = zip(self._limiters, wanted, strict=True)
        forward, turning = (limiter.follow(each, period_s) for limiter, each in pairs)
        left, right = self._drive.wheel_speeds(forward, turning)
        count = len(self.commands) // 2
        for number, command in enumerate(self.commands):
            command.value = left if number < count else right
        if self._said.open_loop:
            self._odometry.odometer.assume((forward, 0.0, turning), period_s)
        else:
            self._measure(period_s, moves=forward != 0.0 or turning != 0.0)
        self._odometry.tell(time_ns)
        if self._limited is not None and self._limited.is_wanted:
            twist = get_message("geometry_msgs/msg/Twist")(Vector3(forward, 0.0, 0.0), Vector3(0.0, 0.0, turning))
            header = Header(Time(*divmod(time_ns, _NANOSECONDS)), "")
            self._limited.publish(get_message("geometry_msgs/msg/TwistStamped")(header, twist))

    def _measure(self, period_s: float, *, moves: bool) -> None:
        """Update the odometry by the mean of each side's wheels; unknown states are tolerated until it moves."""
        values = [state.value for state in self.states]
        count = len(values) // 2
        left, right = sum(values[:count]) / count, sum(values[count:]) / count
        if isnan(left) or isnan(right):
            if not moves:
                return
            wrong = next(number for number, value in enumerate(values) if isnan(value))
            raise ControllerError(
                phrase(
                    "Either the left or right wheel {kind} is invalid for index [{index}]",
                    kind=self.states[0].kind,
                    index=wrong % count,
                )
            )
        if self._said.position_feedback:
            before, self._angles = self._angles or (left, right), (left, right)
            if period_s <= 0.0:
                return
            left, right = (left - before[0]) / period_s, (right - before[1]) / period_s
        forward, turning = self._drive.motion(left, right)
        self._odometry.odometer.measure((forward, 0.0, turning), period_s)
