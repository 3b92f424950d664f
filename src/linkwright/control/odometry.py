"""Odometry messages of drives, and the corresponding transforms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from math import atan2, cos, sin
from typing import Any, NamedTuple

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform
from linkwright.graph.stepped.node import Output, SteppedNode
from linkwright.messages import Header, Quaternion, Time, TransformStamped, Vector3, get_message
from linkwright.messages import Transform as TransformMessage

Variances = tuple[float, ...]
"""Variances of x, y, z, roll, pitch and yaw."""

TRANSFORMS_TYPE, TRANSFORMS_DEPTH = "tf2_msgs/msg/TFMessage", 100
"""The type of transform topics, and the depth of their publishers."""

_NO_VARIANCES = (0.0,) * 6
_UNKNOWN_VARIANCE = 1e12
"""The variance of z, roll and pitch, which a wheeled robot does not measure."""


def planar_variances(x: float, y: float, yaw: float) -> Variances:
    """Return the six variances of a planar motion from the variances of x, y and yaw.

    The variances of z, roll and pitch are large, or 0 if all arguments are 0.
    """
    return (x, y, _UNKNOWN_VARIANCE, _UNKNOWN_VARIANCE, _UNKNOWN_VARIANCE, yaw) if x or y or yaw else _NO_VARIANCES


def get_yaw(pose: Transform) -> float:
    """Return the yaw of a pose, in rad."""
    _, _, _, x, y, z, w = pose
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def to_planar_velocity(pose: Transform, linear: Array, angular: Array) -> tuple[float, float, float]:
    """Rotate a velocity from world axes to the robot's axes.

    Returns the velocities forward and to the left in m/s, and about z in rad/s.
    """
    yaw = get_yaw(pose)
    forward = float(linear[0] * cos(yaw) + linear[1] * sin(yaw))
    sideways = float(linear[1] * cos(yaw) - linear[0] * sin(yaw))
    return forward, sideways, float(angular[2])


class _MessageClasses(NamedTuple):
    """The message classes of odometry and transforms."""

    point: Any
    pose: Any
    twist: Any
    pose_covariance: Any
    twist_covariance: Any
    odometry: Any
    transforms: Any


@cache
def _get_message_classes() -> _MessageClasses:
    return _MessageClasses(
        get_message("geometry_msgs/msg/Point"),
        get_message("geometry_msgs/msg/Pose"),
        get_message("geometry_msgs/msg/Twist"),
        get_message("geometry_msgs/msg/PoseWithCovariance"),
        get_message("geometry_msgs/msg/TwistWithCovariance"),
        get_message("nav_msgs/msg/Odometry"),
        get_message(TRANSFORMS_TYPE),
    )


@dataclass(slots=True)
class OdometryTopics:
    """The topics for odometry messages and their transforms.

    Attributes:
        frame: the frame in which the robot moves.
        child_frame: the robot's frame.
        odometry: the odometry topic; None to publish no odometry.
        transforms: the transform topic; None to publish no transforms.
        variances: the variances of the pose.
        velocity_variances: the variances of the velocities; None to use the variances of the pose.
    """

    frame: str
    child_frame: str
    odometry: Output | None
    transforms: Output | None
    variances: Variances = _NO_VARIANCES
    velocity_variances: Variances | None = None
    _covariances: tuple[Array, Array] = field(init=False)
    _outputs: tuple[tuple[Output, Callable[..., None]], ...] = field(init=False)

    def __post_init__(self) -> None:
        velocity = self.variances if self.velocity_variances is None else self.velocity_variances
        self._covariances = (_diagonal_matrix(self.variances), _diagonal_matrix(velocity))
        message_factories = (
            (self.odometry, self._build_odometry_message),
            (self.transforms, self._build_transform_message),
        )
        self._outputs = tuple(
            (output, output.deferred_publisher(factory)) for output, factory in message_factories if output is not None
        )

    @property
    def is_wanted(self) -> bool:
        """Whether any of the topics has a subscription."""
        for output, _ in self._outputs:  # noqa: SIM110 - see Output.is_wanted
            if output.is_wanted:
                return True
        return False

    def publish(self, stamp: Time, pose: Transform, forward: float, sideways: float, angular: float) -> None:
        """Publish the pose and velocities on the topics that have subscriptions.

        Velocities are along the robot's axes, in m/s and rad/s.
        """
        for output, send in self._outputs:
            if output.is_wanted:
                send(stamp, pose, forward, sideways, angular)

    def _build_odometry_message(
        self, stamp: Time, pose: Transform, forward: float, sideways: float, angular: float
    ) -> Any:
        classes = _get_message_classes()
        x, y, z, qx, qy, qz, qw = pose
        pose_message = classes.pose(
            position=classes.point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)
        )
        twist_message = classes.twist(
            linear=Vector3(x=forward, y=sideways, z=0.0), angular=Vector3(x=0.0, y=0.0, z=angular)
        )
        pose_covariance, twist_covariance = self._covariances
        return classes.odometry(
            header=Header(stamp=stamp, frame_id=self.frame),
            child_frame_id=self.child_frame,
            pose=classes.pose_covariance(pose=pose_message, covariance=pose_covariance),
            twist=classes.twist_covariance(twist=twist_message, covariance=twist_covariance),
        )

    def _build_transform_message(self, stamp: Time, pose: Transform, *_velocity: float) -> Any:
        return transform_message(Header(stamp=stamp, frame_id=self.frame), self.child_frame, pose)


def _diagonal_matrix(variances: Variances) -> Array:
    return np.diag(np.asarray(variances, np.float64)).ravel()


def transform_message(header: Header, child_frame: str, pose: Transform) -> Any:
    """Return a tf2_msgs/TFMessage with one transform."""
    return _get_message_classes().transforms(transforms=[transform_stamped(header, child_frame, pose)])


def transform_stamped(header: Header, child_frame: str, pose: Transform) -> TransformStamped:
    """Return the pose of a child frame in the frame of a header, as a TransformStamped."""
    x, y, z, qx, qy, qz, qw = pose
    return TransformStamped(
        header=header,
        child_frame_id=child_frame,
        transform=TransformMessage(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)),
    )


def create_transform_output(node: SteppedNode, name: str = "/tf") -> Output:
    """Create a publisher of transforms."""
    return node.publisher(TRANSFORMS_TYPE, name, TRANSFORMS_DEPTH)
