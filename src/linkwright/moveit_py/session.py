"""The node, robot, scene and controllers that the classes of MoveIt's Python library share."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from time import monotonic, sleep
from typing import Any, Protocol

from linkwright.graph import Publisher
from linkwright.graph.faults import ExternalShutdownException
from linkwright.graph.parameters.parameter import Parameter
from linkwright.messages import get_message
from linkwright.moveit_py.execution import TrajectoryExecutionManager
from linkwright.moveit_py.robot_model import RobotModel
from linkwright.moveit_py.robot_state import RobotState
from linkwright.moveit_py.robot_trajectory import RobotTrajectory
from linkwright.planning.nodes.pipelines import Pipelines
from linkwright.planning.nodes.robot_context import RobotContext, read_description
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor
from linkwright.standins.rclpy_api.node import Node

_MONITOR = "planning_scene_monitor_options."
_STATE_TIMEOUT_S = 10.0
_POLL_S = 0.02


class Session:
    """A node that receives the state of the robot, and everything that plans need.

    Args:
        node_name: the name of the node, which the command line can change.
        namespace: the namespace of the node.
        arguments: a command line for the node, without ``--ros-args``.
        config: parameters in nested dictionaries.

    Attributes:
        node: the node.
        parameters: the parameters of the node by name.
        model: the robot.
        monitor: the planning scene.
        monitor_name: the name of the planning scene monitor.
        pipelines: the planning pipelines.
        execution: the controllers.

    Raises:
        LinkwrightError: ARM104, a parameter with a description is missing; or the description has errors.
    """

    def __init__(self, node_name: str, namespace: str, arguments: Sequence[str], config: Mapping[str, Any]) -> None:
        self.node = node = Node(
            node_name,
            namespace=namespace or None,
            cli_args=["--ros-args", *arguments] if arguments else None,
            parameter_overrides=[Parameter(name, value=value) for name, value in _flatten(config)],
            automatically_declare_parameters_from_overrides=True,
            allow_undeclared_parameters=True,
        )
        self.parameters = {name: item.value for name, item in node.get_parameters_by_prefix("").items()}
        urdf, srdf = (
            read_description(self.parameters, name, node.get_name())
            for name in ("robot_description", "robot_description_semantic")
        )
        self._robot = robot = RobotContext(node, urdf, srdf, self.parameters)
        self.model = RobotModel.from_parts(robot.robot, robot.semantics, robot.groups)
        topic = str(self.parameters.get(f"{_MONITOR}publish_planning_scene_topic") or "monitored_planning_scene")
        self.monitor = SceneMonitor(node, robot, publishes_states=True, topic=topic)
        self.monitor_name = str(self.parameters.get(f"{_MONITOR}name") or "planning_scene_monitor")
        self.pipelines = Pipelines(self.parameters)
        self.execution = TrajectoryExecutionManager(node, robot, self.parameters)
        self._path_publisher: Publisher[Any] = node.create_publisher(
            "moveit_msgs/msg/DisplayTrajectory", "display_planned_path", 10
        )
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        threading.Thread(target=self._spin, name="moveit_py", daemon=True).start()
        timeout = float(self.parameters.get(f"{_MONITOR}wait_for_initial_state_timeout") or _STATE_TIMEOUT_S)
        if not self.wait_for_state(timeout):
            self.log_warning("The state of the robot is not known: nothing was received on 'joint_states'")

    def close(self) -> None:
        """Stop the execution and destroy the node."""
        self.execution.stop_execution()
        self._executor.shutdown()
        self.node.destroy_node()

    def current_state(self) -> RobotState:
        """Return the current state of the robot."""
        state = RobotState(self.model)
        if self._robot.has_state:
            state.positions = self._robot.positions.copy()
        return state

    def wait_for_state(self, timeout_s: float) -> bool:
        """Wait for the state of the robot, and return whether it was received."""
        deadline = monotonic() + timeout_s
        while not self._robot.has_state and monotonic() < deadline and self.node.context.ok():
            sleep(_POLL_S)
        return self._robot.has_state

    def show(self, trajectory: RobotTrajectory, start: Any) -> None:
        """Publish a planned trajectory for the display.

        Args:
            trajectory: the trajectory.
            start: the moveit_msgs/msg/RobotState at its start.
        """
        message = get_message("moveit_msgs/msg/DisplayTrajectory")()
        message.model_id, message.trajectory_start = self.model.name, start
        message.trajectory = [trajectory.get_robot_trajectory_msg()]
        self._path_publisher.publish(message)

    def log_warning(self, text: str) -> None:
        """Log a warning."""
        self.node.get_logger().warning(text)

    def log_error(self, text: str) -> None:
        """Log an error."""
        self.node.get_logger().error(text)

    def _spin(self) -> None:
        with suppress(ExternalShutdownException):
            self._executor.spin()


class HasSession(Protocol):
    """An instance of MoveItPy."""

    @property
    def session(self) -> Session:
        """The node, the robot, the scene and the controllers."""


def _flatten(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the parameters of nested dictionaries, with dots in their names."""
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        elif value is not None and value not in ([], ()):
            yield f"{prefix}{name}", value
