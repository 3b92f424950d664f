"""The docks of a docking server: their poses and types, from parameters or a file.

Source: opennav_docking (``docks``, ``dock_database``, ``dock_plugins``, parameters and topics of SimpleChargingDock).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.geometry.single import (
    compose,
    interpolate,
    invert,
    quaternion_from_rpy,
    quaternion_multiply,
    rpy_from_quaternion,
)
from linkwright.graph import ParameterType
from linkwright.messages import Time, get_message
from linkwright.navigation.nodes.managed import ManagedNode
from linkwright.navigation.nodes.plugins import get_or_declare, get_plugin_type, get_string_list
from linkwright.navigation.slam.poses import FloatArray
from linkwright.navigation.slam.poses import compose as compose_planar
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.settings import invalid_value_error
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_CHARGING, _NON_CHARGING = "opennav_docking/SimpleChargingDock", "opennav_docking/SimpleNonChargingDock"
_WARNING_PERIOD_S = 2.0


@dataclass(frozen=True, slots=True, eq=False)
class Dock:
    """A dock.

    Attributes:
        frame: the frame of `pose`.
        pose: x, y and yaw of the docked robot, shape (3,).
        kind: the name of its plugin; empty for the only one.
    """

    frame: str
    pose: FloatArray
    kind: str


def read_docks(node: ManagedNode) -> dict[str, Dock]:
    """Return the docks of the parameters ``dock_database`` or ``docks``, by name.

    Raises:
        LinkwrightError: NAV701, the file cannot be read, or a dock is not valid.
    """
    path = str(get_or_declare(node, "dock_database", ParameterType.STRING) or "")
    if path:
        return read_dock_file(Path(path))
    docks = {}
    for name in get_string_list(node, "docks", ()):
        pose = get_or_declare(node, f"{name}.pose", ParameterType.DOUBLE_ARRAY)
        kind = get_or_declare(node, f"{name}.type", ParameterType.STRING)
        get_or_declare(node, f"{name}.id", "")
        frame = str(get_or_declare(node, f"{name}.frame", "map"))
        docks[name] = _make_dock(name, {"pose": pose, "type": kind, "frame": frame})
    return docks


def read_dock_file(path: Path) -> dict[str, Dock]:
    """Return the docks of a YAML file, by name.

    Raises:
        LinkwrightError: NAV701, the file cannot be read, or a dock is not valid.
    """
    try:
        content = yaml.safe_load(read_text(path))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        message = phrase(
            "the dock database '{path}' cannot be read: {reason}", path=display_path(path), reason=foreign(error)
        )
        raise LinkwrightError(Diagnostic("NAV701", message)) from None
    docks = content.get("docks") if isinstance(content, dict) else None
    if not isinstance(docks, dict):
        raise _make_error(phrase("the dock database '{path}' does not contain 'docks'", path=display_path(path)))
    return {str(name): _make_dock(str(name), dock) for name, dock in docks.items()}


def _make_dock(name: str, values: Any) -> Dock:
    if not isinstance(values, Mapping):
        raise _make_error(phrase("the dock '{name}' has no values", name=name))
    if not values.get("type"):
        raise _make_error(phrase("the dock '{name}' has no type", name=name))
    try:
        pose = np.array(values.get("pose"), dtype=np.float64)
    except (TypeError, ValueError):
        pose = np.zeros(0)
    if pose.shape != (3,) or not np.isfinite(pose).all():
        raise _make_error(phrase("the pose of the dock '{name}' must be [x, y, yaw]", name=name))
    return Dock(str(values.get("frame") or "map"), pose, str(values["type"]))


def _make_error(message: Phrase) -> LinkwrightError:
    return LinkwrightError(Diagnostic("NAV701", message))


def create_dock_plugins(node: ManagedNode, poses: FramePoses, base_frame: str) -> dict[str, SimpleDock]:
    """Create the plugins of the parameter ``dock_plugins``, by name.

    Raises:
        LinkwrightError: NAV701, there are no plugins; NODE431 or NODE433, the type of a plugin is not set or not known.
    """
    names = get_string_list(node, "dock_plugins", ())
    if not names:
        message = phrase("the parameter 'dock_plugins' lists no plugin")
        hint = phrase("list the name of a plugin, and set its type: NAME.plugin: {plugin}", plugin=_CHARGING)
        raise LinkwrightError(Diagnostic("NAV701", message, hint=hint))
    plugins = {}
    for name in names:
        kind = get_plugin_type(node, name, {})
        if kind not in (_CHARGING, _NON_CHARGING):
            raise invalid_value_error(f"{name}.plugin", kind, node.get_name(), [_CHARGING, _NON_CHARGING])
        node.get_logger().info(f"Created charging dock plugin {name} of type {kind}")
        plugins[name] = SimpleDock(node, name, poses, base_frame, charges=kind == _CHARGING)
    return plugins


class SimpleDock:
    """A dock whose pose is known or detected, and which may charge the robot.

    Args:
        node: the node of the server.
        name: the name of the plugin, the prefix of its parameters.
        poses: the poses of frames.
        base_frame: the frame of the robot.
        charges: whether the dock charges the robot.

    Attributes:
        charges: whether the dock charges the robot.
    """

    def __init__(self, node: ManagedNode, name: str, poses: FramePoses, base_frame: str, *, charges: bool) -> None:
        self._node, self._poses, self._base_frame, self.charges = node, poses, base_frame, charges
        self._target: tuple[str, FloatArray] | None = None
        self._has_charge = self._is_stalled = False
        self._detected: Any = None
        self._filtered: tuple[Any, str, int] | None = None

        def read(key: str, default: Any) -> Any:
            return get_or_declare(node, f"{name}.{key}", default)

        self._uses_battery = bool(read("use_battery_status", True)) if charges else False
        self._charging_threshold = float(read("charging_threshold", 0.5)) if charges else 0.0
        self._uses_detection: bool = read("use_external_detection_pose", False)
        self._detection_timeout = float(read("external_detection_timeout", 1.0))
        self._translation = np.array(
            [float(read(f"external_detection_translation_{axis}", value)) for axis, value in (("x", -0.2), ("y", 0.0))]
            + [0.0]
        )
        yaw = float(read("external_detection_rotation_yaw", 0.0))
        pitch = float(read("external_detection_rotation_pitch", 1.57))
        roll = float(read("external_detection_rotation_roll", -1.57))
        about_y, about_x, about_z = (
            quaternion_from_rpy(angles) for angles in ((0.0, pitch, 0.0), (roll, 0.0, 0.0), (0.0, 0.0, yaw))
        )
        self._rotation = quaternion_multiply(quaternion_multiply(about_y, about_x), about_z)
        self._filter = float(read("filter_coef", 0.1))
        self._uses_stall: bool = read("use_stall_detection", False)
        self._stall_joints = get_string_list(node, f"{name}.stall_joint_names", ())
        self._stall_limits = float(read("stall_velocity_threshold", 1.0)), float(read("stall_effort_threshold", 1.0))
        self._docking_threshold = float(read("docking_threshold", 0.05))
        self._staging = np.array((float(read("staging_x_offset", -0.7)), 0.0, float(read("staging_yaw_offset", 0.0))))
        self._subscribe()
        pose_class = get_message("geometry_msgs/msg/PoseStamped")
        self._dock_publisher, self._filtered_publisher, self._staging_publisher = (
            node.register(node.create_publisher(pose_class, topic, 1))
            for topic in ("dock_pose", "filtered_dock_pose", "staging_pose")
        )

    def _subscribe(self) -> None:
        for is_used, message, topic, callback in (
            (self._uses_battery, "sensor_msgs/msg/BatteryState", "battery_state", self._on_battery),
            (self._uses_detection, "geometry_msgs/msg/PoseStamped", "detected_dock_pose", self._on_detection),
            (self._uses_stall, "sensor_msgs/msg/JointState", "joint_states", self._on_joint_states),
        ):
            if is_used:
                self._node.register(self._node.create_subscription(get_message(message), topic, callback, 1))

    def _on_battery(self, message: Any) -> None:
        self._has_charge = message.current > self._charging_threshold

    def _on_detection(self, message: Any) -> None:
        self._detected = message

    def _on_joint_states(self, message: Any) -> None:
        indices = [index for index, name in enumerate(message.name) if name in self._stall_joints]
        if not indices:
            return
        velocity, effort = (
            float(np.mean([abs(values[index]) if index < len(values) else 0.0 for index in indices]))
            for values in (message.velocity, message.effort)
        )
        self._is_stalled = velocity < self._stall_limits[0] and effort > self._stall_limits[1]

    # --- poses --------------------------------------------------------------------------------------------------------

    def find_staging_pose(self, frame: str, pose: FloatArray) -> FloatArray:
        """Return the pose before a dock at which docking starts, of shape (3,), in the same frame."""
        staging = compose_planar(pose, self._staging)
        self._staging_publisher.publish(make_pose(frame, staging, self._node.get_clock().now().to_msg()))
        return staging

    def refine_pose(self, frame: str, pose: FloatArray) -> FloatArray | None:
        """Return the pose of the dock in a frame: the given one, or the detected one, or None if it is not detected."""
        if self._uses_detection:
            detected = self._find_detected_pose(frame)
            if detected is None:
                return None
            pose = detected
        self._target = frame, pose
        self._dock_publisher.publish(make_pose(frame, pose, self._node.get_clock().now().to_msg()))
        return pose

    def _find_detected_pose(self, frame: str) -> FloatArray | None:
        message = self._detected
        age = float("inf") if message is None else (self._node.now_ns() - message.header.stamp.nanoseconds) * 1e-9
        if age > self._detection_timeout:
            self._node.get_logger().warning(
                f"Lost detection or did not detect: timeout exceeded (is {age:.2f} seconds old)",
                throttle_duration_sec=_WARNING_PERIOD_S,
            )
            return None
        stamp_ns = message.header.stamp.nanoseconds
        sensor = self._poses.pose(frame, message.header.frame_id, stamp_ns)
        if sensor is None:
            return None
        position, orientation = message.pose.position, message.pose.orientation
        detected = compose(
            sensor,
            (position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w),
        )
        if self._filtered is not None:
            last, last_frame, last_ns = self._filtered
            if last_frame == frame and stamp_ns - last_ns <= self._detection_timeout * NANOSECONDS_PER_SECOND:
                detected = interpolate(last, detected, self._filter) if stamp_ns > last_ns else last
        self._filtered = detected, frame, stamp_ns
        yaw = rpy_from_quaternion(quaternion_multiply(detected[3:], self._rotation))[2]
        pose = compose_planar(np.array((detected[0], detected[1], yaw)), self._translation)
        self._filtered_publisher.publish(make_pose(frame, pose, message.header.stamp))
        return pose

    # --- states -------------------------------------------------------------------------------------------------------

    def is_docked(self) -> bool:
        """Return whether the robot is at the dock: its joints are stalled, or it is near the pose of the dock."""
        if self._uses_stall:
            return self._is_stalled
        if self._target is None:
            return False
        frame, target = self._target
        robot = self._poses.pose(frame, self._base_frame, 0)
        return robot is not None and hypot(robot[0] - target[0], robot[1] - target[1]) < self._docking_threshold

    def is_charging(self) -> bool:
        """Return whether the dock charges the robot."""
        return self.charges and (self._has_charge if self._uses_battery else self.is_docked())


def find_relative_pose(poses: FramePoses, target: str, source: str) -> FloatArray | None:
    """Return the pose of a frame in another one in the plane, of shape (3,), or None."""
    pose = poses.pose(target, source, 0)
    return None if pose is None else np.array((pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]))


def find_pose_in_robot(poses: FramePoses, base: str, frame: str, pose: FloatArray) -> FloatArray | None:
    """Return a pose of a frame, of shape (3,), in the frame of the robot, or None."""
    robot = poses.pose(frame, base, 0)
    if robot is None:
        return None
    inverse = invert(robot)
    origin = np.array((inverse[0], inverse[1], rpy_from_quaternion(inverse[3:])[2]))
    return compose_planar(origin, pose)


def make_pose(frame: str, pose: FloatArray, stamp: Time) -> Any:
    """Return a pose in the plane as a geometry_msgs/PoseStamped."""
    message = get_message("geometry_msgs/msg/PoseStamped")()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.pose.position.x, message.pose.position.y = float(pose[0]), float(pose[1])
    message.pose.orientation.z, message.pose.orientation.w = float(np.sin(pose[2] / 2)), float(np.cos(pose[2] / 2))
    return message
