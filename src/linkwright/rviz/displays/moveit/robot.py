"""Draws a robot as markers in a state from a message, without transforms from tf."""

from __future__ import annotations

import math
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import quaternion_from_matrix
from linkwright.geometry.single import IDENTITY, Transform, compose
from linkwright.kinematics import KinematicTree
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.markers import MarkerKind, MarkerMesh, MarkerShape
from linkwright.page.protocol.robot import LinkScene, Shape
from linkwright.rviz.displays.moveit.solids import Color
from linkwright.rviz.markers.shapes import make_marker, pose_to_values
from linkwright.rviz.robot import SceneBuilder
from linkwright.urdf import Robot, parent_joints

_DEFAULT_COLOR: Color = (1.0, 0.0, 0.0, 1.0)
"""The color of shapes for which the description has no color, as in RViz."""


@dataclass(slots=True)
class JointPositions:
    """The positions of a robot's joints, and the pose of its root.

    Attributes:
        values: joint positions in rad or m, by joint name.
        root_in_frame: the pose of the robot's root link in `frame`.
        frame: the frame of `root_in_frame`; empty for the frame of the root link.
    """

    values: dict[str, float] = field(default_factory=dict)
    root_in_frame: Transform = IDENTITY
    frame: str = ""

    def copy(self) -> JointPositions:
        """Return a copy that can be changed."""
        return JointPositions(dict(self.values), self.root_in_frame, self.frame)


@dataclass(frozen=True, slots=True)
class Appearance:
    """The appearance of a robot: colors, opacity, and the links and shapes to draw.

    Attributes:
        namespace: the markers' namespace.
        visual: whether to draw the visual geometry.
        collision: whether to draw the collision geometry.
        alpha: the opacity of all links.
        alphas: the opacity of individual links, which is multiplied by `alpha`; links with 0 are not drawn.
        color: the RGB color of all links; None to use the colors in the description.
        links: the colors of individual links, which take precedence over `color`.
        only: the names of the links that are drawn; None to draw all of them.
    """

    namespace: str
    visual: bool = True
    collision: bool = False
    alpha: float = 1.0
    alphas: Mapping[str, float] = field(default_factory=dict)
    color: tuple[float, float, float] | None = None
    links: Mapping[str, Color] = field(default_factory=dict)
    only: AbstractSet[str] | None = None


class UnusableStateError(ValueError):
    """Raised when a robot state cannot be shown.

    The message gives the reason.
    """


