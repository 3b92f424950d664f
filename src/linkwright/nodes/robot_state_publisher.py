"""robot_state_publisher: publishes transforms from joint states.

The node follows the ROS 2 node of that name (Humble 3.0.3 and later), with these deliberate differences:

- A message that the throttle delays is published as soon as the throttle permits, unless a newer message arrives
  first. The ROS node drops the message, so the last move of a slider can be missing.
- A message that repeats the last positions does not delay a move that arrives right after it (see `Throttle`).
- A new description resets the throttle, and a new ``frame_prefix`` publishes the fixed transforms again.
- ``publish_frequency`` 0, for which the ROS node divides by zero, is rejected.
- ``/tf_static`` contains only the transforms of the current description.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.geometry.arrays import quaternion_multiply, rotate, row_from_pose
from linkwright.graph import (
    DESCRIPTION_QOS,
    SENSOR_DATA_QOS,
    STATIC_TF_PUBLISHER_QOS,
    TF_QOS,
    Graph,
    Parameter,
    SetParametersResult,
    Timer,
)
from linkwright.graph.parameters.qos_overrides import QoSOverridingOptions
from linkwright.graph.qos.profile import QoSPolicyKind
from linkwright.messages import FloatSequence, JointState, String, TFMessage, TransformBatch
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.urdf import Joint, Robot

Array = NDArray[np.float64]


class JointMotion:
    """The poses of child links in their parent links as functions of joint positions.

    A rotation by q about an axis composes the rotation r of the joint's origin with (axis sin q/2, cos q/2), which is
    r cos q/2 + (r * axis) sin q/2; a translation along the axis adds q times the rotated axis. Each pose is therefore
    ``fixed + cosine cos q/2 + sine sin q/2 + linear q`` with constant rows, and a few array operations compute all
    joints, regardless of their types.

    Args:
        joints: the joints. Revolute, continuous and prismatic joints move; all others stay at their origin. Axes need
            not be of unit length (KDL normalizes them). A joint with a zero axis does not move.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self._fixed_joints, self._cosine, self._sine, self._linear = np.zeros((4, len(joints), 7))
        for row, joint in enumerate(joints):
            self._add(row, joint)

    def poses(self, positions: Array) -> Array:
        """Return the poses for joint positions of shape (n,), in radians or meters.

        The result has shape (n, 7): x y z in meters, and the quaternion qx qy qz qw.
        """
        half_angles = (0.5 * positions)[:, np.newaxis]
        poses: Array = self._cosine * np.cos(half_angles)
        poses += self._sine * np.sin(half_angles)
        poses += self._linear * positions[:, np.newaxis]
        poses += self._fixed_joints
        return poses

    def select(self, rows: Sequence[int]) -> JointMotion:
        """Return the motion of the joints with the given indices, in the given order."""
        selected = JointMotion(())
        selected._fixed_joints, selected._cosine = self._fixed_joints[rows], self._cosine[rows]
        selected._sine, selected._linear = self._sine[rows], self._linear[rows]
        return selected

    def _add(self, row: int, joint: Joint) -> None:
        rotation = row_from_pose(joint.origin)[3:]
        length = sqrt(sum(component * component for component in joint.axis))
        axis = np.array(joint.axis) / length if length else np.zeros(3)
        self._fixed_joints[row, :3] = joint.origin.xyz
        if joint.type in ("revolute", "continuous") and length:
            self._cosine[row, 3:] = rotation
            self._sine[row, 3:] = quaternion_multiply(rotation, [*axis, 0.0])
        else:
            self._fixed_joints[row, 3:] = rotation
            if joint.type == "prismatic":
                self._linear[row, :3] = rotate(rotation, axis)


MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
FIXED_TYPES = frozenset({"fixed", "planar"})
"""The joint types that are published as fixed transforms.

kdl_parser converts planar and floating joints to fixed joints, but robot_state_publisher skips floating joints: another
node must publish their transforms.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """The conversion from joint states to transforms, for one list of joint names.

    Transform i is the pose of joint i of `motion` at position ``message[source[i]] * factor[i] + offset[i]``.
    """

    parents: tuple[str, ...]
    children: tuple[str, ...]
    source: NDArray[np.intp]
    factor: Array
    offset: Array
    motion: JointMotion

    def batch(self, positions: FloatSequence, stamp_ns: int) -> TransformBatch:
        """Return the transforms for a message's positions."""
        values = np.asarray(positions, dtype=np.float64)[self.source] * self.factor + self.offset
        return TransformBatch(self.parents, self.children, stamp_ns, self.motion.poses(values))


