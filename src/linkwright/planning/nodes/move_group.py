"""MoveIt's move_group, which plans motions of arms and executes them.

The node has the services, actions, topics and parameters of MoveIt 2 (Humble and Jazzy) for planning, kinematics, the
planning scene and execution. Differences: meshes are replaced by their convex hulls, octomaps are not supported, and a
planner that OMPL's Python package lacks is replaced by RRTConnect, with a warning.
"""

from __future__ import annotations

from time import perf_counter
from typing import Any

from linkwright.graph import LATCHED_QOS, ActionServer, Graph, Publisher
from linkwright.graph.actions.goal import CancelResponse
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_action, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.planning.nodes.awaited_descriptions import AwaitedDescriptions
from linkwright.planning.nodes.conversions import (
    RequestError,
    trajectory_message,
)
from linkwright.planning.nodes.execution import TrajectoryExecution, check_start, read_controllers
from linkwright.planning.nodes.kinematics_services import KinematicsServices
from linkwright.planning.nodes.pipelines import Pipelines
from linkwright.planning.nodes.planning_services import PlanningServices
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.sequence_services import SequenceServices

_DEFAULT_IK_TIMEOUT_S = 0.05
_MIN_IK_TIMEOUT_S = 0.005
_DEFAULT_SCALE = 0.1


class MoveGroup(SingleNode):
    """The node move_group.

    Raises:
        LinkwrightError: a description in a parameter has errors.
    """

    DEFAULT_NAME = "move_group"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        with handle_start_errors(self._node):
            self._parameters = {
                name: parameter.value for name, parameter in self._node.get_parameters_by_prefix("").items()
            }
            self._is_started = False
            AwaitedDescriptions(self._node, self._parameters, self._start)

    def close(self) -> None:
        """Stop the planning and the execution, and destroy the node."""
        if self._is_started:
            self._planning.stop()
            self._kinematics.stop()
            self._execution.stop()
        super().close()

    def _start(self, urdf: str, srdf: str) -> None:
        node, parameters = self._node, self._parameters
        self._robot = RobotContext(node, urdf, srdf, parameters)
        controllers, problems = read_controllers(parameters)
        for problem in problems:
            node.get_logger().error(problem)
        self._execution = TrajectoryExecution(node, controllers, parameters)
        publishes_states = parameters.get("publish_state_updates", parameters.get("publish_planning_scene", True))
        self._monitor = SceneMonitor(node, self._robot, publishes_states=bool(publishes_states))
        self._planning = PlanningServices(node, self._robot, self._monitor, Pipelines(parameters), self._default_scale)
        self._kinematics = KinematicsServices(
            node, self._robot, self._monitor, self._ik_timeout, self._planning.publish_path
        )
        self._error_codes = get_message("moveit_msgs/msg/MoveItErrorCodes")
        group = ReentrantCallbackGroup()
        for name, kind, callback in (
            ("move_action", "MoveGroup", self._move),
            ("execute_trajectory", "ExecuteTrajectory", self._execute_trajectory),
        ):
            ActionServer(
                node,
                get_action(f"moveit_msgs/action/{kind}"),
                name,
                callback,
                callback_group=group,
                cancel_callback=lambda _goal: CancelResponse.ACCEPT,
            )
        SequenceServices(
            node,
            self._robot,
            self._monitor,
            self._planning,
            self._execute,
            bool(parameters.get("allow_trajectory_execution", True)),
        )
        node.create_subscription("std_msgs/msg/String", "trajectory_execution_event", self._on_event, 10)
        if parameters.get("publish_robot_description_semantic", False):
            self._publish_semantics(srdf)
        self._is_started = True
        node.get_logger().info("You can start planning now!")

    def _publish_semantics(self, srdf: str) -> None:
        message = get_message("std_msgs/msg/String")()
        message.data = srdf
        publisher: Publisher[Any] = self._node.create_publisher(
            "std_msgs/msg/String", "robot_description_semantic", LATCHED_QOS
        )
        publisher.publish(message)

    # --- parameters -----------------------------------------------------------------------------------------

    def _default_scale(self, kind: str) -> float:
        return float(
            self._parameters.get(f"robot_description_planning.default_{kind}_scaling_factor") or _DEFAULT_SCALE
        )

    def _ik_timeout(self, group: str) -> float:
        value = self._parameters.get(f"robot_description_kinematics.{group}.kinematics_solver_timeout")
        return max(float(value or _DEFAULT_IK_TIMEOUT_S), _MIN_IK_TIMEOUT_S)

    # --- execution ------------------------------------------------------------------------------------------

    async def _move(self, goal: Any) -> Any:
        action = get_action("moveit_msgs/action/MoveGroup")
        result, request, planning_options = action.Result(), goal.request.request, goal.request.planning_options
        started = perf_counter()

        def publish_state(state: str) -> None:
            feedback = action.Feedback()
            feedback.state = state
            goal.publish_feedback(feedback)

        publish_state("PLANNING")
        try:
            scene = self._monitor.scene_with_difference(planning_options.planning_scene_diff)
            start, trajectory, names = await self._planning.plan(request, scene, lambda: bool(goal.is_cancel_requested))
            result.trajectory_start = self._robot.state_message(start)
            result.planned_trajectory = trajectory_message(names, trajectory, self._robot.frame)
            result.planning_time = perf_counter() - started
            if not planning_options.plan_only:
                publish_state("MONITOR")
                await self._execute(result.planned_trajectory, goal)
                result.executed_trajectory = result.planned_trajectory
            publish_state("IDLE")
        except RequestError as error:
            self._end_failed(goal, result, error)
            return result
        result.error_code.val = self._error_codes.SUCCESS
        goal.succeed()
        return result

    async def _execute_trajectory(self, goal: Any) -> Any:
        result = get_action("moveit_msgs/action/ExecuteTrajectory").Result()
        try:
            await self._execute(goal.request.trajectory, goal)
        except RequestError as error:
            self._end_failed(goal, result, error)
            return result
        result.error_code.val = self._error_codes.SUCCESS
        goal.succeed()
        return result

    async def _execute(self, trajectory: Any, goal: Any) -> None:
        if not self._parameters.get("allow_trajectory_execution", True):
            raise RequestError(
                "CONTROL_FAILED", "Cannot execute trajectory since ~allow_trajectory_execution was set to false"
            )
        check_start(trajectory.joint_trajectory, self._robot, self._parameters)
        await self._execution.execute(trajectory, lambda: bool(goal.is_cancel_requested))

    def _end_failed(self, goal: Any, result: Any, error: RequestError) -> None:
        """Log an error, set its code in the result, and end the goal as canceled or aborted."""
        self._node.get_logger().error(str(error))
        result.error_code.val = getattr(self._error_codes, error.code)
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()

    def _on_event(self, message: Any) -> None:
        if message.data == "stop":
            self._execution.stop()