class PosableRobot:
    """A robot that can be drawn in any state.

    Args:
        robot: the robot's description.
        index: finds the files that the description refers to.

    Attributes:
        description: the robot's description.
        root: the name of the root link, which is also the name of its frame.
        joint_names: the joints with a position of their own, parents before children.
        link_names: the links that are connected to the root, parents before children.
        shaped_links: the names of the links with shapes, in alphabetical order.
        problems: the problems with mesh and texture files, by link name.
    """

    def __init__(self, robot: Robot, index: MeshIndex) -> None:
        builder = SceneBuilder(index)
        self.description = robot
        self._links: dict[str, LinkScene] = {link.name: link for link in builder.links(robot, "")}
        self.problems = builder.problems
        self.shaped_links = sorted(link.name for link in self._links.values() if link.visuals or link.collisions)
        self._tree = KinematicTree(robot)
        self.joint_names = tuple(self._tree.joint_names)
        self.link_names = tuple(self._tree.link_names)
        self._independent_joints = frozenset(self.joint_names)
        self._joint_names = frozenset(robot.joints)
        self._children_by_parent: dict[str, list[str]] = {}
        for joint in robot.joints.values():
            self._children_by_parent.setdefault(joint.parent, []).append(joint.child)
        self._child_by_joint = {joint.name: joint.child for joint in robot.joints.values()}
        self.root = self._tree.link_names[0]

    def has_link(self, name: str) -> bool:
        """Return whether the robot has a link with this name."""
        return name in self._links

    def has_joint(self, name: str) -> bool:
        """Return whether the robot has a joint with this name."""
        return name in self._joint_names

    def links_moved_by(self, joints: AbstractSet[str]) -> set[str]:
        """Return the names of all links below any of these joints."""
        pending = [self._child_by_joint[name] for name in joints if name in self._child_by_joint]
        links: set[str] = set()
        while pending:
            link = pending.pop()
            if link not in links:
                links.add(link)
                pending += self._children_by_parent.get(link, ())
        return links

    def compute_reach(self, link: str) -> float:
        """Return the length of the path along the joints from the root to a link, in meters."""
        parents = parent_joints(self.description)
        reach = 0.0
        while link in parents:
            reach += math.hypot(*parents[link].origin.xyz)
            link = parents[link].parent
        return reach

    def set_state(self, state: JointPositions, message: Any) -> list[str]:
        """Copy the joint positions and the root's pose of a moveit_msgs/msg/RobotState to a state.

        Returns:
            The joints of the message that the robot does not have.

        Raises:
            UnusableStateError: lists have different lengths, or numbers are not finite.
        """
        joints = message.joint_state
        unknown = self.set_joints(state, joints.name, joints.position)
        multi_dof = message.multi_dof_joint_state
        if len(multi_dof.joint_names) != len(multi_dof.transforms):
            raise UnusableStateError(
                phrase(
                    "The state has {joints} multi-DOF joints, but {transforms} transforms",
                    joints=len(multi_dof.joint_names),
                    transforms=len(multi_dof.transforms),
                )
            )
        for name, transform in zip(multi_dof.joint_names, multi_dof.transforms, strict=True):
            if name not in self._joint_names:  # such a joint is a virtual joint of the SRDF, which moves the root
                self.set_root(state, multi_dof.header.frame_id, transform)
        return unknown

    def set_root(self, state: JointPositions, frame: str, transform: Any) -> None:
        """Set the root's pose in a state from a geometry_msgs/msg/Transform relative to `frame`.

        Raises:
            UnusableStateError: a number is not finite.
        """
        translation, rotation = transform.translation, transform.rotation
        if not all(
            map(
                math.isfinite,
                (translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w),
            )
        ):
            raise UnusableStateError(phrase("The state has invalid floating point values (nans or infs)"))
        state.frame = frame.removeprefix("/")
        x, y, z, qx, qy, qz, qw = pose_to_values(_TransformAsPose(translation, rotation))
        state.root_in_frame = (x, y, z, qx, qy, qz, qw)

    def set_joints(self, state: JointPositions, names: Any, positions: Any) -> list[str]:
        """Set the positions of some joints in a state, in rad or m.

        Returns:
            The names of joints that the robot does not have.

        Raises:
            UnusableStateError: the lists have different lengths, or a position is not finite.
        """
        if len(names) != len(positions):
            raise UnusableStateError(
                phrase(
                    "The state has {names} joints, but {positions} positions",
                    names=len(names),
                    positions=len(positions),
                )
            )
        unknown = []
        for name, position in zip(names, positions, strict=True):
            if not math.isfinite(position):
                raise UnusableStateError(
                    phrase(
                        "The position of joint '{name}' must be finite, but is {position}",
                        name=name,
                        position=position,
                    )
                )
            if name in self._independent_joints:
                state.values[name] = float(position)
            elif name not in self._joint_names:
                unknown.append(name)
        return unknown

    def link_poses(self, state: JointPositions) -> dict[str, Transform]:
        """Return the poses of the links in a state, relative to the frame that `frame_of` returns."""
        matrices = self._tree.forward(state.values)
        quaternions = quaternion_from_matrix(matrices[:, :3, :3]).tolist()
        translations = matrices[:, :3, 3].tolist()
        return {
            name: compose(state.root_in_frame, (x, y, z, qx, qy, qz, qw))
            for name, (x, y, z), (qx, qy, qz, qw) in zip(self._tree.link_names, translations, quaternions, strict=True)
        }

    def frame_of(self, state: JointPositions) -> str:
        """Return the reference frame of the link poses of a state."""
        return state.frame or self.root

    def make_markers(self, state: JointPositions, appearance: Appearance) -> list[MarkerShape]:
        """Return the markers that draw the robot in a state."""
        frame = self.frame_of(state)
        shape_markers: list[MarkerShape] = []
        for name, pose in self.link_poses(state).items():
            link = self._links[name]
            alpha = appearance.alpha * appearance.alphas.get(name, 1.0)
            if alpha == 0.0 or (appearance.only is not None and name not in appearance.only):
                continue
            shapes = [*(link.visuals if appearance.visual else ()), *(link.collisions if appearance.collision else ())]
            color = appearance.links.get(name)
            if color is None and appearance.color is not None:
                color = (*appearance.color, 1.0)
            for index, shape in enumerate(shapes):
                marker_name = f"{name} {index}" if index else name
                red, green, blue, opacity = color or _get_description_color(shape)
                rgba = (red, green, blue, opacity * alpha)
                placement = _MarkerPlacement(
                    appearance.namespace, marker_name, frame, compose(pose, _compute_pose_in_link(shape))
                )
                shape_markers += _make_shape_markers(shape, placement, rgba, is_painted=color is not None)
        return shape_markers


