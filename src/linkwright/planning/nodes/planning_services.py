"""The services of move_group that plan motions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError, render
from linkwright.geometry.arrays import Array
from linkwright.graph import Node, Publisher
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_message, get_service
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.groups import JointGroup
from linkwright.planning.nodes.conversions import RequestError, trajectory_message, update_positions
from linkwright.planning.nodes.pipelines import Pipelines
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.nodes.worker import PlanningWorker, never
from linkwright.planning.planner import MotionPlanner, PlanError, PlanRequest
from linkwright.planning.planner_process import MustStop, Result, Work
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.timing import Trajectory

_DEFAULT_PLANNING_TIME_S = 5.0


class PlanningServices:
    """The services that plan motions and list planners, and the planning of actions.

    One motion is planned at a time, in another process.

    Args:
        node: the node that offers the services.
        robot: the robot.
        monitor: the planning scene.
        pipelines: the planning pipelines.
        default_scale: returns the share of the limits of "velocity" or "acceleration" for requests that set none.
    """

    def __init__(
        self,
        node: Node,
        robot: RobotContext,
        monitor: SceneMonitor,
        pipelines: Pipelines,
        default_scale: Callable[[str], float],
    ) -> None:
        self._node, self._robot, self._monitor, self._pipelines = node, robot, monitor, pipelines
        self._default_scale = default_scale
        self._worker = PlanningWorker(robot, monitor, is_lockstep=node.graph.timebase.is_lockstep, has_process=True)
        self._error_codes = get_message("moveit_msgs/msg/MoveItErrorCodes")
        self._path_publisher: Publisher[Any] = node.create_publisher(
            "moveit_msgs/msg/DisplayTrajectory", "display_planned_path", 10
        )
        group = ReentrantCallbackGroup()
        for name, kind, callback in (
            ("plan_kinematic_path", "GetMotionPlan", self._plan_path),
            ("query_planner_interface", "QueryPlannerInterfaces", self._query_planners),
        ):
            node.create_service(get_service(f"moveit_msgs/srv/{kind}"), name, callback, callback_group=group)

    def stop(self) -> None:
        """Cancel the current plan and those that wait."""
        self._worker.stop()

    async def _plan_path(self, request: Any, response: Any) -> Any:
        motion_request = request.motion_plan_request
        result = response.motion_plan_response
        result.group_name = motion_request.group_name
        started = perf_counter()
        try:
            start, trajectory, names = await self.plan(motion_request, self._monitor.scene)
        except RequestError as error:
            self._node.get_logger().error(str(error))
            result.error_code.val = getattr(self._error_codes, error.code)
            return response
        result.trajectory_start = self._robot.state_message(start)
        result.trajectory = trajectory_message(names, trajectory, self._robot.frame)
        result.planning_time = perf_counter() - started
        result.error_code.val = self._error_codes.SUCCESS
        return response

    async def plan(
        self, request: Any, scene: SceneState, is_canceled: MustStop = never
    ) -> tuple[Array, Trajectory, tuple[str, ...]]:
        """Plan a motion, and return the start, the trajectory and the names of its joints.

        Args:
            request: a moveit_msgs/msg/MotionPlanRequest.
            scene: the scene.
            is_canceled: returns whether the planning must stop; it is called in another thread.

        Raises:
            RequestError: there is no plan, or the planning was canceled.
        """
        plan_request, scene = self.prepare(request, scene, self._robot.positions)
        trajectory = await self.run(scene, partial(_plan, plan_request), is_canceled)
        self.publish_path(plan_request.start, [(plan_request.group, trajectory)])
        return plan_request.start, trajectory, plan_request.group.joint_names

    def prepare(self, request: Any, scene: SceneState, positions: Array) -> tuple[PlanRequest, SceneState]:
        """Return the request of a moveit_msgs/msg/MotionPlanRequest, and the scene with the objects of its start.

        Args:
            request: the message.
            scene: the scene.
            positions: the positions of all joints that the start state leaves out.

        Raises:
            RequestError: the message is not valid.
        """
        group = self._robot.groups.get(request.group_name)
        if group is None:
            raise RequestError("INVALID_GROUP_NAME", f"there is no group '{request.group_name}'")
        if not request.goal_constraints:
            raise RequestError("INVALID_GOAL_CONSTRAINTS", "no goal constraints are specified")
        names = self._robot.model.joint_names
        start = update_positions(names, positions, request.start_state.joint_state)
        if not np.all(np.isfinite(start)):
            joint = names[int(np.argmin(np.isfinite(start)))]
            raise RequestError("INVALID_ROBOT_STATE", f"the position of joint '{joint}' at the start is not finite")
        scene = self._monitor.scene_with(request.start_state, start, scene)
        return self._make_request(request, group, start), scene

    async def run(self, scene: SceneState, work: Work[Result], is_canceled: MustStop = never) -> Result:
        """Return what a function computes in another process, after other plans.

        Args:
            scene: the scene.
            work: the function of a module, or a `functools.partial` of one.
            is_canceled: returns whether the planning must stop; it is called in another thread.

        Raises:
            RequestError: there is no plan, or the planning was canceled.
        """
        try:
            return await self._worker.run(scene, work, is_canceled)
        except PlanError as error:
            raise RequestError(error.failure.name, self._explain(error)) from None
        except LinkwrightError as error:  # OMPL is not installed.
            raise RequestError("FAILURE", render(error.diagnostics[0])) from None

    def _make_request(self, request: Any, group: JointGroup, start: Array) -> PlanRequest:
        """Return the request of a moveit_msgs/msg/MotionPlanRequest.

        Raises:
            RequestError: a pipeline, a name, a frame or a shape is not valid.
        """
        choice = self._pipelines.choose(request.pipeline_id, request.planner_id, group.name)
        if choice.notice:
            self._node.get_logger().warning(choice.notice)
        goals = [self._monitor.read_goal(item, start, group.tip) for item in request.goal_constraints]
        path_constraint, arc = self._monitor.read_path_constraints(
            choice.method, request.path_constraints, start, group.tip
        )
        return PlanRequest(
            group,
            start,
            goals,
            path_constraint,
            choice.method,
            choice.planner,
            choice.parameters,
            request.allowed_planning_time or _DEFAULT_PLANNING_TIME_S,
            request.max_velocity_scaling_factor or self._default_scale("velocity"),
            request.max_acceleration_scaling_factor or self._default_scale("acceleration"),
            arc=arc,
            max_link_speeds=self._robot.read_link_speeds(request, group.tip),
        )

    @staticmethod
    def _explain(error: PlanError) -> str:
        pairs = sorted({f"'{contact.first}' and '{contact.second}'" for contact in error.contacts})
        return f"{error}: {', '.join(pairs)} collide" if pairs else str(error)

    def _query_planners(self, _request: Any, response: Any) -> Any:
        description_class = get_message("moveit_msgs/msg/PlannerInterfaceDescription")
        for pipeline in self._pipelines.names:
            description = description_class()
            description.name, description.pipeline_id = self._pipelines.title(pipeline), pipeline
            description.planner_ids = self._pipelines.planner_ids(pipeline)
            response.planner_interfaces.append(description)
        return response

    def publish_path(self, start: Array, motions: Iterable[tuple[JointGroup, Trajectory]]) -> None:
        """Publish planned motions for the display.

        Args:
            start: the positions of all joints at the start.
            motions: the groups with their trajectories, one after the other.
        """
        message = get_message("moveit_msgs/msg/DisplayTrajectory")()
        message.model_id = self._robot.robot.name
        message.trajectory_start = self._robot.state_message(start)
        message.trajectory = [
            trajectory_message(group.joint_names, trajectory, self._robot.frame) for group, trajectory in motions
        ]
        self._path_publisher.publish(message)


def _plan(request: PlanRequest, model: RobotModel, scene: CollisionScene, must_stop: MustStop) -> Trajectory:
    return MotionPlanner(model, scene, must_stop).plan(request)
