"""The service and the action of move_group that plan sequences of motions.

They have the interfaces, error codes and texts of the capabilities of Pilz' industrial motion planner.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from functools import partial
from itertools import pairwise
from time import perf_counter
from typing import Any

from linkwright.graph import ActionServer, Node
from linkwright.graph.actions.goal import CancelResponse
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_action, get_message, get_service
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.nodes.conversions import RequestError, trajectory_message, update_positions
from linkwright.planning.nodes.planning_services import PlanningServices
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.nodes.worker import never
from linkwright.planning.planner import MotionPlanner, Plan, PlanError, PlanRequest
from linkwright.planning.planner_process import MustStop
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.sequences import Command, SequenceMotion, check_radii, join_commands

_EMPTY = "Received empty request. That's ok but maybe not what you intended."


class SequenceServices:
    """The service ``plan_sequence_path`` and the action ``sequence_move_group``.

    Args:
        node: the node that offers them.
        robot: the robot.
        monitor: the planning scene.
        planning: the planning of single motions.
        execute: executes a moveit_msgs/msg/RobotTrajectory for a goal; it raises RequestError.
        may_execute: whether trajectories are executed at all.
    """

    def __init__(
        self,
        node: Node,
        robot: RobotContext,
        monitor: SceneMonitor,
        planning: PlanningServices,
        execute: Callable[[Any, Any], Awaitable[None]],
        may_execute: bool,
    ) -> None:
        self._node, self._robot, self._monitor, self._planning = node, robot, monitor, planning
        self._execute, self._may_execute = execute, may_execute
        self._error_codes = get_message("moveit_msgs/msg/MoveItErrorCodes")
        group = ReentrantCallbackGroup()
        service = get_service("moveit_msgs/srv/GetMotionSequence")
        node.create_service(service, "plan_sequence_path", self._plan_path, callback_group=group)
        self._action = get_action("moveit_msgs/action/MoveGroupSequence")
        ActionServer(
            node,
            self._action,
            "sequence_move_group",
            self._move,
            callback_group=group,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )

    async def _plan_path(self, request: Any, response: Any) -> Any:
        try:
            await self._plan_into(response.response, request.request, self._monitor.scene)
        except RequestError as error:
            self._report(response.response, error)
        return response

    async def _move(self, goal: Any) -> Any:
        result, options = self._action.Result(), goal.request.planning_options
        self._publish_state(goal, "PLANNING")
        try:
            scene = self._monitor.scene_with_difference(options.planning_scene_diff)
            await self._plan_into(result.response, goal.request.request, scene, lambda: bool(goal.is_cancel_requested))
            if not options.plan_only and not self._may_execute:
                self._node.get_logger().warning("Only plan will be calculated, although plan_only == false.")
            elif not options.plan_only:
                self._publish_state(goal, "MONITOR")
                for trajectory in result.response.planned_trajectories:
                    await self._execute(trajectory, goal)
            self._publish_state(goal, "IDLE")
        except RequestError as error:
            self._report(result.response, error)
            if goal.is_cancel_requested:
                goal.canceled()
            else:
                goal.abort()
            return result
        goal.succeed()
        return result

    def _publish_state(self, goal: Any, state: str) -> None:
        feedback = self._action.Feedback()
        feedback.state = state
        goal.publish_feedback(feedback)

    def _report(self, response: Any, error: RequestError) -> None:
        self._node.get_logger().error(str(error))
        response.error_code.val = getattr(self._error_codes, error.code)

    async def _plan_into(self, response: Any, request: Any, scene: SceneState, is_canceled: MustStop = never) -> None:
        """Plan a moveit_msgs/msg/MotionSequenceRequest, and write the result into a MotionSequenceResponse.

        Raises:
            RequestError: there is no plan, or the planning was canceled.
        """
        started = perf_counter()
        response.error_code.val = self._error_codes.SUCCESS
        if not request.items:
            self._node.get_logger().warning(_EMPTY)
            return
        motions = await self._plan(request.items, scene, is_canceled)
        response.sequence_start = self._robot.state_message(motions[0].start)
        response.planned_trajectories = [
            trajectory_message(motion.group.joint_names, motion.trajectory, self._robot.frame) for motion in motions
        ]
        response.planning_time = perf_counter() - started
        self._planning.publish_path(motions[0].start, [(motion.group, motion.trajectory) for motion in motions])

    async def _plan(self, items: Any, scene: SceneState, is_canceled: MustStop) -> list[SequenceMotion]:
        radii = self._read_radii(items)
        _check_start_states(items)
        positions, commands = self._robot.positions, []
        for number, (item, radius) in enumerate(zip(items, radii, strict=True)):
            item.req.pipeline_id = item.req.pipeline_id or items[0].req.pipeline_id
            try:
                request, scene = self._planning.prepare(item.req, scene, positions)
                plan = await self._planning.run(scene, partial(_plan_path, request), is_canceled)
            except RequestError as error:
                raise RequestError(error.code, f"Could not solve command [{number}] of the sequence: {error}") from None
            commands.append(Command(request, plan, radius))
            end = get_message("sensor_msgs/msg/JointState")()
            end.name, end.position = list(request.group.joint_names), plan.path[-1].tolist()
            positions = update_positions(self._robot.model.joint_names, plan.start, end)
        return await self._planning.run(scene, partial(_join, commands), is_canceled)

    def _read_radii(self, items: Any) -> list[float]:
        """Return the blend radii of a sequence; a motion that cannot be blended stops at its goal, with a warning."""
        radii = [float(item.blend_radius) for item in items]
        try:
            check_radii(radii)
        except PlanError as error:
            raise RequestError(error.failure.name, str(error)) from None
        for number, (first, second) in enumerate(pairwise(items)):
            if radii[number] and (reason := self._why_not_blended(first.req, second.req)):
                self._node.get_logger().warning(
                    f"{reason}. Invalid blend radii between commands: [{number}] and [{number + 1}] => Blend radii set "
                    "to zero"
                )
                radii[number] = 0.0
        return radii

    def _why_not_blended(self, first: Any, second: Any) -> str:
        if first.group_name != second.group_name:
            return (
                f'Blending between different groups (in this case: "{first.group_name}" and "{second.group_name}") not '
                "allowed"
            )
        group = self._robot.groups.get(first.group_name)
        if group is not None and group.tip is None:
            return "Blending for groups without solver not allowed"
        for request in (first, second):
            constraints = request.path_constraints
            if request.planner_id != "CIRC" and any(
                (constraints.joint_constraints, constraints.position_constraints, constraints.orientation_constraints)
            ):
                return "Blending of motions with path constraints not allowed"
        return ""


def _plan_path(request: PlanRequest, model: RobotModel, scene: CollisionScene, must_stop: MustStop) -> Plan:
    return MotionPlanner(model, scene, must_stop).plan_path(request)


def _join(
    commands: Sequence[Command], model: RobotModel, scene: CollisionScene, must_stop: MustStop
) -> list[SequenceMotion]:
    return join_commands(MotionPlanner(model, scene, must_stop), model, commands)


def _check_start_states(items: Any) -> None:
    """Raise RequestError if a motion that is not the first of its group has a start state."""
    groups: set[str] = set()
    for item in items:
        state, name = item.req.start_state.joint_state, item.req.group_name
        if name in groups and (len(state.name) or len(state.position) or len(state.velocity) or len(state.effort)):
            raise RequestError(
                "INVALID_ROBOT_STATE",
                f'Only the first request is allowed to have a start state, but the requests for group: "{name}" '
                "violate the rule",
            )
        groups.add(name)
