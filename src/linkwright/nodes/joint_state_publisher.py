"""joint_state_publisher: publishes joint states of a robot whose joints are not measured.

The node follows the ROS 2 node of that name (2.4), with these deliberate differences:

- The parameters ``dependent_joints.*`` take precedence over ``<mimic>`` tags, even after the description changes.
- After a new description, existing joints keep their positions, and the first message is published immediately.
- A parameter that is changed while the node runs takes effect.
- Descriptions are URDF. SDF and COLLADA, which the ROS node also reads, are reported and ignored.
- Infinite limits become a range that a slider can show, and an invalid description does not replace the previous one.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.graph import (
    DEFAULT_QOS,
    DESCRIPTION_QOS,
    Graph,
    Parameter,
    SetParametersResult,
    Subscription,
    Timer,
)
from linkwright.messages import Header, JointState, String, Time
from linkwright.nodes.joint_layout import (
    JointLayout,
    JointRange,
    JointSettings,
    declare_settings,
    empty_layout,
    make_layout,
    parse_settings,
)
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.urdf import Robot

Array = NDArray[np.float64]


class _Quantity:
    """The positions, velocities or efforts of the free joints.

    NaN marks a joint without a value.
    """

    def __init__(self, values: Array) -> None:
        self._values_and_zero = np.append(values, 0.0)
        self.values = self._values_and_zero[:-1]

    def expand(self, layout: JointLayout, *, scaled: bool, shifted: bool) -> Array | None:
        """Return a value for each published joint, for a message.

        The result is None if no joint has a value. Otherwise, a joint without a value has 0, as in the ROS node. The
        same applies to a joint that mimics a joint without a value.

        Args:
            layout: the joints.
            scaled: whether to multiply by the factors of mimic joints.
            shifted: whether to add the offsets of mimic joints.
        """
        if np.isnan(self.values).all():
            return None
        values: Array = self._values_and_zero[layout.master_indices]  # masters is -1 for joints that do not move
        if scaled:
            values *= layout.factor
        if shifted:
            values += layout.offset
        values[np.isnan(values)] = 0.0
        return values


class JointPositions:
    """Positions (rad or m), velocities and efforts of the free joints.

    The values of mimic joints are computed from them.

    Args:
        settings: the settings, which determine the quantities that joints have from the start.
    """

    def __init__(self, settings: JointSettings) -> None:
        self.layout = empty_layout()
        self._rows: dict[str, int] = {}
        self._direction: NDArray[np.float64] = np.ones(0)
        self._position, self._velocity, self._effort = (_Quantity(np.zeros(0)) for _ in range(3))
        self.set_layout(self.layout, settings)

    def set_layout(self, layout: JointLayout, settings: JointSettings) -> None:
        """Change to another layout.

        Joints that are free in both layouts keep their velocities and efforts. Those that have left their initial
        position, or would otherwise have no position, also keep their position, clamped to the new limits. All other
        joints start at their zero position, or without a position if ``publish_default_positions`` is false.
        """
        old_states, old_rows = self._collect_free_states(), self._rows
        old_zeros = {joint.name: joint.zero for joint in self.layout.free}
        self.layout = layout
        self._rows = {joint.name: row for row, joint in enumerate(layout.free)}
        initial_positions = [joint.zero if settings.publish_default_positions else np.nan for joint in layout.free]
        count = len(layout.free)
        self._position = _Quantity(np.array(initial_positions, dtype=np.float64))
        self._velocity = _Quantity(np.full(count, 0.0 if settings.publish_default_velocities else np.nan))
        self._effort = _Quantity(np.full(count, 0.0 if settings.publish_default_efforts else np.nan))
        self._direction = np.ones(count)
        self._lower = np.array([joint.lower for joint in layout.free])
        self._upper = np.array([joint.upper for joint in layout.free])
        self._reversal_limit = self._upper
        self._is_continuous = np.array([joint.kind == "continuous" for joint in layout.free], dtype=np.bool_)
        for joint in layout.free:
            row = old_rows.get(joint.name)
            if row is not None:
                self._restore_state(joint, old_states[:, row], old_zeros[joint.name])

    def apply_message(self, message: JointState) -> None:
        """Apply the values of a message to the free joints.

        Positions are not clamped to the limits.
        """
        for index, name in enumerate(message.name):
            row = self._rows.get(name)
            if row is None:
                continue
            for quantity, values in (
                (self._position, message.position),
                (self._velocity, message.velocity),
                (self._effort, message.effort),
            ):
                if index < len(values):
                    quantity.values[row] = values[index]

    def sweep(self, delta: float) -> None:
        """Move every free joint by `delta` (rad or m).

        Joints reverse at their limits. Continuous joints wrap around instead.
        """
        position, direction = self._position.values, self._direction
        position += direction * delta
        has_passed_limit = (position - self._reversal_limit) * direction > 0.0
        if has_passed_limit.any():
            position[has_passed_limit] = np.where(self._is_continuous, self._lower, self._reversal_limit)[
                has_passed_limit
            ]
            self._direction = np.where(has_passed_limit & ~self._is_continuous, -direction, direction)
            self._reversal_limit = np.where(self._direction > 0.0, self._upper, self._lower)

    def set_position(self, name: str, position: float) -> None:
        """Set the position of a free joint, clamped to its limits.

        Raises:
            KeyError: there is no such joint.
        """
        row = self._rows[name]
        self._position.values[row] = min(max(position, self._lower[row]), self._upper[row])

    def published_positions(self) -> Array:
        """Return the positions of all published joints, in the order of messages.

        Unknown positions are 0.
        """
        positions = self._position.expand(self.layout, scaled=True, shifted=True)
        return np.zeros(len(self.layout.ranges)) if positions is None else positions

    def fill_message(self, message: JointState) -> None:
        """Write the joint names and values to a message.

        Quantities without any value remain empty.
        """
        message.name = list(self.layout.ranges)
        velocities = self._velocity.expand(self.layout, scaled=True, shifted=False)
        efforts = self._effort.expand(self.layout, scaled=False, shifted=False)
        positions = self._position.expand(self.layout, scaled=True, shifted=True)
        if positions is None and self.layout.dependent:
            positions = np.zeros(len(self.layout.ranges))
        if positions is not None:
            message.position = array("d", positions.tobytes())
        if velocities is not None:
            message.velocity = array("d", velocities.tobytes())
        if efforts is not None:
            message.effort = array("d", efforts.tobytes())

    def _collect_free_states(self) -> Array:
        return np.array([self._position.values, self._velocity.values, self._effort.values])

    def _restore_state(self, joint: JointRange, state: Array, old_zero: float) -> None:
        row = self._rows[joint.name]
        position, velocity, effort = state.tolist()
        has_no_position = np.isnan(self._position.values[row])
        if not np.isnan(position) and (position != old_zero or has_no_position):
            self._position.values[row] = joint.clamp(position)
        if not np.isnan(velocity):
            self._velocity.values[row] = velocity
        if not np.isnan(effort):
            self._effort.values[row] = effort


_OTHER_FORMATS = {"sdf": "SDF", "COLLADA": "COLLADA"}
_FIRST_ELEMENT = re.compile(r"<([A-Za-z]\w*)")


class Watcher(Protocol):
    """The interface of an observer of the joints."""

    def rebuild(self) -> None:
        """Handle a change of the robot or of the settings."""

    def update_positions(self) -> None:
        """Handle positions that were set by a source topic or by the periodic motion."""


class JointStatePublisher(SingleNode):
    """The running joint_state_publisher node.

    Args:
        graph: the graph to which the node is added.
        options: the options of the node. The only argument is a URDF file; without it, the description is received on
            the topic ``robot_description``.

    Raises:
        LinkwrightError: the node cannot start: invalid parameters (NODE201), joints that mimic each other in a cycle
            (NODE202), a file that cannot be read (NODE203, or the file's error), too many arguments (NODE204), a file
            that is SDF or COLLADA (NODE205).
    """

    DEFAULT_NAME = "joint_state_publisher"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._library = options.library
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._clock = self._node.get_clock()
        self._watchers: list[Watcher] = []
        self._robot: Robot | None = None
        self._sources: list[Subscription[JointState]] = []
        with handle_start_errors(self._node):
            declare_settings(self._node)
            self._settings = self._read_settings()
            self._joints = JointPositions(self._settings)
            robot = self._read_robot_from_arguments(arguments)
            self._publisher = self._node.create_publisher(JointState, "joint_states", DEFAULT_QOS)
            self._publish_trigger = self._node.create_guard_condition(self._publish_now)
            self._timer: Timer = self._node.create_timer(1.0 / self._settings.rate, self._on_timer)
            self._subscribe_to_sources()
            self._node.add_on_set_parameters_callback(self._check_parameters)
            self._node.add_post_set_parameters_callback(self._apply_parameters)
            if robot is not None:
                self._configure(robot)
            else:
                self._wait_for_description()

    @property
    def joints(self) -> JointPositions:
        """The positions of the joints."""
        return self._joints

    def watch(self, watcher: Watcher) -> None:
        """Register a watcher that is notified of changes to the joints."""
        self._watchers.append(watcher)

    def publish_soon(self) -> None:
        """Publish in the next iteration of the event loop, once even after several calls."""
        self._publish_trigger.trigger()

    def _read_robot_from_arguments(self, arguments: Sequence[str]) -> Robot | None:
        if not arguments:
            return None
        if len(arguments) > 1:
            unknown_arguments = " ".join(arguments[1:])
            raise LinkwrightError(
                Diagnostic(
                    "NODE204",
                    phrase("unrecognized arguments: {unknown}", unknown=unknown_arguments),
                    hint=phrase("pass only a URDF file"),
                )
            )
        path = arguments[0]
        try:
            text = read_text(path)
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or error
            raise LinkwrightError(
                Diagnostic(
                    "NODE203", phrase("URDF file '{path}' cannot be read: {reason}", path=path, reason=foreign(reason))
                )
            ) from error
        reading = self._library.read(text)
        if reading.robot is None:
            other = _find_other_format(text)
            if other:
                raise LinkwrightError(
                    Diagnostic(
                        "NODE205",
                        phrase("'{path}' contains {format}, but this node reads only URDF", path=path, format=other),
                        hint=phrase("convert the file to URDF; only the ROS node also reads SDF and COLLADA"),
                    )
                )
            raise LinkwrightError(*reading.diagnostics)
        return reading.robot

    def _wait_for_description(self) -> None:
        self._node.get_logger().info("Waiting for robot_description to be published on the robot_description topic...")
        self._node.create_subscription(String, "robot_description", self._on_description, DESCRIPTION_QOS)

    def _on_description(self, message: String) -> None:
        robot = self._library.read(message.data).robot
        if robot is None:
            other = _find_other_format(message.data)
            reason = f": it is {other}, and this node reads URDF" if other else ""
            self._node.get_logger().warning(f"Invalid robot_description given, ignoring{reason}")
            return
        try:
            self._configure(robot)
        except LinkwrightError as error:
            self._node.get_logger().error(str(error))

    def _configure(self, robot: Robot) -> None:
        layout = make_layout(robot, self._settings)
        self._joints.set_layout(layout, self._settings)
        self._robot = robot
        for problem in layout.problems:
            self._node.get_logger().warning(problem)
        for watcher in self._watchers:
            watcher.rebuild()
        self.publish_soon()

    def _read_settings(self, changed: Sequence[Parameter] = ()) -> JointSettings:
        node = self._node
        values = {name: node.get_parameter(name).value for name in node.parameter_names()}
        return parse_settings(values | {parameter.name: parameter.value for parameter in changed})

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            settings = self._read_settings(parameters)
            if self._robot is not None:
                make_layout(self._robot, settings)
        except LinkwrightError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        old_settings, self._settings = self._settings, self._read_settings()
        if self._settings.rate != old_settings.rate:
            self._timer.timer_period_ns = round(1e9 / self._settings.rate)
            self._timer.reset()
        if self._settings.source_list != old_settings.source_list:
            self._subscribe_to_sources()
        if self._robot is not None:
            self._configure(self._robot)

    def _subscribe_to_sources(self) -> None:
        for source in self._sources:
            self._node.destroy_subscription(source)
        self._sources = [
            self._node.create_subscription(JointState, topic, self._on_source, DEFAULT_QOS)
            for topic in self._settings.source_list
        ]

    def _on_source(self, message: JointState) -> None:
        self._joints.apply_message(message)
        self._notify_moved()

    def _on_timer(self) -> None:
        if self._settings.delta > 0:
            self._joints.sweep(self._settings.delta)
            self._notify_moved()
        self._publish()

    def _notify_moved(self) -> None:
        for watcher in self._watchers:
            watcher.update_positions()

    def _publish_now(self) -> None:
        # Delay the next periodic message by a full period. If it were sent right after this message,
        # robot_state_publisher would delay the next move of a slider.
        self._timer.reset()
        self._publish()

    def _publish(self) -> None:
        message = JointState(header=Header(stamp=Time.from_nanoseconds(self._clock.now_ns())))
        self._joints.fill_message(message)
        if message.name:
            self._publisher.publish(message)


def _find_other_format(text: str) -> str | None:
    """Return the name of another robot format that the root element indicates, or None."""
    element = _FIRST_ELEMENT.search(text)
    return None if element is None else _OTHER_FORMATS.get(element[1])
