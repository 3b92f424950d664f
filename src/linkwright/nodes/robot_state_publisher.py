"""robot_state_publisher: publishes transforms from joint states.

It follows the ROS 2 node of that name (Humble 3.0.3 and later; see the notes on each rule), with these deliberate
differences:

- A message that the throttle holds back is published when its time comes, unless a newer one came before. The ROS node
  drops it, so the last move of a slider can be lost.
- A message that repeats the last positions does not hold back a move that comes right after it (see `Throttle`).
- A new description starts with a clear throttle, and a new ``frame_prefix`` publishes the fixed transforms again.
- ``publish_frequency`` 0, for which the ROS node divides by zero, is refused.
- ``/tf_static`` carries only the transforms of the description that holds now.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_text
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
from linkwright.messages import JointState, String, TFMessage
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.robot_transforms import MOVING_TYPES, JointGroup, RobotTransforms, Throttle
from linkwright.urdf import Robot

EMPTY_DESCRIPTION = phrase("robot_description parameter must not be empty")
EMPTY_UPDATE = "Empty URDF is not allowed"
BAD_DESCRIPTION = phrase("Unable to initialize urdf::model from robot description")
_OVERRIDES = QoSOverridingOptions([QoSPolicyKind.DEPTH, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY])
_TF_OVERRIDES = QoSOverridingOptions([*_OVERRIDES.policy_kinds, QoSPolicyKind.DURABILITY])
"""The policies that parameters ``qos_overrides.*`` may set, as with the ROS node."""

BAD_FREQUENCY = phrase("publish_frequency must be between 0 and 1000")

_NANOSECONDS_PER_MILLISECOND = 1_000_000


@dataclass(slots=True, eq=False)
class _Held:
    """A message that is held back until its time."""

    message: JointState
    release_ns: int
    timer: Timer


class RobotStatePublisher(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: it cannot start: no description (NODE101), one that cannot be read (NODE102, with what is
            wrong in it), a frequency out of range (NODE103), a parameter of the wrong type (GRAPH201), or an override
            of a quality of service that is none (GRAPH208).
    """

    DEFAULT_NAME = "robot_state_publisher"
    description_parameter = "robot_description"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._library = options.library
        self._kdl_logger = graph.get_logger("kdl_parser")
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._clock = self._node.get_clock()
        self._held: dict[JointGroup, _Held] = {}
        self._last_callback_ns = 0
        self._warned_of_zero_stamp = False
        with starting(self._node):
            self._start(arguments)

    def close(self) -> None:
        """End it."""
        self._held.clear()
        super().close()

    def _start(self, arguments: list[str]) -> None:
        node = self._node
        text: str = node.declare_parameter("robot_description", "").value
        if not text and arguments:
            text = self._description_from_file(arguments[0])
        if not text:
            raise LinkwrightError(
                Diagnostic(
                    "NODE101",
                    EMPTY_DESCRIPTION,
                    hint=phrase("give it the URDF text: parameters=[{'robot_description': Command(['xacro ', path])}]"),
                )
            )
        robot = self._read(text)
        frequency: float = node.declare_parameter("publish_frequency", 20.0).value
        if not _is_valid_frequency(frequency):
            raise LinkwrightError(
                Diagnostic(
                    "NODE103",
                    phrase("{rule}, and it is {frequency:g}", rule=BAD_FREQUENCY, frequency=frequency),
                )
            )
        self._throttle = Throttle(_interval_ns(frequency))
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
        self._set_up(text, robot)

    def _description_from_file(self, path: str) -> str:
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
                        "URDF file '{path}' cannot be read: {error}",
                        path=path,
                        error=foreign(getattr(error, "strerror", error)),
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

    def _set_up(self, text: str, robot: Robot) -> None:
        self._warn_as_kdl_parser(robot)
        for link in robot.links:
            self._node.get_logger().debug(f"Got segment {link}")
        self._robot = robot
        self._transforms = self._make_transforms()
        self._forget_published()
        self._description_publisher.publish(String(text))
        self._node.get_logger().info("Robot initialized")
        self._publish_fixed()

    def _make_transforms(self) -> RobotTransforms:
        return RobotTransforms(self._robot, self._node.get_parameter("frame_prefix").value)

    def _warn_as_kdl_parser(self, robot: Robot) -> None:
        if robot.links[robot.root].inertial is not None:
            self._kdl_logger.warning(
                f"The root link {robot.root} has an inertia specified in the URDF, but KDL does not support a root "
                "link with an inertia.  As a workaround, you can add an extra dummy link to your URDF."
            )
        for joint in robot.joints.values():
            if joint.type not in MOVING_TYPES and joint.type != "fixed":
                self._kdl_logger.warning(f"Converting unknown joint type of joint '{joint.name}' into a fixed joint")

    def _publish_fixed(self) -> None:
        self._static_publisher.publish(TFMessage(batch=self._transforms.fixed(self._clock.now_ns())))

    def _on_joint_state(self, message: JointState) -> None:
        if not self._is_well_formed(message) or not message.name:
            return
        now_ns = self._clock.now_ns()
        if now_ns < self._last_callback_ns:
            self._node.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
            self._forget_published()
        self._last_callback_ns = now_ns
        group = self._throttle.group(message.name)
        stamp_ns = message.header.stamp.nanoseconds
        move = self._throttle.is_move(group, message.position)
        opens_ns = self._throttle.opens_ns(group, now_ns, move=move)
        if self._ignore_timestamp or stamp_ns >= opens_ns:
            self._drop_held(group)
            self._publish_moving(message, stamp_ns)
            self._throttle.published(group, message.position, stamp_ns, stamp_ns)
        elif self._throttle.is_in_order(group, stamp_ns):
            if move or group in self._held:
                self._hold(message, group, opens_ns)
        elif stamp_ns == 0:
            self._warn_of_zero_stamp()

    def _warn_of_zero_stamp(self) -> None:
        if not self._warned_of_zero_stamp:
            self._warned_of_zero_stamp = True
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
        batch = self._transforms.recipe(message.name).batch(message.position, stamp_ns)
        if len(batch):
            self._tf_publisher.publish(TFMessage(batch=batch))

    def _hold(self, message: JointState, group: JointGroup, release_ns: int) -> None:
        held = self._held.get(group)
        if held is not None:
            held.message = message
            return
        wait_ns = release_ns - message.header.stamp.nanoseconds
        timer = self._node.create_timer(wait_ns / 1e9, lambda: self._release(group))
        self._held[group] = _Held(message, release_ns, timer)

    def _release(self, group: JointGroup) -> None:
        held = self._held[group]
        self._drop_held(group)
        message = held.message
        stamp_ns = message.header.stamp.nanoseconds
        if self._throttle.is_in_order(group, stamp_ns):
            self._publish_moving(message, stamp_ns)
            # Counted as published now, not at its stamp, or a source that is a little too fast would pass the limit
            # by having each message held for a moment only.
            self._throttle.published(group, message.position, stamp_ns, held.release_ns)

    def _drop_held(self, group: JointGroup) -> None:
        held = self._held.pop(group, None)
        if held is not None:
            self._node.destroy_timer(held.timer)

    def _forget_published(self) -> None:
        for group in tuple(self._held):
            self._drop_held(group)
        self._throttle.clear()

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            reason = None
            if parameter.name == "robot_description":
                reason = self._objection_to_description(parameter.value)
            elif parameter.name == "publish_frequency" and not _is_valid_frequency(parameter.value):
                reason = BAD_FREQUENCY
            if reason is not None:
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _objection_to_description(self, text: str) -> str | None:
        if not text:
            return EMPTY_UPDATE
        if self._library.read(text).robot is None:
            self._node.get_logger().warning(BAD_DESCRIPTION)
            return BAD_DESCRIPTION
        return None

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "robot_description":
                self._set_up(parameter.value, self._read(parameter.value))
            elif parameter.name == "publish_frequency":
                self._throttle.interval_ns = _interval_ns(parameter.value)
            elif parameter.name == "ignore_timestamp":
                self._ignore_timestamp = parameter.value
            elif parameter.name == "frame_prefix":
                self._transforms = self._make_transforms()
                self._publish_fixed()


def _is_valid_frequency(frequency: float) -> bool:
    return isfinite(frequency) and 0.0 < frequency <= 1000.0


def _interval_ns(frequency: float) -> int:
    return int(1000.0 / frequency) * _NANOSECONDS_PER_MILLISECOND
