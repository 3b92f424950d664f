"""The services of move_group for kinematics and the validity of states."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, compose, invert
from linkwright.graph import Node
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.graph.time.values import Duration
from linkwright.messages import get_message, get_service
from linkwright.planning.cartesian import MAX_JOINT_STEP, follow_poses, line_poses
from linkwright.planning.collision_scene import CollisionScene, Contact
from linkwright.planning.groups import JointGroup
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.nodes.conversions import (
    RequestError,
    pose_message,
    pose_row,
    trajectory_message,
)
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.nodes.worker import PlanningWorker
from linkwright.planning.planner import MotionPlanner, PlanError, PlanRequest
from linkwright.planning.planner_process import MustStop
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.timing import Trajectory
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_CARTESIAN_INTERVAL_S = 0.05
"""The time between two points of a Cartesian path."""
_BODY_TYPES = {"link": 0, "world": 1, "attached": 2}


class KinematicsServices:
    """The services compute_fk, compute_ik, check_state_validity and compute_cartesian_path.

    All but compute_fk compute in another thread than the event loop and the planner, one request at a time.

    Args:
        node: the node that offers the services.
        robot: the robot.
        monitor: the planning scene.
        ik_timeout: returns the time in s for the inverse kinematics of a group.
        publish_path: called with the start, the group and the trajectory of each Cartesian path.
    """

    def __init__(
        self,
        node: Node,
        robot: RobotContext,
        monitor: SceneMonitor,
        ik_timeout: Callable[[str], float],
        publish_path: Callable[[Array, Iterable[tuple[JointGroup, Trajectory]]], None],
    ) -> None:
        self._node, self._robot, self._monitor, self._ik_timeout = node, robot, monitor, ik_timeout
        self._publish_path = publish_path
        self._error_codes = get_message("moveit_msgs/msg/MoveItErrorCodes")
        self._worker = PlanningWorker(robot, monitor, is_lockstep=node.graph.timebase.is_lockstep)
        node.create_service(get_service("moveit_msgs/srv/GetPositionFK"), "compute_fk", self._compute_fk)
        group = ReentrantCallbackGroup()  # The joint states of the node do not wait for these services.
        for name, kind, callback in (
            ("compute_ik", "GetPositionIK", self._compute_ik),
            ("check_state_validity", "GetStateValidity", self._check_validity),
            ("compute_cartesian_path", "GetCartesianPath", self._compute_cartesian_path),
        ):
            node.create_service(get_service(f"moveit_msgs/srv/{kind}"), name, callback, callback_group=group)

    def stop(self) -> None:
        """End the current computation and those that wait."""
        self._worker.stop()

    def _compute_fk(self, request: Any, response: Any) -> Any:
        positions = self._robot.positions_of(request.robot_state)
        stamped_class = get_message("geometry_msgs/msg/PoseStamped")
        links = list(request.fk_link_names) or [self._robot.frame]
        if unknown := [link for link in links if link not in self._robot.robot.links]:
            self._node.get_logger().error(f"There is no link '{unknown[0]}'")
            response.error_code.val = self._error_codes.INVALID_LINK_NAME
            return response
        try:
            to_frame = invert(self._robot.frame_pose(request.header.frame_id, positions))
        except RequestError as error:
            self._node.get_logger().error(str(error))
            response.error_code.val = getattr(self._error_codes, error.code)
            return response
        for link in links:
            stamped = stamped_class()
            stamped.header.frame_id = request.header.frame_id or self._robot.frame
            stamped.header.stamp = self._node.get_clock().now().to_msg()
            stamped.pose = pose_message(compose(to_frame, self._robot.frame_pose(link, positions)))
            response.pose_stamped.append(stamped)
            response.fk_link_names.append(link)
        response.error_code.val = self._error_codes.SUCCESS
        return response

    async def _compute_ik(self, request: Any, response: Any) -> Any:
        ik_request = request.ik_request
        try:
            solution = await self._solve_ik(ik_request)
        except RequestError as error:
            response.error_code.val = getattr(self._error_codes, error.code)
            return response
        response.solution = self._robot.state_message(solution)
        response.error_code.val = self._error_codes.SUCCESS
        return response

    async def _solve_ik(self, request: Any) -> Array:
        group = self._robot.groups.get(request.group_name)
        if group is None:
            raise RequestError("INVALID_GROUP_NAME", f"there is no group '{request.group_name}'")
        start = self._robot.positions_of(request.robot_state)
        stamped = request.pose_stamped_vector[0] if request.pose_stamped_vector else request.pose_stamped
        names = list(request.ik_link_names)
        tip = (names[0] if names else request.ik_link_name) or group.tip
        if tip is None or tip not in self._robot.robot.links:
            raise RequestError("INVALID_LINK_NAME", f"there is no link '{tip}'")
        target = compose(self._robot.frame_pose(stamped.header.frame_id, start), pose_row(stamped.pose))
        timeout = Duration.from_msg(request.timeout).nanoseconds / NANOSECONDS_PER_SECOND
        goal = self._monitor.read_goal(request.constraints, start, tip)
        timeout = timeout or self._ik_timeout(group.name)

        def solve(model: RobotModel, scene: CollisionScene, _must_stop: MustStop) -> Array | None:
            def is_valid(positions: Array) -> bool:
                return scene.is_free(positions) and goal.is_met(model, positions)

            return ChainSolver(model, group, tip).solve(target, start, timeout, is_valid)

        solution = await self._worker.run(self._scene_of(request, request.robot_state, start), solve)
        if solution is None:
            raise RequestError("NO_IK_SOLUTION", "no solution was found")
        return solution

    def _scene_of(self, request: Any, state: Any, positions: Array) -> SceneState | None:
        """Return the scene of a request that avoids collisions, or None."""
        if not request.avoid_collisions:
            return None
        return self._monitor.scene_with(state, positions)

    async def _check_validity(self, request: Any, response: Any) -> Any:
        positions = self._robot.positions_of(request.robot_state)
        scene_state = self._monitor.scene_with(request.robot_state, positions)
        try:
            contacts = await self._worker.run(scene_state, lambda _model, scene, _must_stop: scene.contacts(positions))
            response.contacts = [self._contact_message(contact, scene_state) for contact in contacts]
            goal = self._monitor.read_goal(request.constraints, positions, None)
        except RequestError as error:
            self._node.get_logger().error(str(error))
            return response
        group = self._robot.groups.get(request.group_name)
        is_bounded = group is None or group.satisfies_bounds(
            positions[[self._robot.model.index(name) for name in group.joint_names]]
        )
        response.valid = not contacts and is_bounded and goal.is_met(self._robot.model, positions)
        return response

    def _contact_message(self, contact: Contact, scene: SceneState) -> Any:
        message = get_message("moveit_msgs/msg/ContactInformation")()
        message.header.frame_id = self._robot.frame
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.position.x, message.position.y, message.position.z = map(float, contact.position)
        message.normal.x, message.normal.y, message.normal.z = map(float, contact.normal)
        message.depth = contact.depth
        message.contact_body_1, message.contact_body_2 = contact.first, contact.second
        message.body_type_1, message.body_type_2 = (
            _BODY_TYPES["world" if name in scene.objects else "attached" if name in scene.attached else "link"]
            for name in (contact.first, contact.second)
        )
        return message

    async def _compute_cartesian_path(self, request: Any, response: Any) -> Any:
        start = self._robot.positions_of(request.start_state)
        try:
            group, trajectory, response.fraction = await self._follow_waypoints(request, start)
        except RequestError as error:
            self._node.get_logger().error(str(error))
            response.error_code.val = getattr(self._error_codes, error.code)
            return response
        response.start_state = self._robot.state_message(start)
        response.solution = trajectory_message(group.joint_names, trajectory, self._robot.frame)
        response.error_code.val = self._error_codes.SUCCESS
        self._publish_path(start, [(group, trajectory)])
        return response

    async def _follow_waypoints(self, request: Any, start: Array) -> tuple[JointGroup, Trajectory, float]:
        """Return the group, its trajectory through the waypoints, and the covered fraction.

        Raises:
            RequestError: a name, a frame or the step is not valid, or the trajectory collides.
        """
        group = self._robot.groups.get(request.group_name)
        if group is None:
            raise RequestError("INVALID_GROUP_NAME", f"there is no group '{request.group_name}'")
        tip: str = request.link_name or group.tip or ""
        if tip not in self._robot.robot.links:
            raise RequestError("INVALID_LINK_NAME", f"there is no link '{tip}'")
        if not request.max_step > 0.0:
            raise RequestError("FAILURE", "max_step must be positive")
        constraint = self._monitor.read_goal(request.path_constraints, start, tip)
        poses = self._interpolate_waypoints(request, start, tip)
        max_joint_step = request.revolute_jump_threshold or MAX_JOINT_STEP
        plan_request = PlanRequest(
            group,
            start,
            (),
            velocity_scale=getattr(request, "max_velocity_scaling_factor", 0.0) or 1.0,
            acceleration_scale=getattr(request, "max_acceleration_scaling_factor", 0.0) or 1.0,
            interval_s=_CARTESIAN_INTERVAL_S,
            max_link_speeds=self._robot.read_link_speeds(request, tip),
        )

        def follow(model: RobotModel, scene: CollisionScene, must_stop: MustStop) -> tuple[Trajectory, float]:
            def is_valid(positions: Array) -> bool:
                return not must_stop() and scene.is_free(positions) and constraint.is_met(model, positions)

            indexes = np.array([model.index(name) for name in group.joint_names])
            solver = ChainSolver(model, group, tip)
            path, fraction = follow_poses(solver, start, poses, indexes, is_valid, max_joint_step)
            planner = MotionPlanner(model, scene, must_stop)
            return planner.time_path(plan_request, start, path[:, indexes]), fraction

        try:
            return group, *await self._worker.run(self._scene_of(request, request.start_state, start), follow)
        except PlanError as error:
            raise RequestError("INVALID_MOTION_PLAN", f"the path collides between two poses: {error}") from None

    def _interpolate_waypoints(self, request: Any, start: Array, tip: str) -> Array:
        """Return poses of the tip on the lines between the waypoints of a request, shape (n, 7)."""
        frame = self._robot.frame_pose(request.header.frame_id, start)
        pose = self._robot.frame_pose(tip, start)
        lines: list[Array] = [np.empty((0, 7))]
        for waypoint in request.waypoints:
            target = compose(frame, pose_row(waypoint))
            lines.append(line_poses(pose, target, request.max_step))
            pose = target
        return np.concatenate(lines)
