"""The robot of move_group: its description, groups and current state."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.descriptions.service import load
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import Array
from linkwright.graph import Node
from linkwright.graph.transforms.buffer import TransformBuffer
from linkwright.graph.transforms.errors import TransformException
from linkwright.graph.transforms.listener import TransformListener
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.messages import get_message
from linkwright.packages import current_finder
from linkwright.planning.collision_scene import AllowedCollisions, LinkMargin
from linkwright.planning.groups import resolve_groups
from linkwright.planning.known_names import leave_out_unknown_names
from linkwright.planning.nodes.conversions import (
    RequestError,
    UnknownFrameError,
    joint_state_message,
    update_positions,
)
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.semantics import read_semantics
from linkwright.planning.shapes import robot_shapes

_PLANNING = "robot_description_planning."


class RobotContext:
    """A robot with its groups, its shapes and its current state.

    Args:
        node: the node that receives the state of the robot.
        urdf: the text of the robot description.
        srdf: the text of the semantic description.
        parameters: the parameters of the node by name, among them those of MoveIt's ``joint_limits.yaml``.
        joint_topic: the topic of the joint states.

    Attributes:
        model: the robot, moved by whoever uses it on the event loop.
        shapes: the collision shapes of its links.
        groups: the groups of the SRDF by name.
        margins: the margins of links to objects of the world, by link name.
        frame: the planning frame.
        positions: the current positions of all joints, shape (joints,).
        has_state: whether a joint state was received.

    Raises:
        LinkwrightError: the URDF has errors, or the SRDF is not XML. Other errors of the SRDF are logged.
    """

    def __init__(
        self, node: Node, urdf: str, srdf: str, parameters: Mapping[str, Any], *, joint_topic: str = "joint_states"
    ) -> None:
        self.robot = load(urdf)
        self.semantics = leave_out_unknown_names(read_semantics(srdf), self.robot)
        for problem in self.semantics.problems:
            node.get_logger().error(problem.message)
        self.model = RobotModel(self.robot)
        limits = _read_joint_limits(parameters)
        self.groups = resolve_groups(self.robot, self.semantics, self.model.joint_names, limits)
        self.margins, problems = read_margins(parameters, self.robot.links)
        for text in problems:
            node.get_logger().error(text)
        self.shapes, mesh_errors = robot_shapes(self.robot, MeshLibrary(current_finder(), Path.cwd()))
        for error in mesh_errors:
            node.get_logger().warning(error.diagnostics[0].message)
        self.frame = self.robot.root
        self.positions: Array = np.zeros(len(self.model.joint_names))
        self.has_state = False
        self._lock = threading.RLock()
        self._extra_frames = {
            joint.parent_frame for joint in self.semantics.virtual_joints if joint.child_link == self.robot.root
        }
        self._transforms = TransformBuffer()
        TransformListener(self._transforms, node)
        node.create_subscription("sensor_msgs/msg/JointState", joint_topic, self._on_joint_state, 10)

    def allowed_collisions(self) -> AllowedCollisions:
        """Return the pairs of links that may collide by the SRDF."""
        pairs = {pair: True for pair in self.semantics.disabled_collisions if "" not in pair}
        defaults = {name: True for pair in self.semantics.disabled_collisions if "" in pair for name in pair if name}
        return AllowedCollisions(pairs, defaults)

    def frame_pose(self, frame: str, positions: Array) -> Array:
        """Return the pose of a frame in the frame of the root link, shape (7,).

        Args:
            frame: a link, a frame of tf, or empty for the planning frame.
            positions: the positions of all joints.

        Raises:
            UnknownFrameError: there is no such frame.
        """
        name = frame.removeprefix("/")
        if not name or name == self.frame or name in self._extra_frames:
            return np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        if name in self.robot.links:
            with self._lock:
                self.model.move(positions)
                return self.model.link_pose(name)
        try:
            return np.asarray(self._transforms.lookup(self.frame, name), dtype=np.float64)
        except TransformException:
            raise UnknownFrameError(name) from None

    def positions_of(self, state: Any) -> Array:
        """Return the positions of all joints in a moveit_msgs/msg/RobotState.

        Joints that it lacks keep their current positions.
        """
        return update_positions(self.model.joint_names, self.positions, state.joint_state)

    def read_link_speeds(self, request: Any, default_link: str | None) -> dict[str, float]:
        """Return the maximum speeds of links in m/s, by link.

        Args:
            request: a MotionPlanRequest, or a request of GetCartesianPath since Jazzy.
            default_link: the link of requests that name none.

        Raises:
            RequestError: the speed is not finite, or there is no such link.
        """
        speed = float(getattr(request, "max_cartesian_speed", 0.0))
        if not np.isfinite(speed):
            raise RequestError("INVALID_MOTION_PLAN", "max_cartesian_speed is not finite")
        if speed <= 0.0:
            return {}
        names = ("cartesian_speed_limited_link", "cartesian_speed_end_effector_link")  # since Jazzy, and in Humble
        link = next((name for field in names if (name := getattr(request, field, ""))), default_link)
        if link not in self.robot.links:
            raise RequestError("INVALID_LINK_NAME", f"there is no link '{link or ''}' whose speed could be limited")
        return {str(link): speed}

    def state_message(self, positions: Array) -> Any:
        """Return a moveit_msgs/msg/RobotState without attached objects."""
        message = get_message("moveit_msgs/msg/RobotState")()
        with self._lock:
            self.model.move(positions)
            message.joint_state = joint_state_message(*self.model.all_positions(), self.frame)
        return message

    def _on_joint_state(self, message: Any) -> None:
        self.positions = update_positions(self.model.joint_names, self.positions, message)
        self.has_state = True


def read_margins(parameters: Mapping[str, Any], links: Iterable[str]) -> tuple[dict[str, LinkMargin], list[str]]:
    """Return the margins of links in the parameters, and the errors of other ones.

    Args:
        parameters: the parameters of a node by name, such as ``robot_description_planning.default_robot_padding``.
        links: the links of the robot.
    """
    margins = {link: LinkMargin() for link in links}
    problems: list[str] = []
    for kind in ("padding", "scale"):
        of_all, of_links = f"{_PLANNING}default_robot_{kind}", f"{_PLANNING}default_robot_link_{kind}."
        settings = [(of_all, list(margins))] if of_all in parameters else []
        settings += [(key, [key[len(of_links) :]]) for key in parameters if key.startswith(of_links)]
        for key, names in settings:
            value = parameters[key]
            if unknown := [name for name in names if name not in margins]:
                problems.append(f"{key}: the robot has no link '{unknown[0]}'")
            elif not isinstance(value, (int, float)):
                problems.append(f"{key}: {value!r} is not a number")
            elif error := replace(LinkMargin(), **{kind: float(value)}).find_error():
                problems.append(f"{key}: {error}")
            else:
                margins.update((name, replace(margins[name], **{kind: float(value)})) for name in names)
    return margins, problems


def _read_joint_limits(parameters: Mapping[str, Any]) -> dict[str, dict[str, object]]:
    """Return the entries of MoveIt's ``joint_limits.yaml``, by joint name."""
    prefix = f"{_PLANNING}joint_limits."
    limits: dict[str, dict[str, object]] = {}
    for name, value in parameters.items():
        if name.startswith(prefix):
            joint, _, key = name[len(prefix) :].rpartition(".")
            limits.setdefault(joint, {})[key] = value
    return limits


def read_description(parameters: Mapping[str, Any], name: str, node: str) -> str:
    """Return the text of a description in a parameter.

    Args:
        parameters: the parameters of a node by name.
        name: the name of the parameter.
        node: the name of the node for the error.

    Raises:
        LinkwrightError: ARM104, the parameter is not set.
    """
    value = parameters.get(name)
    if not isinstance(value, str) or not value.strip():
        message = phrase("the parameter '{name}' of {node} is not set", name=name, node=node)
        hint = phrase("give it the text of the description, for example with MoveItConfigsBuilder")
        raise LinkwrightError(Diagnostic("ARM104", message, hint=hint))
    return value