@dataclass(frozen=True, slots=True)
class _TransformAsPose:
    """A transform with the attribute names of a pose message."""

    position: Any
    orientation: Any


@dataclass(frozen=True, slots=True)
class _MarkerPlacement:
    """The namespace, name, frame and pose of a new marker."""

    namespace: str
    name: str
    frame: str
    pose: Transform

    def marker(self, kind: MarkerKind, scale: list[float], color: Color, mesh: MarkerMesh | None = None) -> MarkerShape:
        return make_marker(self.namespace, self.name, kind, self.pose, scale, color, frame=self.frame, mesh=mesh)

    def end(self, index: int, z: float) -> _MarkerPlacement:
        pose = compose(self.pose, (0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0))
        return _MarkerPlacement(self.namespace, f"{self.name} end {index}", self.frame, pose)


def _make_shape_markers(
    shape: Shape, placement: _MarkerPlacement, color: Color, *, is_painted: bool
) -> list[MarkerShape]:
    if shape.kind == "mesh":
        mesh = MarkerMesh(shape.format or "", shape.url, None, embedded=not is_painted)
        return [placement.marker("mesh", shape.size, color, mesh)]
    if shape.kind == "box":
        return [placement.marker("cube", shape.size, color)]
    radius = shape.size[0]
    sphere_size = [2.0 * radius] * 3
    if shape.kind == "sphere":
        return [placement.marker("sphere", sphere_size, color)]
    length = shape.size[1]
    cylinder = placement.marker("cylinder", [2.0 * radius, 2.0 * radius, length], color)
    if shape.kind == "cylinder":
        return [cylinder]
    ends = (placement.end(index, sign * length / 2.0) for index, sign in enumerate((-1.0, 1.0)))
    return [cylinder, *(at_end.marker("sphere", sphere_size, color) for at_end in ends)]


def _compute_pose_in_link(shape: Shape) -> Transform:
    x, y, z = shape.position
    qx, qy, qz, qw = shape.quaternion
    return (x, y, z, qx, qy, qz, qw)


def _get_description_color(shape: Shape) -> Color:
    """Return the color of a shape in the description, by default red.

    The color of a mesh is white, because it is multiplied by the materials of the mesh. STL meshes have no materials,
    and so have the color of the description.
    """
    if shape.kind == "mesh" and not (shape.format or "").startswith("stl"):
        alpha = shape.color[3] if shape.color else 1.0
        return (1.0, 1.0, 1.0, alpha)
    if shape.color:
        red, green, blue, alpha = shape.color
        return (red, green, blue, alpha)
    return _DEFAULT_COLOR
