"""The requests to move_group: its services and actions, ours or those of MoveIt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from linkwright.geometry.single import Transform
from linkwright.graph import ActionClient, Client, Node
from linkwright.graph.time.values import Duration
from linkwright.messages import get_action, get_message, get_service
from linkwright.nodes.service_waits import wait_for_future
from linkwright.page.protocol.motion_planning import PlanningPipeline, PlanningSettings

_RESPONSE_TIMEOUT_S = 2.0
"""Seconds to wait for the response of a service that computes in milliseconds."""

_IK_TIMEOUT_S = 0.05
_GOAL_TOLERANCE = 1e-4
"""The tolerance of goal positions in rad or m, as in MoveIt's MoveGroupInterface."""

_CARTESIAN_STEP_M = 0.01
_ROBOT_LINK = 0
"""The number of robot links among the body types of moveit_msgs/msg/ContactInformation."""

_SERVICES = {
    "compute_ik": "GetPositionIK",
    "check_state_validity": "GetStateValidity",
    "compute_cartesian_path": "GetCartesianPath",
    "query_planner_interface": "QueryPlannerInterfaces",
    "apply_planning_scene": "ApplyPlanningScene",
}
_ACTIONS = {"move_action": "MoveGroup", "execute_trajectory": "ExecuteTrajectory"}


@dataclass(frozen=True, slots=True)
class PlanResult:
    """The response to a request for a plan.

    Attributes:
        error: the name of the error code; empty if there is a plan.
        trajectory: a moveit_msgs/msg/RobotTrajectory.
        planning_time_s: the time that planning took, as move_group reports it; 0 if it does not.
        fraction: the share of a Cartesian path that was planned.
    """

    error: str
    trajectory: Any = None
    planning_time_s: float = 0.0
    fraction: float = 1.0


@dataclass(frozen=True, slots=True)
class MotionRequest:
    """A motion to plan.

    Attributes:
        group: the planning group.
        start: a moveit_msgs/msg/RobotState.
        goal: the positions of the group's joints in rad or m.
        frame: the frame of the workspace.
        workspace: the center and the size of the workspace, each as x, y, z in meters.
        settings: times, attempts and scaling.
        pipeline: the planning pipeline; empty for the default.
        planner: the planner; empty for the default.
    """

    group: str
    start: Any
    goal: Mapping[str, float]
    frame: str
    workspace: tuple[Sequence[float], Sequence[float]]
    settings: PlanningSettings
    pipeline: str = ""
    planner: str = ""


