"""The nodes of ros2_controllers_test_nodes, which send goals to controllers in turn.

Source: ros2_controllers_test_nodes (parameters and topics).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from math import pi
from typing import Any, ClassVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.messages import Duration, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_POINT_FIELDS = ("positions", "velocities", "accelerations", "effort")
_MOTION_NS = 4_000_000_000
"""The time in which a goal of a trajectory is reached."""


class _GoalPublisher(SingleNode):
    """The base class of the nodes.

    Parameters: ``goal_names``, the goals, and ``wait_sec_between_publish``, the seconds between two goals.

    Raises:
        LinkwrightError: NODE905, no goal is valid.
    """

    DEFAULT_NAME: ClassVar[str]
    PERIOD_S: ClassVar[int]

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._next_goal = 0
        with handle_start_errors(self._node):
            period = self._node.declare_parameter("wait_sec_between_publish", self.PERIOD_S).value
            names = [str(name) for name in self._node.declare_parameter("goal_names", ["pos1", "pos2"]).value]
            self._publisher: Any = self.create_publisher()
            self._goals = self.read_goals(names)
            if not self._goals:
                message = phrase("no goal of 'goal_names' has values: {names}", names=", ".join(names))
                raise LinkwrightError(Diagnostic("NODE905", message))
            self._node.create_timer(float(period), self._on_timer)

    @abstractmethod
    def create_publisher(self) -> Any:
        """Declare the parameters of the topic, and return its publisher."""

    @abstractmethod
    def read_goals(self, names: Sequence[str]) -> list[Any]:
        """Return the messages of the goals with values."""

    def is_ready(self) -> bool:
        """Return whether the next goal may be sent."""
        return True

    def read_numbers(self, name: str) -> list[float]:
        """Declare a parameter with numbers, and return its value, which is empty if it is not set."""
        value = self._node.declare_parameter(name, ParameterType.DOUBLE_ARRAY).value
        return [] if value is None else [float(number) for number in value]

    def _on_timer(self) -> None:
        if self.is_ready():
            self._publisher.publish(self._goals[self._next_goal])
            self._next_goal = (self._next_goal + 1) % len(self._goals)


class ForwardPositionPublisher(_GoalPublisher):
    """``publisher_forward_position_controller``, which publishes lists of positions on ``publish_topic``."""

    DEFAULT_NAME = "publisher_forward_position_controller"
    PERIOD_S = 5

    def create_publisher(self) -> Any:
        """Return the publisher of ``publish_topic``."""
        topic = str(self._node.declare_parameter("publish_topic", "/position_commands").value)
        return self._node.create_publisher("std_msgs/msg/Float64MultiArray", topic, 1)

    def read_goals(self, names: Sequence[str]) -> list[Any]:
        """Return a message for each goal."""
        message = get_message("std_msgs/msg/Float64MultiArray")
        values = (self.read_numbers(name) for name in names)
        return [message(data=numbers) for numbers in values if numbers]


class JointTrajectoryPublisher(_GoalPublisher):
    """``publisher_joint_trajectory_controller``, which publishes trajectories with one point.

    With ``check_starting_point``, nothing is sent until the first joint states are within ``starting_point_limits``.
    """

    DEFAULT_NAME = "publisher_position_trajectory_controller"
    PERIOD_S = 6

    def create_publisher(self) -> Any:
        """Return the publisher of the trajectories for ``controller_name``."""
        node = self._node
        controller = str(node.declare_parameter("controller_name", "position_trajectory_controller").value)
        self._joints = [str(name) for name in node.declare_parameter("joints", [""]).value]
        self._is_started: bool | None = None
        if node.declare_parameter("check_starting_point", False).value:
            self._limits = {
                joint: list(node.declare_parameter(f"starting_point_limits.{joint}", [-2 * pi, 2 * pi]).value)
                for joint in self._joints
            }
            node.create_subscription("sensor_msgs/msg/JointState", "joint_states", self._on_joint_states, 10)
        else:
            self._is_started = True
        return node.create_publisher("trajectory_msgs/msg/JointTrajectory", f"/{controller}/joint_trajectory", 1)

    def read_goals(self, names: Sequence[str]) -> list[Any]:
        """Return a trajectory for each goal with a value for each joint."""
        return [trajectory for name in names if (trajectory := self._read_goal(name)) is not None]

    def is_ready(self) -> bool:
        """Return whether the arm started within the limits."""
        if self._is_started is None:
            self._node.get_logger().warning(localized(phrase("no joint states have arrived yet, so no goal is sent")))
        elif not self._is_started:
            self._node.get_logger().warning(localized(phrase("the arm did not start within its starting_point_limits")))
        return bool(self._is_started)

    def _read_goal(self, name: str) -> Any:
        values = {field: self.read_numbers(f"{name}.{field}") for field in _POINT_FIELDS}
        values = {field: numbers for field, numbers in values.items() if len(numbers) == len(self._joints)}
        if not values:
            message = phrase("goal '{name}' has no values for {count} joints", name=name, count=len(self._joints))
            self._node.get_logger().warning(localized(message))
            return None
        duration = Duration.from_nanoseconds(_MOTION_NS)
        point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(time_from_start=duration, **values)
        return get_message("trajectory_msgs/msg/JointTrajectory")(joint_names=self._joints, points=[point])

    def _on_joint_states(self, message: Any) -> None:
        if self._is_started is None:
            positions = dict(zip(message.name, message.position, strict=False))
            self._is_started = all(
                low <= positions.get(joint, low) <= high for joint, (low, high) in self._limits.items()
            )
