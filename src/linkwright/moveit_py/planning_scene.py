"""The planning scene: a robot among objects (``moveit.core.planning_scene``)."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy, deepcopy
from typing import Any

from linkwright.geometry.arrays import Array, matrix_from_pose
from linkwright.moveit_py.robot_model import RobotModel
from linkwright.moveit_py.robot_state import RobotState, robot_state_to_message
from linkwright.moveit_py.robot_trajectory import RobotTrajectory
from linkwright.planning.collision_scene import AllowedCollisions, Contact
from linkwright.planning.nodes.conversions import RequestError
from linkwright.planning.nodes.scene_monitor import SceneMonitor
from linkwright.planning.nodes.scene_state import SceneState


class AllowedCollisionMatrix:
    """Which pairs of links and objects may collide.

    Args:
        allowed: the pairs, which `set_entry` changes.
    """

    def __init__(self, allowed: AllowedCollisions) -> None:
        self._allowed = allowed

    def get_entry(self, name1: str, name2: str) -> tuple[bool, str]:
        """Return whether a pair is listed or has a default, and ``ALWAYS`` or ``NEVER`` for its collisions."""
        is_listed = frozenset((name1, name2)) in self._allowed.pairs or bool(
            {name1, name2}.intersection(self._allowed.defaults)
        )
        return is_listed, "ALWAYS" if self._allowed.allows(name1, name2) else "NEVER"

    def set_entry(self, name1: str, name2: str, allowed: bool) -> None:
        """Set whether two links or objects may collide."""
        self._allowed.pairs[frozenset((name1, name2))] = allowed

    def remove_entry(self, name1: str, name2: str) -> None:
        """Remove a pair."""
        self._allowed.pairs.pop(frozenset((name1, name2)), None)

    def clear(self) -> None:
        """Remove all pairs."""
        self._allowed.pairs.clear()
        self._allowed.defaults.clear()


class PlanningScene:
    """A robot among objects.

    A program gets it from `PlanningSceneMonitor.read_only` or `PlanningSceneMonitor.read_write`.

    Args:
        robot_model: the robot.
        monitor: the monitor that compiles scenes and knows the frames.
        scene: the objects.
        current_state: the state of the robot.
        warn: receives why a request of `verbose` methods failed.
    """

    def __init__(
        self,
        robot_model: RobotModel,
        monitor: SceneMonitor,
        scene: SceneState,
        current_state: RobotState,
        warn: Callable[[str], object],
    ) -> None:
        self.robot_model = robot_model
        self._monitor, self._warn = monitor, warn
        self.scene = scene
        self.current_state = current_state

    def __copy__(self) -> PlanningScene:
        return PlanningScene(self.robot_model, self._monitor, self.scene.copy(), copy(self.current_state), self._warn)

    def __deepcopy__(self, memo: dict[int, Any]) -> PlanningScene:
        return self.__copy__()

    @property
    def name(self) -> str:
        """The name of the scene."""
        return self.scene.name

    @name.setter
    def name(self, value: str) -> None:
        self.scene.name = value

    @property
    def planning_frame(self) -> str:
        """The frame of the objects, which is the frame of the robot's root link."""
        return self.scene.frame

    @property
    def planning_scene_message(self) -> Any:
        """The scene as moveit_msgs/msg/PlanningScene."""
        return self.scene.to_message(robot_state_to_message(self.current_state), self.robot_model.name, 0)

    @property
    def allowed_collision_matrix(self) -> AllowedCollisionMatrix:
        """The pairs that may collide."""
        return AllowedCollisionMatrix(self.scene.allowed)

    # --- objects ----------------------------------------------------------------------------------------------------

    def apply_collision_object(self, collision_object_msg: Any, color_msg: Any = None) -> bool:
        """Apply a moveit_msgs/msg/CollisionObject, and return whether that was possible."""
        if color_msg is not None:
            self.scene.set_color(color_msg)
        return self.scene.apply_object(deepcopy(collision_object_msg), self._lookup())

    def process_attached_collision_object(self, object: Any) -> bool:
        """Apply a moveit_msgs/msg/AttachedCollisionObject, and return whether that was possible."""
        return self.scene.apply_attached(object, self._lookup())

    def process_planning_scene_world(self, msg: Any) -> bool:
        """Apply the objects of a moveit_msgs/msg/PlanningSceneWorld, and return whether that was possible."""
        results = [self.apply_collision_object(item) for item in msg.collision_objects]
        return all(results)

    def remove_all_collision_objects(self) -> None:
        """Remove all objects from the world; attached objects stay."""
        self.scene.objects.clear()

    def set_current_state(self, robot_state: RobotState) -> None:
        """Set the state of the robot in this scene."""
        self.current_state.assign(robot_state)

    # --- frames -----------------------------------------------------------------------------------------------------

    def knows_frame_transform(self, *arguments: Any, frame_id: str = "", robot_state: RobotState | None = None) -> bool:
        """Return whether a link, an object or a frame of tf has a name; a state may precede the name."""
        name = frame_id or arguments[-1]
        try:
            self._lookup()(name)
        except RequestError:
            return False
        return True

    def get_frame_transform(self, frame_id: str) -> Array:
        """Return the transform of a link or object in the planning frame, shape (4, 4).

        Raises:
            RequestError: there is no such frame.
        """
        return matrix_from_pose(self._lookup()(frame_id))

    # --- collisions -------------------------------------------------------------------------------------------------

    def is_state_colliding(
        self,
        robot_state: RobotState | str | None = None,
        joint_model_group_name: str = "",
        verbose: bool = False,
    ) -> bool:
        """Return whether the robot collides with itself or with an object.

        Args:
            robot_state: the state; by default the current one. The name of a group may take its place.
            joint_model_group_name: the group whose links must take part in a collision; all links if empty.
            verbose: whether to log the pairs that collide.
        """
        if isinstance(robot_state, str):
            return self.is_state_colliding(None, robot_state, verbose)
        contacts = self._contacts(robot_state or self.current_state, joint_model_group_name)
        if verbose:
            for first, second in sorted({(contact.first, contact.second) for contact in contacts}):
                self._warn(f"'{first}' and '{second}' collide")
        return bool(contacts)

    def is_state_constrained(self, state: RobotState, constraints: Any, verbose: bool = False) -> bool:
        """Return whether a state meets a moveit_msgs/msg/Constraints.

        Raises:
            RequestError: a frame, link or joint is not known.
        """
        goal = self._monitor.read_goal(constraints, state.positions, None)
        with self.robot_model.lock:
            return goal.is_met(self.robot_model.moved, state.positions)

    def is_state_valid(self, robot_state: RobotState, joint_model_group_name: str = "", verbose: bool = False) -> bool:
        """Return whether nothing collides in a state. See `is_state_colliding`."""
        return not self.is_state_colliding(robot_state, joint_model_group_name, verbose)

    def is_path_valid(
        self, trajectory: RobotTrajectory, joint_model_group_name: str = "", verbose: bool = False
    ) -> bool:
        """Return whether nothing collides in any state of a trajectory."""
        states = (trajectory[index] for index in range(len(trajectory)))
        return all(self.is_state_valid(state, joint_model_group_name, verbose) for state in states)

    def _contacts(self, state: RobotState, group: str) -> list[Contact]:
        compiled = self._monitor.compile(self._with_attached(state))
        contacts = compiled.contacts(state.positions)
        if not group:
            return contacts
        links = self._moved_links(self.robot_model.group(group).links)
        attached = {name for name, item in self.scene.attached.items() if item.link_name in links}
        return [item for item in contacts if {item.first, item.second}.intersection(links | attached)]

    def _moved_links(self, links: tuple[str, ...]) -> set[str]:
        """Return links and the links that move with them."""
        moved, joints = set(links), self.robot_model.robot.joints.values()
        while added := {joint.child for joint in joints if joint.parent in moved} - moved:
            moved |= added
        return moved

    def _with_attached(self, state: RobotState) -> SceneState:
        message = robot_state_to_message(state)
        return self._monitor.scene_with(message, state.positions, self.scene)

    def _lookup(self) -> Callable[[str], Array]:
        return self._monitor.frame_lookup(self.current_state.positions, self.scene)
