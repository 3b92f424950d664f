"""The display rviz_default_plugins/Effort."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.single import quaternion_multiply, rotation_from_z
from linkwright.graph import DESCRIPTION_QOS, TransformException
from linkwright.messages import String
from linkwright.page.protocol.geometry import EffortRings
from linkwright.page.protocol.message import DataContent
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import RecentDisplay
from linkwright.rviz.robot import get_frame_name
from linkwright.urdf import Joint

_DESCRIPTION = "Robot Description"
_PREFIX = "TF Prefix"
_JOINTS = "Joints"
_URDF = "URDF"
_ROTATING_TYPES = ("revolute", "continuous")


class EffortDisplay(RecentDisplay):
    """A display of joint torques as rings about the joint axes.

    The larger the ring, the closer the torque is to the effort limit.

    Revolute and continuous joints are drawn. RViz draws the torques of revolute joints only, and orients the rings
    incorrectly for axes other than z.
    """

    CLASS = "rviz_default_plugins/Effort"
    MESSAGE = "sensor_msgs/msg/JointState"
    LENGTH = ("History Length",)
    IN_FIXED_FRAME = True
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        alpha(),
        PropertySpec("Width", "float", 0.02, "Width of the rings' lines, in meters."),
        PropertySpec("Scale", "float", 1.0, "Width in meters of the ring of a joint at its effort limit."),
        PropertySpec("History Length", "int", 1, "The number of messages that are shown.", minimum=1, maximum=100000),
        PropertySpec(
            _DESCRIPTION,
            "string",
            "/robot_description",
            "The topic of the robot's description, std_msgs/msg/String.",
        ),
        PropertySpec(
            _PREFIX,
            "string",
            "",
            "The prefix of frame names: a link's frame is the prefix, a slash and the link's name.",
        ),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._joints: dict[str, Joint] | None = None
        self._description_subscription: Any = None
        super().__init__(host, identity, config)

    def schema(self) -> Schema:
        """Return the fixed properties, and a check box for each joint whose effort can be drawn."""
        names = sorted(self._joints or ())
        joint_specs = tuple(
            PropertySpec(name, "bool", True, "Draw the ring of this joint.", nested=True, details="effort")
            for name in names
        )
        return (
            *self.SCHEMA,
            PropertySpec(_JOINTS, "group", description="The revolute and continuous joints.", children=joint_specs),
        )

    def start(self) -> None:
        """Subscribe to the joint states and to the robot's description."""
        super().start()
        self._subscribe_description()

    def stop(self) -> None:
        """Unsubscribe."""
        self._unsubscribe_description()
        super().stop()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to another robot description, or redraw the rings with a new frame prefix."""
        super().on_property_changed(path)
        if path == (_DESCRIPTION,):
            self._subscribe_description()
        elif path == (_PREFIX,):
            self.reset()
            self.on_frames_changed()

    def on_enabled_changed(self) -> None:
        """Subscribe to the joint states and the robot's description, or unsubscribe from both."""
        super().on_enabled_changed()
        self._subscribe_description()

    def frame_of(self, message: Any) -> tuple[str, int]:
        """Return the frame of the first known joint in the message, and the stamp in ns.

        The joint determines the frame, because joint states have none.

        If no joint is known, the frame is the Fixed Frame.
        """
        stamp = message.header.stamp
        joint = next((self._joints[name] for name in message.name if self._joints and name in self._joints), None)
        frame = self.host.frames.fixed_frame if joint is None else self._get_frame(joint)
        return frame, stamp.nanoseconds

    def content(self, message: Any) -> DataContent | None:
        """Return a ring for each joint with a finite effort and a known pose.

        Return None, and show the reason in the status, if no rings can be drawn.
        """
        if self._joints is None:
            self.refuse(phrase("Robot model might not be loaded yet"))
            return None
        if len(message.name) != len(message.effort):
            self.refuse(phrase("Received a joint state msg with different joint names and efforts size!"))
            return None
        self.accept()
        _, stamp_ns = self.frame_of(message)
        rings = [
            (joint, effort, pose)
            for name, effort in zip(message.name, message.effort, strict=True)
            if (joint := self._joints.get(name)) is not None
            and (pose := self._compute_ring_pose(joint, float(effort), stamp_ns)) is not None
        ]
        return EffortRings(
            [joint.name for joint, _, _ in rings],
            np.array([pose for _, _, pose in rings], dtype=np.float32).reshape(-1, 7),
            np.array([effort for _, effort, _ in rings], dtype=np.float32),
            np.array([joint.limit.effort if joint.limit else 0.0 for joint, _, _ in rings], dtype=np.float32),
        )

    def _compute_ring_pose(self, joint: Joint, effort: float, stamp_ns: int) -> tuple[float, ...] | None:
        if not math.isfinite(effort):
            self.set_status_row(joint.name, "error", phrase("Invalid effort: {effort}", effort=effort))
            return None
        frame, fixed_frame = self._get_frame(joint), self.host.frames.fixed_frame
        try:
            pose = self.context.transforms.pose(fixed_frame, frame, stamp_ns)
        except TransformException:
            self.set_status_row(
                joint.name,
                "error",
                phrase(
                    "Error transforming from frame '{frame}' to frame '{fixed_frame}'",
                    frame=frame,
                    fixed_frame=fixed_frame,
                ),
            )
            return None
        self.set_status_row(joint.name, "ok", phrase("OK"))
        x, y, z, *rotation = (float(coordinate) for coordinate in pose)
        qx, qy, qz, qw = rotation
        return (x, y, z, *quaternion_multiply((qx, qy, qz, qw), rotation_from_z(joint.axis)))

    def _get_frame(self, joint: Joint) -> str:
        return get_frame_name(joint.child, self.properties.text(_PREFIX))

    # --- description -------------------------------------------------------------------------------------------

    def _subscribe_description(self) -> None:
        self._unsubscribe_description()
        topic = self.properties.text(_DESCRIPTION).strip()
        if not self.enabled or not topic:
            return
        try:
            self._description_subscription = self.context.node.create_subscription(
                String, topic, self._on_description, DESCRIPTION_QOS
            )
        except LinkwrightError as error:
            self.set_status_row(
                _URDF, "error", phrase("Error subscribing: {message}", message=error.diagnostics[0].message)
            )

    def _unsubscribe_description(self) -> None:
        if self._description_subscription is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self.context.node.destroy_subscription(self._description_subscription)
            self._description_subscription = None

    def _on_description(self, message: String) -> None:
        robot = self.context.library.read(message.data).robot
        if robot is None:
            self.set_status_row(_URDF, "error", phrase("Unable to parse robot model description!"))
            return
        self.set_status_row(_URDF, "ok", phrase("Robot model parsed Ok"))
        previous_joints = self._joints
        self._joints = {
            joint.name: joint
            for joint in robot.joints.values()
            if joint.type in _ROTATING_TYPES and joint.limit is not None
        }
        if previous_joints is None or previous_joints.keys() != self._joints.keys():
            self.publish_properties()
        self.show_again()