class MoveGroupClient:
    """The clients of move_group's services and actions.

    Args:
        node: the node that owns the clients.
        namespace: the namespace of move_group, which is empty or ends with a slash.
    """

    def __init__(self, node: Node, namespace: str) -> None:
        self._node = node
        self._services: dict[str, Client[Any, Any]] = {
            name: node.create_client(get_service(f"moveit_msgs/srv/{kind}"), f"/{namespace}{name}")
            for name, kind in _SERVICES.items()
        }
        self._actions = {
            name: ActionClient(node, get_action(f"moveit_msgs/action/{kind}"), f"/{namespace}{name}")
            for name, kind in _ACTIONS.items()
        }
        self._goal: Any = None
        self._is_stopped = False
        codes = get_message("moveit_msgs/msg/MoveItErrorCodes")
        self._error_names = {getattr(codes, name): name for name in dir(codes) if name.isupper()}

    @property
    def is_ready(self) -> bool:
        """Whether move_group answers requests."""
        return self._services["compute_ik"].service_is_ready() and self._actions["move_action"].server_is_ready()

    def close(self) -> None:
        """Cancel the current goal, and destroy the clients."""
        self.stop()
        with suppress(ValueError):  # the node may already have been destroyed
            for client in self._services.values():
                self._node.destroy_client(client)
            for action in self._actions.values():
                action.destroy()

    async def query_pipelines(self) -> list[PlanningPipeline]:
        """Return the planning pipelines with their planners."""
        response = await self._call("query_planner_interface")
        if response is None:
            return []
        return [
            PlanningPipeline(interface.pipeline_id, interface.name, list(interface.planner_ids))
            for interface in response.planner_interfaces
        ]

    async def solve_ik(
        self, group: str, link: str, pose: Transform, frame: str, seed: Any, *, avoids_collisions: bool
    ) -> Any:
        """Return the sensor_msgs/msg/JointState at which a link has a pose, or None if there is none.

        Args:
            group: the group that moves the link.
            link: the link.
            pose: the pose of the link in `frame`.
            frame: a frame that move_group knows.
            seed: the moveit_msgs/msg/RobotState from which the search starts.
            avoids_collisions: whether the result must not collide.
        """
        request = get_message("moveit_msgs/msg/PositionIKRequest")()
        request.group_name, request.ik_link_name, request.robot_state = group, link, seed
        request.avoid_collisions = avoids_collisions
        request.pose_stamped.header.frame_id = frame
        request.pose_stamped.pose = make_pose(pose)
        request.timeout = Duration(nanoseconds=round(_IK_TIMEOUT_S * 1e9)).to_msg()
        response = await self._call("compute_ik", ik_request=request)
        return response.solution.joint_state if response is not None and response.error_code.val == 1 else None

    async def find_colliding_links(self, group: str, state: Any) -> tuple[bool, set[str]]:
        """Return whether a moveit_msgs/msg/RobotState is valid, and the links that collide in it."""
        response = await self._call("check_state_validity", group_name=group, robot_state=state)
        if response is None:
            return True, set()
        links: set[str] = set()
        for contact in response.contacts:
            bodies = ((contact.body_type_1, contact.contact_body_1), (contact.body_type_2, contact.contact_body_2))
            links |= {body for kind, body in bodies if kind == _ROBOT_LINK}
        return bool(response.valid), links

    async def apply_scene(self, difference: Any) -> bool:
        """Apply a difference to the planning scene, and return whether move_group accepted all of it."""
        response = await self._call("apply_planning_scene", scene=difference)
        return response is not None and bool(response.success)

    async def plan(self, motion: MotionRequest) -> PlanResult:
        """Plan a motion without executing it."""
        goal = get_action("moveit_msgs/action/MoveGroup").Goal()
        goal.request = _make_plan_request(motion)
        goal.planning_options.plan_only = True
        goal.planning_options.planning_scene_diff.is_diff = True
        goal.planning_options.planning_scene_diff.robot_state.is_diff = True
        result = await self._run_action("move_action", goal)
        if result is None:
            return PlanResult("PREEMPTED" if self._is_stopped else "COMMUNICATION_FAILURE")
        error = self._name_error(result.error_code)
        return PlanResult(error, result.planned_trajectory, float(result.planning_time))

    async def plan_cartesian(
        self, motion: MotionRequest, link: str, pose: Transform, *, avoids_collisions: bool
    ) -> PlanResult:
        """Plan a straight motion of a link to a pose in the frame of the motion.

        The result has the part of the path before the first pose that cannot be reached.
        """
        settings = motion.settings
        request: dict[str, Any] = {
            "start_state": motion.start,
            "group_name": motion.group,
            "link_name": link,
            "waypoints": [make_pose(pose)],
            "max_step": _CARTESIAN_STEP_M,
            "avoid_collisions": avoids_collisions,
        }
        header = get_message("std_msgs/msg/Header")()
        header.frame_id = motion.frame
        response = await self._call(
            "compute_cartesian_path", timeout_s=settings.planning_time, header=header, **request
        )
        if response is None:
            return PlanResult("COMMUNICATION_FAILURE")
        scale = min(settings.velocity_scaling, settings.acceleration_scaling**0.5)
        _slow_down(response.solution.joint_trajectory, scale)
        return PlanResult(self._name_error(response.error_code), response.solution, 0.0, float(response.fraction))

    async def execute(self, trajectory: Any) -> str:
        """Execute a moveit_msgs/msg/RobotTrajectory, and return the name of the error code, or an empty string."""
        goal = get_action("moveit_msgs/action/ExecuteTrajectory").Goal(trajectory=trajectory)
        result = await self._run_action("execute_trajectory", goal)
        if result is None:
            return "PREEMPTED" if self._is_stopped else "COMMUNICATION_FAILURE"
        return self._name_error(result.error_code)

    def stop(self) -> None:
        """Cancel the goal that is being planned or executed."""
        self._is_stopped = True
        if self._goal is not None:
            self._goal.cancel_goal_async()

    async def _call(self, name: str, *, timeout_s: float = _RESPONSE_TIMEOUT_S, **fields: Any) -> Any:
        """Return the response of a service, or None if it is not available or does not answer in time."""
        client = self._services[name]
        if client.destroyed or not client.service_is_ready():
            return None
        future = client.call_async(client.srv_type.Request(**fields))
        is_done = await wait_for_future(self._node, future, timeout_s)
        return future.result() if is_done else None

    async def _run_action(self, name: str, goal: Any) -> Any:
        """Return the result of a goal, or None if the server is missing or rejects it."""
        client = self._actions[name]
        self._is_stopped = False
        if not client.server_is_ready():
            return None
        handle = await client.send_goal_async(goal)
        if handle is None or not handle.accepted:
            return None
        self._goal = handle
        try:
            if self._is_stopped:
                handle.cancel_goal_async()
            response = await handle.get_result_async()
        finally:
            self._goal = None
        return None if response is None else response.result

    def _name_error(self, code: Any) -> str:
        """Return the name of an error code, or an empty string for success."""
        return "" if code.val == 1 else self._error_names.get(code.val, str(code.val))


