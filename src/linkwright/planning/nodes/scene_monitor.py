"""The topics and services of move_group's planning scene."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from linkwright.geometry.arrays import Array
from linkwright.graph import Node, Publisher
from linkwright.messages import get_service
from linkwright.planning.cartesian import ArcPoint
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.goals import ContradictionError, Goal
from linkwright.planning.nodes.conversions import (
    FrameLookup,
    InvalidShapeError,
    RequestError,
    arc_point_from_constraints,
    goal_from_constraints,
)
from linkwright.planning.nodes.robot_context import RobotContext
from linkwright.planning.nodes.scene_state import SceneState
from linkwright.planning.planner import Method

_PERIOD_S = 0.5


class SceneMonitor:
    """The planning scene that topics and services change.

    Args:
        node: the node that subscribes and offers the services.
        robot: the robot in the scene.
        publishes_states: whether to publish the scene at regular times, and not only when objects change.
        topic: the topic on which the scene is published.

    Attributes:
        scene: the scene.
    """

    def __init__(
        self,
        node: Node,
        robot: RobotContext,
        *,
        publishes_states: bool,
        topic: str = "monitored_planning_scene",
    ) -> None:
        warn = node.get_logger().warning
        self.scene = SceneState(robot.frame, robot.allowed_collisions(), robot.robot.links, warn, robot.margins)
        self._robot = robot
        self._publisher: Publisher[Any] = node.create_publisher("moveit_msgs/msg/PlanningScene", topic, 10)
        for topic, kind, callback in (
            ("planning_scene", "PlanningScene", self._on_scene),
            ("collision_object", "CollisionObject", self._on_object),
            ("attached_collision_object", "AttachedCollisionObject", self._on_attached),
            ("planning_scene_world", "PlanningSceneWorld", self._on_world),
        ):
            node.create_subscription(f"moveit_msgs/msg/{kind}", topic, callback, 10)
        node.create_service(get_service("moveit_msgs/srv/GetPlanningScene"), "get_planning_scene", self._get_scene)
        node.create_service(
            get_service("moveit_msgs/srv/ApplyPlanningScene"), "apply_planning_scene", self._apply_scene
        )
        node.create_service(get_service("std_srvs/srv/Empty"), "clear_octomap", lambda _request, response: response)
        if publishes_states:
            node.create_timer(_PERIOD_S, self._publish)

    def frame_lookup(self, positions: Array, scene: SceneState | None = None) -> FrameLookup:
        """Return a function that finds the poses of links, objects and frames of tf.

        Args:
            positions: the positions of all joints.
            scene: the scene with the objects; by default the current one.
        """
        objects = scene or self.scene

        def find(frame: str) -> Array:
            pose = objects.object_pose(frame, partial(self._robot.frame_pose, positions=positions))
            return self._robot.frame_pose(frame, positions) if pose is None else pose

        return find

    def read_goal(self, constraints: Any, positions: Array, default_link: str | None) -> Goal:
        """Return the goal of a moveit_msgs/msg/Constraints.

        Args:
            constraints: the constraints.
            positions: the positions of all joints, for frames of links.
            default_link: the link of constraints that name none.

        Raises:
            RequestError: a frame, link or joint is not known, or a region is not valid.
        """
        try:
            goal = goal_from_constraints(constraints, self.frame_lookup(positions), default_link)
            goal = goal.follow_leaders(self._robot.model.relations)
        except InvalidShapeError as error:
            raise RequestError("INVALID_GOAL_CONSTRAINTS", f"a constraint region is not valid: {error}") from None
        except ContradictionError as error:
            raise RequestError("INVALID_GOAL_CONSTRAINTS", str(error)) from None
        joints = set(goal.joints).difference(self._robot.model.joint_names)
        links = {target.link for target in goal.links}.difference(self._robot.robot.links)
        if unknown := sorted(joints | links):
            raise RequestError("INVALID_GOAL_CONSTRAINTS", f"the robot has no '{unknown[0]}'")
        if name := goal.find_invalid_number():
            raise RequestError("INVALID_GOAL_CONSTRAINTS", f"a constraint of '{name}' has a number that is not finite")
        return goal

    def read_path_constraints(
        self, method: Method, constraints: Any, positions: Array, default_link: str | None
    ) -> tuple[Goal | None, ArcPoint | None]:
        """Return what a moveit_msgs/msg/Constraints asks of a path: what must hold along it, or the point of an arc.

        Args:
            method: the method of the plan; only that of arcs reads a point.
            constraints: the constraints.
            positions: the positions of all joints, for frames of links.
            default_link: the link of constraints that name none.

        Raises:
            RequestError: a frame, link or joint is not known, a region is not valid, or there is no point for an arc.
        """
        if method is Method.CARTESIAN_ARC:
            return None, arc_point_from_constraints(constraints, self.frame_lookup(positions))
        goal = self.read_goal(constraints, positions, default_link)
        return (goal if goal.joints or goal.links else None), None

    def scene_with(self, state: Any, positions: Array, scene: SceneState | None = None) -> SceneState:
        """Return the scene with the objects that a moveit_msgs/msg/RobotState attaches."""
        scene = scene or self.scene
        if not state.attached_collision_objects:
            return scene
        changed = scene.copy()
        for attached in state.attached_collision_objects:
            changed.apply_attached(attached, self.frame_lookup(positions))
        return changed

    def scene_with_difference(self, message: Any) -> SceneState:
        """Return a copy of the scene that a moveit_msgs/msg/PlanningScene changes as a difference."""
        message.is_diff = True
        changed = self.scene.copy()
        changed.apply(message, self.frame_lookup(self._robot.positions))
        return changed

    def compile(self, scene: SceneState | None) -> CollisionScene:
        """Return the robot among the objects of a scene, or alone and without shapes for None."""
        robot = self._robot
        if scene is None:
            return CollisionScene(robot.robot, {}, (), robot.allowed_collisions())
        return CollisionScene(robot.robot, robot.shapes, scene.scene_objects(), scene.allowed, scene.margins)

    def announce_change(self) -> None:
        """Publish the scene after a change of `scene`."""
        self._publish()

    def _get_scene(self, request: Any, response: Any) -> Any:
        state = self._robot.state_message(self._robot.positions)
        response.scene = self.scene.to_message(state, self._robot.robot.name, request.components.components)
        return response

    def _apply_scene(self, request: Any, response: Any) -> Any:
        response.success = self._change_scene(partial(self.scene.apply, request.scene))
        return response

    def _on_scene(self, message: Any) -> None:
        self._change_scene(partial(self.scene.apply, message))

    def _on_object(self, message: Any) -> None:
        self._change_scene(partial(self.scene.apply_object, message))

    def _on_attached(self, message: Any) -> None:
        self._change_scene(partial(self.scene.apply_attached, message))

    def _on_world(self, message: Any) -> None:
        for collision_object in message.collision_objects:
            self._on_object(collision_object)

    def _change_scene(self, change: Callable[[FrameLookup], bool]) -> bool:
        is_changed = change(self.frame_lookup(self._robot.positions))
        self.announce_change()
        return is_changed

    def _publish(self) -> None:
        if not self._publisher.get_subscription_count():
            return
        state = self._robot.state_message(self._robot.positions)
        self._publisher.publish(self.scene.to_message(state, self._robot.robot.name, 0))
