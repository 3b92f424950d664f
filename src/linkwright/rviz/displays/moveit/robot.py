"""Draws a robot as markers in a state from a message; the links are placed without tf."""

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
from linkwright.rviz.markers.shapes import make_marker, pose_of
from linkwright.rviz.robot import SceneBuilder
from linkwright.urdf import Robot

_RED: Color = (1.0, 0.0, 0.0, 1.0)
"""RViz's colour of shapes without one."""


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
class Look:
    """The appearance of a robot: colours, opacity, and the links and shapes to draw.

    Attributes:
        namespace: the markers' namespace.
        visual: whether to draw the visual geometry.
        collision: whether to draw the collision geometry.
        alpha: the opacity of all links.
        alphas: the opacity of individual links, which is multiplied by `alpha`; links with 0 are not drawn.
        color: the RGB colour of all links; None to use the links' own colours.
        links: the colours of individual links, which take precedence over `color`.
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
    """Raised when a robot state cannot be shown; the message gives the reason."""


class PosableRobot:
    """A robot that can be drawn in any state.

    Args:
        robot: the robot's description.
        index: finds the files that the description refers to.

    Attributes:
        root: the name of the root link, which is also the name of its frame.
        shaped_links: the names of the links with shapes, in alphabetical order.
        problems: the problems with files, by link.
    """

    def __init__(self, robot: Robot, index: MeshIndex) -> None:
        builder = SceneBuilder(index)
        self._links: dict[str, LinkScene] = {link.name: link for link in builder.links(robot, "")}
        self.problems = builder.problems
        self.shaped_links = sorted(link.name for link in self._links.values() if link.visuals or link.collisions)
        self._tree = KinematicTree(robot)
        self._free = frozenset(self._tree.joint_names)
        self._joints = frozenset(robot.joints)
        self._below: dict[str, list[str]] = {}
        for joint in robot.joints.values():
            self._below.setdefault(joint.parent, []).append(joint.child)
        self._children = {joint.name: joint.child for joint in robot.joints.values()}
        self.root = self._tree.link_names[0]

    def has_link(self, name: str) -> bool:
        """Return whether the robot has a link with this name."""
        return name in self._links

    def has_joint(self, name: str) -> bool:
        """Return whether the robot has a joint with this name."""
        return name in self._joints

    def links_moved_by(self, joints: AbstractSet[str]) -> set[str]:
        """Return the names of all links below any of these joints."""
        pending = [self._children[name] for name in joints if name in self._children]
        found: set[str] = set()
        while pending:
            link = pending.pop()
            if link not in found:
                found.add(link)
                pending += self._below.get(link, ())
        return found

    def set_state(self, state: JointPositions, message: Any) -> list[str]:
        """Copy the joint positions and the root's pose of a moveit_msgs/msg/RobotState to a state.

        Returns:
            The joints of the message that the robot does not have.

        Raises:
            UnusableStateError: lists have different lengths, or numbers are not finite.
        """
        joints = message.joint_state
        unknown = self.set_joints(state, joints.name, joints.position)
        several = message.multi_dof_joint_state
        if len(several.joint_names) != len(several.transforms):
            raise UnusableStateError(
                phrase(
                    "The state has {joint_names} multi-DOF joints, but {transforms} transforms",
                    joint_names=len(several.joint_names),
                    transforms=len(several.transforms),
                )
            )
        for name, transform in zip(several.joint_names, several.transforms, strict=True):
            if name not in self._joints:  # a virtual joint of the SRDF, which moves the root
                self.set_root(state, several.header.frame_id, transform)
        return unknown

    def set_root(self, state: JointPositions, frame: str, transform: Any) -> None:
        """Set the root's pose in a state from a geometry_msgs/msg/Transform relative to `frame`.

        Raises:
            UnusableStateError: a number is not finite.
        """
        at, turn = transform.translation, transform.rotation
        if not all(map(math.isfinite, (at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w))):
            raise UnusableStateError(phrase("The state has invalid floating point values (nans or infs)"))
        state.frame = frame.removeprefix("/")
        x, y, z, qx, qy, qz, qw = pose_of(_TransformAsPose(at, turn))
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
                    phrase("The position of joint '{name}' is {position}", name=name, position=position)
                )
            if name in self._free:
                state.values[name] = float(position)
            elif name not in self._joints:
                unknown.append(name)
        return unknown

    def link_poses(self, state: JointPositions) -> dict[str, Transform]:
        """Return the poses of the links in a state, relative to the frame that `frame_of` returns."""
        matrices = self._tree.forward(state.values)
        turns = quaternion_from_matrix(matrices[:, :3, :3]).tolist()
        places = matrices[:, :3, 3].tolist()
        return {
            name: compose(state.root_in_frame, (x, y, z, qx, qy, qz, qw))
            for name, (x, y, z), (qx, qy, qz, qw) in zip(self._tree.link_names, places, turns, strict=True)
        }

    def frame_of(self, state: JointPositions) -> str:
        """Return the frame to which the link poses of a state are relative."""
        return state.frame or self.root

    def markers(self, state: JointPositions, look: Look) -> list[MarkerShape]:
        """Return the markers that draw the robot in a state."""
        frame = self.frame_of(state)
        made: list[MarkerShape] = []
        for name, pose in self.link_poses(state).items():
            link = self._links[name]
            alpha = look.alpha * look.alphas.get(name, 1.0)
            if alpha == 0.0 or (look.only is not None and name not in look.only):
                continue
            shapes = [*(link.visuals if look.visual else ()), *(link.collisions if look.collision else ())]
            color = look.links.get(name)
            if color is None and look.color is not None:
                color = (*look.color, 1.0)
            for number, shape in enumerate(shapes):
                called = f"{name} {number}" if number else name
                red, green, blue, opacity = color or _own_color(shape)
                rgba = (red, green, blue, opacity * alpha)
                place = _Place(look.namespace, called, frame, compose(pose, _in_link(shape)))
                made += _shape_markers(shape, place, rgba, is_painted=color is not None)
        return made


@dataclass(frozen=True, slots=True)
class _TransformAsPose:
    """A transform under the attribute names of a pose message."""

    position: Any
    orientation: Any


@dataclass(frozen=True, slots=True)
class _Place:
    """The namespace, name, frame and pose that a marker gets."""

    namespace: str
    name: str
    frame: str
    pose: Transform

    def marker(self, kind: MarkerKind, scale: list[float], color: Color, mesh: MarkerMesh | None = None) -> MarkerShape:
        return make_marker(self.namespace, self.name, kind, self.pose, scale, color, frame=self.frame, mesh=mesh)

    def end(self, number: int, z: float) -> _Place:
        pose = compose(self.pose, (0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0))
        return _Place(self.namespace, f"{self.name} end {number}", self.frame, pose)


def _shape_markers(shape: Shape, place: _Place, color: Color, *, is_painted: bool) -> list[MarkerShape]:
    if shape.kind == "mesh":
        mesh = MarkerMesh(shape.format or "", shape.url, None, embedded=not is_painted)
        return [place.marker("mesh", shape.size, color, mesh)]
    if shape.kind == "box":
        return [place.marker("cube", shape.size, color)]
    radius = shape.size[0]
    ball = [2.0 * radius] * 3
    if shape.kind == "sphere":
        return [place.marker("sphere", ball, color)]
    length = shape.size[1]
    tube = place.marker("cylinder", [2.0 * radius, 2.0 * radius, length], color)
    if shape.kind == "cylinder":
        return [tube]
    ends = (place.end(number, sign * length / 2.0) for number, sign in enumerate((-1.0, 1.0)))
    return [tube, *(end.marker("sphere", ball, color) for end in ends)]


def _in_link(shape: Shape) -> Transform:
    x, y, z = shape.position
    qx, qy, qz, qw = shape.quaternion
    return (x, y, z, qx, qy, qz, qw)


def _own_color(shape: Shape) -> Color:
    """Return the colour of a shape in the description, by default red.

    The colour of a mesh is white, except of STL meshes, because it is multiplied by the mesh's own materials.
    """
    if shape.kind == "mesh" and not (shape.format or "").startswith("stl"):
        alpha = shape.color[3] if shape.color else 1.0
        return (1.0, 1.0, 1.0, alpha)
    if shape.color:
        red, green, blue, alpha = shape.color
        return (red, green, blue, alpha)
    return _RED
