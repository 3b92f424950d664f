"""Odometry topics of drive controllers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.node import ControllerNode
from linkwright.control.motion.odometer import Odometer
from linkwright.control.odometry import OdometryTopics, Variances, create_transform_output
from linkwright.diagnostics import phrase
from linkwright.messages import Time
from linkwright.nodes.parameter_tables import parameter
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_DEGREES_OF_FREEDOM = 6


def check_variances(name: str, values: tuple[float, ...]) -> Variances:
    """Return the six values of a parameter as variances.

    The order is x, y, z, roll, pitch, yaw.

    Raises:
        ControllerError: the parameter does not have six values.
    """
    if len(values) != _DEGREES_OF_FREEDOM:
        raise ControllerError(
            phrase(
                "'{name}' must have {expected_count} numbers, but it has {count}",
                name=name,
                expected_count=_DEGREES_OF_FREEDOM,
                count=len(values),
            )
        )
    return values


@dataclass(frozen=True, kw_only=True)
class OdometryParameters:
    """The parameters of drives for the frames and the transform of the odometry."""

    tf_frame_prefix_enable: bool = parameter(True, description="whether frames have a prefix")
    tf_frame_prefix: str = parameter("", description="the prefix of frames; the namespace if empty")
    odom_frame_id: str = parameter("odom", description="the frame in which the robot moves")
    base_frame_id: str = parameter("base_link", description="the frame of the robot")
    enable_odom_tf: bool = parameter(True, description="whether the transform of odometry is published")


def resolve_frame_prefix(node: ControllerNode, prefix: str, *, enabled: bool = True) -> str:
    """Return the prefix of frame names.

    The prefix is empty or ends with a slash, and never begins with one.

    Args:
        node: the controller's node.
        prefix: the requested prefix; ``~`` or an empty prefix means the namespace of the node.
        enabled: whether frames have a prefix.

    Source: diff_drive_controller (``tf_frame_prefix``, ``tf_frame_prefix_enable``).
    """
    if not enabled:
        return ""
    namespace = node.name.rpartition("/")[0]
    resolved_prefix = (prefix or "~").replace("~", namespace).strip("/")
    return f"{resolved_prefix}/" if resolved_prefix else ""


class DriveOdometry:
    """The odometry of a drive, with the topics on which it is published.

    Args:
        node: the controller's node.
        odometry: the name of the odometry topic.
        transforms: the name of the transform topic.
        frame: the frame in which the robot moves.
        child: the robot's frame.
        pose_variances, velocity_variances: the variances of pose and velocity.
        publishes_transforms: whether transforms are published; their topic exists in any case.
        publishes_pose: whether odometry messages contain the pose; otherwise they contain only velocities.
        window: the number of updates over which the odometer averages velocities.
        rate: the publishing rate in Hz; 0 to publish at each update.

    Attributes:
        odometer: the source of the robot's pose and velocity.
        frame: the frame in which the robot moves.
    """

    def __init__(
        self,
        node: ControllerNode,
        odometry_topic: str,
        transform_topic: str,
        *,
        frame: str,
        child_frame: str,
        pose_variances: Variances,
        velocity_variances: Variances,
        publishes_transforms: bool,
        publishes_pose: bool = True,
        window: int = 1,
        rate_hz: float = 0.0,
    ) -> None:
        self.odometer = Odometer(max(window, 1))
        self.frame = frame
        output = node.publisher("nav_msgs/msg/Odometry", odometry_topic)
        tf_output = create_transform_output(node, transform_topic)
        self._topics = OdometryTopics(frame, child_frame, output, None, pose_variances, velocity_variances)
        self._transforms = OdometryTopics(frame, child_frame, None, tf_output if publishes_transforms else None)
        self._fixed_pose = None if publishes_pose else Odometer().pose.transform
        self._period_ns = round(NANOSECONDS_PER_SECOND / rate_hz) if rate_hz > 0.0 else 0
        self._last_published_ns: int | None = None

    def publish(self, time_ns: int) -> None:
        """Publish the odometry if the period has passed and a subscription exists.

        `time_ns` is the current time in nanoseconds.
        """
        if not self._is_due(time_ns):
            return
        has_subscription = self._topics.is_wanted
        if not has_subscription and not self._transforms.is_wanted:
            return
        stamp, pose = Time.from_nanoseconds(time_ns), self.odometer.pose.transform
        if has_subscription:
            self._topics.publish(stamp, self._fixed_pose or pose, *self.odometer.velocity)
        self._transforms.publish(stamp, pose, 0.0, 0.0, 0.0)

    def _is_due(self, time_ns: int) -> bool:
        last_ns, period_ns = self._last_published_ns, self._period_ns
        if last_ns is None or not 0 <= time_ns - last_ns < 2 * period_ns:
            self._last_published_ns = time_ns
            return True
        if time_ns - last_ns < period_ns:
            return False
        self._last_published_ns = last_ns + period_ns
        return True

    def create_reset_service(self, node: ControllerNode) -> None:
        """Offer the service ``~/set_odometry``, which resets the pose.

        The service type is ``control_msgs/srv/SetOdometry``.
        """

        def on_request(request: Any, response: Any) -> Any:
            self.odometer.reset(request.x, request.y, request.yaw)
            response.success = True
            return response

        node.service("control_msgs/srv/SetOdometry", "~/set_odometry", on_request)


def create_odometry(
    node: ControllerNode, parameters: OdometryParameters, odometry_topic: str, transform_topic: str, **settings: Any
) -> DriveOdometry:
    """Return the odometry of a drive, whose frames have the prefix from its parameters.

    Args:
        node: the controller's node.
        parameters: the parameters with the frames and their prefix.
        odometry_topic: the name of the odometry topic.
        transform_topic: the name of the transform topic.
        settings: the other keyword arguments of `DriveOdometry`.
    """
    prefix = resolve_frame_prefix(node, parameters.tf_frame_prefix, enabled=parameters.tf_frame_prefix_enable)
    return DriveOdometry(
        node,
        odometry_topic,
        transform_topic,
        frame=prefix + parameters.odom_frame_id,
        child_frame=prefix + parameters.base_frame_id,
        publishes_transforms=parameters.enable_odom_tf,
        **settings,
    )
