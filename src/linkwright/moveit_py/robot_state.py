"""The state of a robot (``moveit.core.robot_state``)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose, rotate
from linkwright.messages import get_message
from linkwright.moveit_py.robot_model import JointModelGroup, RobotModel
from linkwright.planning.groups import joint_limits
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.nodes.conversions import joint_state_message, pose_message, pose_row
from linkwright.simulation.library import load_mujoco

_DEFAULT_IK_TIMEOUT_S = 0.05


class RobotState:
    """Positions, velocities, accelerations and efforts of a robot's joints.

    The positions start at 0, or at the nearest bound.

    Args:
        robot_model: the robot.
    """

    def __init__(self, robot_model: RobotModel) -> None:
        self.robot_model = robot_model
        count = len(robot_model.moved.joint_names)
        self.positions: Array = np.zeros(count)
        """The positions of the joints that have one of their own, in rad or m, shape (joints,)."""
        self._velocities, self._accelerations, self._efforts = (np.zeros(count) for _ in range(3))
        self.attached: list[Any] = []
        """The attached objects, as moveit_msgs/msg/AttachedCollisionObject."""
        self.set_to_default_values()

    def __copy__(self) -> RobotState:
        other = RobotState(self.robot_model)
        other.assign(self)
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> RobotState:
        return self.__copy__()

    def assign(self, other: RobotState) -> None:
        """Take the values of another state of the same robot."""
        self.positions, self.attached = other.positions.copy(), list(other.attached)
        self._velocities, self._accelerations = other._velocities.copy(), other._accelerations.copy()
        self._efforts = other._efforts.copy()

    # --- joints -----------------------------------------------------------------------------------------------------

    @property
    def joint_positions(self) -> dict[str, float]:
        """The positions of the joints in rad or m, by name; assign a dictionary to change those in it."""
        return self._to_dict(self.positions)

    @joint_positions.setter
    def joint_positions(self, values: Mapping[str, float]) -> None:
        self._update(self.positions, values)

    @property
    def joint_velocities(self) -> dict[str, float]:
        """The velocities of the joints in rad/s or m/s, by name."""
        return self._to_dict(self._velocities)

    @joint_velocities.setter
    def joint_velocities(self, values: Mapping[str, float]) -> None:
        self._update(self._velocities, values)

    @property
    def joint_accelerations(self) -> dict[str, float]:
        """The accelerations of the joints in rad/s2 or m/s2, by name."""
        return self._to_dict(self._accelerations)

    @joint_accelerations.setter
    def joint_accelerations(self, values: Mapping[str, float]) -> None:
        self._update(self._accelerations, values)

    @property
    def joint_efforts(self) -> dict[str, float]:
        """The efforts of the joints in Nm or N, by name."""
        return self._to_dict(self._efforts)

    @joint_efforts.setter
    def joint_efforts(self, values: Mapping[str, float]) -> None:
        self._update(self._efforts, values)

    def get_joint_group_positions(self, joint_model_group_name: str) -> Array:
        """Return the positions of a group's joints, shape (joints,)."""
        return np.array(self.positions[self._indexes(joint_model_group_name)])

    def set_joint_group_positions(self, joint_model_group_name: str, position_values: Sequence[float]) -> None:
        """Set the positions of a group's joints, shape (joints,)."""
        self._assign(self.positions, joint_model_group_name, position_values)

    def set_joint_group_active_positions(self, joint_model_group_name: str, position_values: Sequence[float]) -> None:
        """Set the positions of a group's joints, shape (joints,)."""
        self._assign(self.positions, joint_model_group_name, position_values)

    def get_joint_group_velocities(self, joint_model_group_name: str) -> Array:
        """Return the velocities of a group's joints, shape (joints,)."""
        return np.array(self._velocities[self._indexes(joint_model_group_name)])

    def set_joint_group_velocities(self, joint_model_group_name: str, velocity_values: Sequence[float]) -> None:
        """Set the velocities of a group's joints, shape (joints,)."""
        self._assign(self._velocities, joint_model_group_name, velocity_values)

    def get_joint_group_accelerations(self, joint_model_group_name: str) -> Array:
        """Return the accelerations of a group's joints, shape (joints,)."""
        return np.array(self._accelerations[self._indexes(joint_model_group_name)])

    def set_joint_group_accelerations(self, joint_model_group_name: str, acceleration_values: Sequence[float]) -> None:
        """Set the accelerations of a group's joints, shape (joints,)."""
        self._assign(self._accelerations, joint_model_group_name, acceleration_values)

    def set_to_default_values(
        self, joint_model_group: JointModelGroup | str | None = None, name: str = "", **names: str
    ) -> bool:
        """Set all joints to 0 or the nearest bound, or a group to a named state of the SRDF.

        Args:
            joint_model_group: the group, or its name; None for all joints.
            name: the name of the state.
            names: the group as ``joint_model_group_name``.

        Returns:
            Whether the state exists.
        """
        group = names.get("joint_model_group_name") or joint_model_group
        model = self.robot_model
        if group is None:
            for index, joint in enumerate(model.moved.joint_names):
                limits = joint_limits(model.robot.joints[joint])
                self.positions[index] = min(max(0.0, limits.lower), limits.upper)
            return True
        group_name = group if isinstance(group, str) else group.name
        state = model.semantics.states.get(group_name, {}).get(name)
        if state is None:
            return False
        self._update(self.positions, {key: value for key, value in state.items() if key in model.moved.joint_names})
        return True

    def set_to_random_positions(self, joint_model_group: JointModelGroup | None = None) -> None:
        """Set all joints, or those of a group, to random positions within their bounds."""
        random = np.random.default_rng()
        model = self.robot_model
        if joint_model_group is not None:
            group = model.group(joint_model_group.name)
            self.positions[model.indexes(group)] = group.sample(random)
            return
        for index, joint in enumerate(model.moved.joint_names):
            limits = joint_limits(model.robot.joints[joint])
            self.positions[index] = random.uniform(limits.lower, limits.upper)

    # --- frames -----------------------------------------------------------------------------------------------------

    @property
    def dirty(self) -> bool:
        """False: the frames of the links always belong to the positions."""
        return False

    def update(self, force: bool = False, type: str = "all") -> None:
        """Do nothing, because the frames of the links always belong to the positions."""

    def get_frame_transform(self, frame_id: str) -> Array:
        """Return the transform of a link in the frame of the root link, shape (4, 4)."""
        return matrix_from_pose(self.link_pose(frame_id))

    def get_global_link_transform(self, link_name: str) -> Array:
        """Return the transform of a link in the frame of the root link, shape (4, 4)."""
        return matrix_from_pose(self.link_pose(link_name))

    def get_pose(self, link_name: str) -> Any:
        """Return the pose of a link in the frame of the root link (geometry_msgs/msg/Pose)."""
        return pose_message(self.link_pose(link_name))

    def link_pose(self, link: str) -> Array:
        """Return the pose of a link in the frame of the root link, shape (7,).

        Raises:
            ValueError: the robot has no such link.
        """
        model = self.robot_model
        if link not in model.robot.links:
            raise ValueError(f"the robot has no link '{link}'")
        with model.lock:
            model.moved.move(self.positions)
            return model.moved.link_pose(link)

    def get_jacobian(
        self, joint_model_group_name: str, *arguments: Any, link_name: str = "", reference_point_position: Any = None
    ) -> Array:
        """Return the Jacobian of a point of a link, shape (6, joints).

        Args:
            joint_model_group_name: the group whose joints are the columns.
            arguments: the link, by default the last one of the group, and the point.
            link_name: the link, as a keyword.
            reference_point_position: the point in the frame of the link in m, shape (3,).
        """
        model = self.robot_model
        group = model.group(joint_model_group_name)
        for argument in arguments:
            if isinstance(argument, str):
                link_name = argument
            elif not isinstance(argument, bool):
                reference_point_position = argument
        link = link_name or group.links[-1]
        point = np.zeros(3) if reference_point_position is None else np.asarray(reference_point_position, dtype=float)
        pose = self.link_pose(link)
        mujoco, moved = load_mujoco(), model.moved
        jacobian = np.zeros((6, moved.mujoco_model.nv))
        with model.lock:
            moved.move(self.positions)
            mujoco.mj_comPos(moved.mujoco_model, moved.data)
            position = (pose[:3] + rotate(pose[3:], point)).reshape(3, 1)
            mujoco.mj_jac(moved.mujoco_model, moved.data, jacobian[:3], jacobian[3:], position, moved.body(link))
        return jacobian[:, moved.dof_indexes(group.joint_names)]

    def set_from_ik(self, joint_model_group_name: str, geometry_pose: Any, tip_name: str, timeout: float = 0.0) -> bool:
        """Move a group so that a link has a pose, and return whether a solution was found.

        Args:
            joint_model_group_name: the group.
            geometry_pose: the pose in the frame of the root link (geometry_msgs/msg/Pose).
            tip_name: the link.
            timeout: the time in s; 0 for the default.
        """
        model = self.robot_model
        if tip_name not in model.robot.links:
            raise ValueError(f"the robot has no link '{tip_name}'")
        with model.lock:
            solver = ChainSolver(model.moved, model.group(joint_model_group_name), tip_name)
            solution = solver.solve(pose_row(geometry_pose), self.positions, timeout or _DEFAULT_IK_TIMEOUT_S)
        if solution is not None:
            self.positions = solution
        return solution is not None

    def clear_attached_bodies(self) -> None:
        """Remove all attached objects from this state."""
        self.attached.clear()

    def _indexes(self, group: str) -> Array:
        return self.robot_model.indexes(self.robot_model.group(group))

    def _assign(self, target: Array, group: str, values: Sequence[float]) -> None:
        indexes = self._indexes(group)
        if len(values) != len(indexes):
            raise ValueError(f"group '{group}' has {len(indexes)} joints, but there are {len(values)} values")
        target[indexes] = values

    def _to_dict(self, values: Array) -> dict[str, float]:
        return dict(zip(self.robot_model.moved.joint_names, values.tolist(), strict=True))

    def _update(self, target: Array, values: Mapping[str, float]) -> None:
        names = self.robot_model.moved.joint_names
        for name, value in values.items():
            if name not in names:
                raise ValueError(f"the robot has no movable joint '{name}'")
            target[self.robot_model.moved.index(name)] = value


def robot_state_to_message(state: RobotState, copy_attached_bodies: bool = True) -> Any:
    """Return a moveit_msgs/msg/RobotState."""
    message = get_message("moveit_msgs/msg/RobotState")()
    model = state.robot_model
    with model.lock:
        model.moved.move(state.positions)
        message.joint_state = joint_state_message(*model.moved.all_positions(), model.robot.root)
    if copy_attached_bodies:
        message.attached_collision_objects = list(state.attached)
    return message