class RobotTransforms:
    """The transforms of one robot, computed from joint states.

    Args:
        robot: the description.
        frame_prefix: the prefix of every frame name, without a separator.
    """

    def __init__(self, robot: Robot, frame_prefix: str) -> None:
        self._prefix = frame_prefix
        self._moving_joints: Mapping[str, Joint] = {
            name: joint for name, joint in robot.joints.items() if joint.type in MOVING_TYPES
        }
        self._rows = {name: row for row, name in enumerate(self._moving_joints)}
        self._motion = JointMotion(tuple(self._moving_joints.values()))
        self._fixed_joints = tuple(joint for joint in robot.joints.values() if joint.type in FIXED_TYPES)
        self._conversions: dict[tuple[str, ...], Conversion] = {}

    def fixed_transforms(self, stamp_ns: int) -> TransformBatch:
        """Return the transforms of the joints that do not move."""
        poses = JointMotion(self._fixed_joints).poses(np.zeros(len(self._fixed_joints)))
        return TransformBatch(*self._find_frames(self._fixed_joints), stamp_ns, poses)

    def find_conversion(self, names: Sequence[str]) -> Conversion:
        """Return the conversion to transforms for messages with these joint names.

        Names of joints that do not move or do not exist are ignored. A mimic joint follows the joint that it mimics,
        unless the message contains a position for the mimic joint itself. Chains of mimic joints are not followed: a
        joint has no transform if the message contains neither its position nor that of the joint that it mimics.
        """
        key = tuple(names)
        conversion = self._conversions.get(key)
        if conversion is None:
            conversion = self._conversions[key] = self._make_conversion(key)
        return conversion

    def _make_conversion(self, names: tuple[str, ...]) -> Conversion:
        indices: dict[str, int] = {}
        for index, name in enumerate(names):
            indices.setdefault(name, index)
        sources: list[tuple[Joint, int, float, float]] = []
        for name, joint in self._moving_joints.items():
            mimic = joint.mimic
            if name in indices:
                sources.append((joint, indices[name], 1.0, 0.0))
            elif mimic is not None and mimic.joint in indices:
                sources.append((joint, indices[mimic.joint], mimic.multiplier, mimic.offset))
        joints = tuple(joint for joint, *_ in sources)
        return Conversion(
            *self._find_frames(joints),
            np.array([source for _, source, _, _ in sources], dtype=np.intp),
            np.array([factor for _, _, factor, _ in sources], dtype=np.float64),
            np.array([offset for *_, offset in sources], dtype=np.float64),
            self._motion.select([self._rows[joint.name] for joint in joints]),
        )

    def _find_frames(self, joints: Sequence[Joint]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        parents = tuple(self._prefix + joint.parent for joint in joints)
        children = tuple(self._prefix + joint.child for joint in joints)
        return parents, children


class JointGroup:
    """The joints of messages with the same list of names, for a throttle."""

    __slots__ = ("positions", "rows")

    def __init__(self, rows: NDArray[np.intp]) -> None:
        self.rows = rows
        self.positions: NDArray[np.float64] | None = None
        """A copy of the last published positions. A copy is needed because a publisher may reuse its message."""


class Throttle:
    """A limit on the rate at which the transforms of the same joints are published.

    Times are in nanoseconds, and 0 means never. A message may be published when its stamp is at least one interval
    after the last publication of the joint that was published least recently. Messages that repeat the previous
    positions, such as the periodic messages of joint_state_publisher, must keep that interval from all messages.
    Messages with new positions must keep it only from other messages with new positions, so that a repeated message
    does not delay a move that follows it.

    Args:
        interval_ns: the minimum time between two messages about the same joints.
    """

    def __init__(self, interval_ns: int) -> None:
        self.interval_ns = interval_ns
        self._joint_rows: dict[str, int] = {}
        self._groups: dict[tuple[str, ...], JointGroup] = {}
        self._sent_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._moved_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._stamp_ns: NDArray[np.int64] = np.zeros(0, dtype=np.int64)

    def group(self, names: Sequence[str]) -> JointGroup:
        """Return the group for a list of joint names.

        The list must not be empty.
        """
        key = tuple(names)
        group = self._groups.get(key)
        if group is None:
            rows = [self._joint_rows.setdefault(name, len(self._joint_rows)) for name in key]
            new_times = np.zeros(len(self._joint_rows) - len(self._sent_ns), dtype=np.int64)
            self._sent_ns = np.append(self._sent_ns, new_times)
            self._moved_ns = np.append(self._moved_ns, new_times)
            self._stamp_ns = np.append(self._stamp_ns, new_times)
            group = self._groups[key] = JointGroup(np.array(rows, dtype=np.intp))
        return group

    def is_move(self, group: JointGroup, positions: FloatSequence) -> bool:
        """Return whether positions differ from the last published positions of the group."""
        return group.positions is None or not np.array_equal(group.positions, positions)

    def earliest_stamp_ns(self, group: JointGroup, now_ns: int, *, is_move: bool) -> int:
        """Return the earliest stamp at which a message may be published.

        Args:
            group: the joints of the message.
            now_ns: the current time.
            is_move: whether the message has new positions.
        """
        publication_times = self._moved_ns if is_move else self._sent_ns
        return min(int(publication_times[group.rows].min()), now_ns) + self.interval_ns

    def is_in_order(self, group: JointGroup, stamp_ns: int) -> bool:
        """Return whether all joints were published before, and none with a later stamp."""
        stamps = self._stamp_ns[group.rows]
        return bool(stamps.all() and (stamps <= stamp_ns).all())

    def record_publication(self, group: JointGroup, positions: FloatSequence, stamp_ns: int, time_ns: int) -> None:
        """Record that a message was published.

        Args:
            group: the joints of the message.
            positions: the positions of these joints, in rad or m.
            stamp_ns: the stamp of the message.
            time_ns: the time of its publication.
        """
        if self.is_move(group, positions):
            self._moved_ns[group.rows] = time_ns
        self._sent_ns[group.rows] = time_ns
        self._stamp_ns[group.rows] = stamp_ns
        group.positions = np.array(positions, dtype=np.float64)

    def clear(self) -> None:
        """Discard the record of all publications."""
        for times in (self._sent_ns, self._moved_ns, self._stamp_ns):
            times[:] = 0


EMPTY_DESCRIPTION = phrase("robot_description parameter must not be empty")
EMPTY_UPDATE = "Empty URDF is not allowed"
BAD_DESCRIPTION = phrase("Unable to initialize urdf::model from robot description")
_OVERRIDES = QoSOverridingOptions([QoSPolicyKind.DEPTH, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY])
_TF_OVERRIDES = QoSOverridingOptions([*_OVERRIDES.policy_kinds, QoSPolicyKind.DURABILITY])
"""The policies that parameters ``qos_overrides.*`` may set, as in the ROS node."""

BAD_FREQUENCY = phrase("publish_frequency must be between 0 and 1000")

_NANOSECONDS_PER_MILLISECOND = 1_000_000


@dataclass(slots=True, eq=False)
class _DelayedMessage:
    """A message that is delayed until the throttle permits its publication."""

    message: JointState
    release_ns: int
    timer: Timer


class RobotStatePublisher(SingleNode):
    """The running robot_state_publisher node.

    Raises:
        LinkwrightError: the node cannot start: no description (NODE101), an invalid description (NODE102, with its
            errors), a frequency out of range (NODE103), a file that cannot be read (NODE104), a parameter of the wrong
            type (GRAPH201), or an invalid QoS override (GRAPH208).
    """

    DEFAULT_NAME = "robot_state_publisher"
    description_parameter = "robot_description"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._library = options.library
        self._kdl_logger = graph.get_logger("kdl_parser")
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._clock = self._node.get_clock()
        self._delayed: dict[JointGroup, _DelayedMessage] = {}
        self._last_callback_ns = 0
        self._has_warned_of_zero_stamp = False
        with handle_start_errors(self._node):
            self._start(arguments)

    def close(self) -> None:
        """Close the node."""
        self._delayed.clear()
        super().close()

    def _start(self, arguments: list[str]) -> None:
        node = self._node
        text: str = node.declare_parameter("robot_description", "").value
        if not text and arguments:
            text = self._read_description(arguments[0])
        if not text:
            raise LinkwrightError(
                Diagnostic(
                    "NODE101",
                    EMPTY_DESCRIPTION,
                    hint=phrase(
                        "set it to the URDF text: parameters=[{'robot_description': Command(['xacro ', path])}]"
                    ),
                )
            )
        robot = self._read(text)
        frequency: float = node.declare_parameter("publish_frequency", 20.0).value
        if not _is_valid_frequency(frequency):
            raise LinkwrightError(
                Diagnostic(
                    "NODE103",
                    phrase("{rule}, but it is {frequency:g}", rule=BAD_FREQUENCY, frequency=frequency),
                )
            )
        self._throttle = Throttle(_compute_interval_ns(frequency))
        self._ignore_timestamp: bool = node.declare_parameter("ignore_timestamp", False).value
        node.declare_parameter("frame_prefix", "")
        self._description_publisher = node.create_publisher(String, "robot_description", DESCRIPTION_QOS)
        self._tf_publisher = node.create_publisher(TFMessage, "/tf", TF_QOS, qos_overriding_options=_TF_OVERRIDES)
        self._static_publisher = node.create_publisher(
            TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS, qos_overriding_options=_OVERRIDES
        )
        node.create_subscription(
            JointState, "joint_states", self._on_joint_state, SENSOR_DATA_QOS, qos_overriding_options=_OVERRIDES
        )
        node.add_on_set_parameters_callback(self._check_parameters)
        node.add_post_set_parameters_callback(self._apply_parameters)
        self._use_description(text, robot)

    def _read_description(self, path: str) -> str:
        self._node.get_logger().warning(
            "No robot_description parameter, but command-line argument available.  Assuming argument is name of URDF "
            "file.  This backwards compatibility fallback will be removed in the future."
        )
        try:
            return read_text(path)
        except (OSError, UnicodeDecodeError) as error:
            raise LinkwrightError(
                Diagnostic(
                    "NODE104",
                    phrase(
                        "URDF file '{path}' cannot be read: {reason}",
                        path=path,
                        reason=foreign(getattr(error, "strerror", error)),
                    ),
                )
            ) from error

    def _read(self, text: str) -> Robot:
        reading = self._library.read(text)
        if reading.robot is None:
            hint = None
            if "<" not in text:
                hint = phrase(
                    "'{text}' is not URDF; if it is a file's name, pass the file's text: Command(['xacro ', path])",
                    text=text.strip()[:80],
                )
            raise LinkwrightError(Diagnostic("NODE102", BAD_DESCRIPTION, hint=hint), *reading.diagnostics)
        return reading.robot

    def _use_description(self, text: str, robot: Robot) -> None:
        self._log_kdl_warnings(robot)
        for link in robot.links:
            self._node.get_logger().debug(f"Got segment {link}")
        self._robot = robot
        self._transforms = self._make_transforms()
        self._clear_publications()
        self._description_publisher.publish(String(data=text))
        self._node.get_logger().info("Robot initialized")
        self._publish_fixed()

    def _make_transforms(self) -> RobotTransforms:
        return RobotTransforms(self._robot, self._node.get_parameter("frame_prefix").value)

    def _log_kdl_warnings(self, robot: Robot) -> None:
        if robot.links[robot.root].inertial is not None:
            self._kdl_logger.warning(
                f"The root link {robot.root} has an inertia specified in the URDF, but KDL does not support a root "
                "link with an inertia.  As a workaround, you can add an extra dummy link to your URDF."
            )
        for joint in robot.joints.values():
            if joint.type not in MOVING_TYPES and joint.type != "fixed":
                self._kdl_logger.warning(f"Converting unknown joint type of joint '{joint.name}' into a fixed joint")

    def _publish_fixed(self) -> None:
        self._static_publisher.publish(TFMessage(batch=self._transforms.fixed_transforms(self._clock.now_ns())))

    def _on_joint_state(self, message: JointState) -> None:
        if not self._is_well_formed(message) or not message.name:
            return
        now_ns = self._clock.now_ns()
        if now_ns < self._last_callback_ns:
            self._node.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
            self._clear_publications()
        self._last_callback_ns = now_ns
        group = self._throttle.group(message.name)
        stamp_ns = message.header.stamp.nanoseconds
        is_move = self._throttle.is_move(group, message.position)
        earliest_ns = self._throttle.earliest_stamp_ns(group, now_ns, is_move=is_move)
        if self._ignore_timestamp or stamp_ns >= earliest_ns:
            self._drop_delayed(group)
            self._publish_moving(message, stamp_ns)
            self._throttle.record_publication(group, message.position, stamp_ns, stamp_ns)
        elif self._throttle.is_in_order(group, stamp_ns):
            if is_move or group in self._delayed:
                self._delay(message, group, earliest_ns)
        elif stamp_ns == 0:
            self._warn_of_zero_stamp()

    def _warn_of_zero_stamp(self) -> None:
        if not self._has_warned_of_zero_stamp:
            self._has_warned_of_zero_stamp = True
            self._node.get_logger().warning(
                "Ignoring JointState messages without a time stamp: set header.stamp, or the parameter ignore_timestamp"
            )

    def _is_well_formed(self, message: JointState) -> bool:
        if len(message.name) == len(message.position):
            return True
        if len(message.position) == 0:
            self._node.get_logger().warning(
                "Robot state publisher ignored a JointState message about joint(s) "
                f'"{message.name[0]}"(,...) whose position member was empty.'
            )
        else:
            self._node.get_logger().error("Robot state publisher ignored an invalid JointState message")
        return False

    def _publish_moving(self, message: JointState, stamp_ns: int) -> None:
        batch = self._transforms.find_conversion(message.name).batch(message.position, stamp_ns)
        if len(batch):
            self._tf_publisher.publish(TFMessage(batch=batch))

    def _delay(self, message: JointState, group: JointGroup, release_ns: int) -> None:
        delayed = self._delayed.get(group)
        if delayed is not None:
            delayed.message = message
            return
        wait_ns = release_ns - message.header.stamp.nanoseconds
        timer = self._node.create_timer(wait_ns / 1e9, lambda: self._release(group))
        self._delayed[group] = _DelayedMessage(message, release_ns, timer)

    def _release(self, group: JointGroup) -> None:
        delayed = self._delayed[group]
        self._drop_delayed(group)
        message = delayed.message
        stamp_ns = message.header.stamp.nanoseconds
        if self._throttle.is_in_order(group, stamp_ns):
            self._publish_moving(message, stamp_ns)
            # Count the message as published now, not at its stamp. With its stamp, a source that is slightly too fast
            # would exceed the limit, because each message would be delayed only briefly.
            self._throttle.record_publication(group, message.position, stamp_ns, delayed.release_ns)

    def _drop_delayed(self, group: JointGroup) -> None:
        delayed = self._delayed.pop(group, None)
        if delayed is not None:
            self._node.destroy_timer(delayed.timer)

    def _clear_publications(self) -> None:
        for group in tuple(self._delayed):
            self._drop_delayed(group)
        self._throttle.clear()

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            reason = None
            if parameter.name == "robot_description":
                reason = self._description_error(parameter.value)
            elif parameter.name == "publish_frequency" and not _is_valid_frequency(parameter.value):
                reason = BAD_FREQUENCY
            if reason is not None:
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _description_error(self, text: str) -> str | None:
        if not text:
            return EMPTY_UPDATE
        if self._library.read(text).robot is None:
            self._node.get_logger().warning(BAD_DESCRIPTION)
            return BAD_DESCRIPTION
        return None

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "robot_description":
                self._use_description(parameter.value, self._read(parameter.value))
            elif parameter.name == "publish_frequency":
                self._throttle.interval_ns = _compute_interval_ns(parameter.value)
            elif parameter.name == "ignore_timestamp":
                self._ignore_timestamp = parameter.value
            elif parameter.name == "frame_prefix":
                self._transforms = self._make_transforms()
                self._publish_fixed()


def _is_valid_frequency(frequency: float) -> bool:
    return isfinite(frequency) and 0.0 < frequency <= 1000.0


def _compute_interval_ns(frequency: float) -> int:
    return int(1000.0 / frequency) * _NANOSECONDS_PER_MILLISECOND
