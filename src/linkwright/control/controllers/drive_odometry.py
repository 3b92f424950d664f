"""Odometry topics of drive controllers."""

from __future__ import annotations

from typing import Any

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.node import ControllerNode
from linkwright.control.motion.odometer import Odometer
from linkwright.control.odometry import OdometryTopics, Variances, transforms_topic
from linkwright.diagnostics import phrase
from linkwright.messages import Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_AXES = 6


def variances(name: str, values: tuple[float, ...]) -> Variances:
    """Expand a parameter to variances of x, y, z, roll, pitch and yaw.

    Raises:
        ControllerError: there are not six.
    """
    if len(values) != _AXES:
        raise ControllerError(
            phrase("'{name}' needs {needed} numbers, and has {count}", name=name, needed=_AXES, count=len(values))
        )
    return values


def frame_prefix(node: ControllerNode, prefix: str, *, enabled: bool = True) -> str:
    """Return the prefix of frame names: empty, or a name with a slash at its end and none at its beginning.

    Args:
        node: the controller's node.
        prefix: the requested prefix; ``~`` and an empty one represent the namespace of the node.
        enabled: whether frames have a prefix.

    Source: diff_drive_controller (``tf_frame_prefix``, ``tf_frame_prefix_enable``).
    """
    if not enabled:
        return ""
    namespace = node.name.rpartition("/")[0]
    found = (prefix or "~").replace("~", namespace).strip("/")
    return f"{found}/" if found else ""


class DriveOdometry:
    """The odometry of a drive: an odometer and its topics.

    Args:
        node: the controller's node.
        odometry: the topic of odometry.
        transforms: the topic of transforms.
        frame: the frame that the robot moves in.
        child: the robot's frame.
        of_pose, of_velocity: variances.
        publishes_transforms: whether transforms are published; their topic exists in any case.
        publishes_pose: whether odometry has the pose; else it has velocities only.
        window: that of the odometer.
        rate: the rate of publishing in Hz; 0 publishes at each update.

    Attributes:
        odometer: the source of the robot's pose.
    """

    def __init__(
        self,
        node: ControllerNode,
        odometry: str,
        transforms: str,
        *,
        frame: str,
        child: str,
        of_pose: Variances,
        of_velocity: Variances,
        publishes_transforms: bool,
        publishes_pose: bool = True,
        window: int = 1,
        rate: float = 0.0,
    ) -> None:
        self.odometer = Odometer(max(window, 1))
        output = node.publisher("nav_msgs/msg/Odometry", odometry)
        tf_output = transforms_topic(node, transforms)
        self._topics = OdometryTopics(frame, child, output, None, of_pose, of_velocity)
        self._transforms = OdometryTopics(frame, child, None, tf_output if publishes_transforms else None)
        self._nowhere = None if publishes_pose else Odometer().place.transform
        self._period = round(NANOSECONDS_PER_SECOND / rate) if rate > 0.0 else 0
        self._published_ns: int | None = None

    def publish(self, time_ns: int) -> None:
        """Publish if that is due at a time in nanoseconds and a subscriber exists."""
        if not self._is_due(time_ns):
            return
        wanted = self._topics.is_wanted
        if not wanted and not self._transforms.is_wanted:
            return
        stamp, pose = Time(*divmod(time_ns, NANOSECONDS_PER_SECOND)), self.odometer.place.transform
        if wanted:
            self._topics.publish(stamp, self._nowhere or pose, *self.odometer.velocity)
        self._transforms.publish(stamp, pose, 0.0, 0.0, 0.0)

    def _is_due(self, time_ns: int) -> bool:
        last, period = self._published_ns, self._period
        if last is None or not 0 <= time_ns - last < 2 * period:
            self._published_ns = time_ns
            return True
        if time_ns - last < period:
            return False
        self._published_ns = last + period
        return True

    def serve(self, node: ControllerNode) -> None:
        """Offer ``~/set_odometry`` of type ``control_msgs/srv/SetOdometry``, by which others set the pose."""

        def asked(request: Any, response: Any) -> Any:
            self.odometer.reset(request.x, request.y, request.yaw)
            response.success = True
            return response

        node.service("control_msgs/srv/SetOdometry", "~/set_odometry", asked)