def make_pose(pose: Transform) -> Any:
    """Return a geometry_msgs/msg/Pose."""
    message = get_message("geometry_msgs/msg/Pose")()
    position, rotation = message.position, message.orientation
    position.x, position.y, position.z, rotation.x, rotation.y, rotation.z, rotation.w = map(float, pose)
    return message


def make_state(positions: Mapping[str, float]) -> Any:
    """Return a moveit_msgs/msg/RobotState that differs from the current state in some joints."""
    message = get_message("moveit_msgs/msg/RobotState")(is_diff=True)
    message.joint_state.name = list(positions)
    message.joint_state.position = list(positions.values())
    return message


def _make_plan_request(motion: MotionRequest) -> Any:
    settings = motion.settings
    request = get_message("moveit_msgs/msg/MotionPlanRequest")()
    request.group_name, request.start_state = motion.group, motion.start
    request.pipeline_id, request.planner_id = motion.pipeline, motion.planner
    request.num_planning_attempts, request.allowed_planning_time = settings.attempts, settings.planning_time
    request.max_velocity_scaling_factor = settings.velocity_scaling
    request.max_acceleration_scaling_factor = settings.acceleration_scaling
    workspace = request.workspace_parameters
    workspace.header.frame_id = motion.frame
    for axis, center, size in zip("xyz", *motion.workspace, strict=True):
        setattr(workspace.min_corner, axis, center - size / 2.0)
        setattr(workspace.max_corner, axis, center + size / 2.0)
    constraint_class = get_message("moveit_msgs/msg/JointConstraint")
    request.goal_constraints = [
        get_message("moveit_msgs/msg/Constraints")(
            joint_constraints=[
                constraint_class(
                    joint_name=name,
                    position=position,
                    tolerance_above=_GOAL_TOLERANCE,
                    tolerance_below=_GOAL_TOLERANCE,
                    weight=1.0,
                )
                for name, position in motion.goal.items()
            ]
        )
    ]
    return request


def get_duration_s(trajectory: Any) -> float:
    """Return the duration of a moveit_msgs/msg/RobotTrajectory in seconds."""
    points = trajectory.joint_trajectory.points
    return Duration.from_msg(points[-1].time_from_start).nanoseconds / 1e9 if points else 0.0


def _slow_down(trajectory: Any, scale: float) -> None:
    """Multiply the speed of a trajectory_msgs/msg/JointTrajectory by a factor up to 1."""
    for point in trajectory.points:
        nanoseconds = Duration.from_msg(point.time_from_start).nanoseconds
        point.time_from_start = Duration(nanoseconds=round(nanoseconds / scale)).to_msg()
        point.velocities = [velocity * scale for velocity in point.velocities]
        point.accelerations = [acceleration * scale**2 for acceleration in point.accelerations]
