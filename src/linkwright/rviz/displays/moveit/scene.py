"""A planning scene that messages change."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.geometry.single import IDENTITY, Transform
from linkwright.page.protocol.markers import MarkerShape
from linkwright.rviz.displays.moveit.octree import BadOctreeError, Cells, read_octree
from linkwright.rviz.displays.moveit.properties import rgba_from_message
from linkwright.rviz.displays.moveit.robot import JointPositions, PosableRobot
from linkwright.rviz.displays.moveit.solids import BadObjectError, Color, make_object_markers
from linkwright.rviz.markers.shapes import pose_to_values

_REMOVE, _APPEND, _MOVE = b"\x01", b"\x02", b"\x03"

OCTOMAP = "<octomap>"
"""The ID of the octomap among the objects of MoveIt."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """A collision object, with the field names of moveit_msgs/msg/CollisionObject."""

    id: str
    frame: str
    pose: Any
    primitives: tuple[Any, ...]
    primitive_poses: tuple[Any, ...]
    meshes: tuple[Any, ...]
    mesh_poses: tuple[Any, ...]
    planes: tuple[Any, ...]
    plane_poses: tuple[Any, ...]

    @classmethod
    def of(cls, message: Any) -> SceneObject:
        """Return the object that a moveit_msgs/msg/CollisionObject describes."""
        shapes: dict[str, Any] = {name: tuple(getattr(message, name)) for name in _SHAPES}
        return cls(message.id, message.header.frame_id.removeprefix("/"), message.pose, **shapes)

    def with_added_shapes(self, message: Any) -> SceneObject:
        """Return a copy of the object with the message's shapes added."""
        shapes: dict[str, Any] = {name: (*getattr(self, name), *getattr(message, name)) for name in _SHAPES}
        return replace(self, **shapes)

    def moved(self, message: Any) -> SceneObject:
        """Return a copy of the object with the frame and the poses of a message.

        Poses that the message omits stay unchanged.
        """
        poses: dict[str, Any] = {
            name: tuple(poses_of_kind) for name in _POSES if (poses_of_kind := getattr(message, name))
        }
        return replace(self, frame=message.header.frame_id.removeprefix("/"), pose=message.pose, **poses)

    @property
    def has_shapes(self) -> bool:
        """Whether the object has shapes to draw."""
        return bool(self.primitives or self.meshes or self.planes)


_POSES = ("primitive_poses", "mesh_poses", "plane_poses")
_SHAPES = ("primitives", "meshes", "planes", *_POSES)


@dataclass(frozen=True, slots=True)
class PlacedCells:
    """The cells of an octomap, and the pose `base` of the octomap in a frame."""

    cells: Cells
    frame: str
    base: Transform


class Scene:
    """The objects around a robot, the objects attached to it, and its joint positions.

    Attributes:
        name: the name of the scene.
        has_full_scene: whether a full scene was received, and not only changes.
        state: the robot's state.
        octomap: the cells and the pose of the octomap, or None.
        problems: the problems with objects, by object ID.
    """

    def __init__(self) -> None:
        self.name = ""
        self.has_full_scene = False
        self.state = JointPositions()
        self.octomap: PlacedCells | None = None
        self.problems: dict[str, Phrase] = {}
        self._objects: dict[str, SceneObject] = {}
        self._attached: dict[str, tuple[str, SceneObject]] = {}
        self._colors: dict[str, Color] = {}

    def apply(self, message: Any) -> None:
        """Apply a moveit_msgs/msg/PlanningScene, either a full scene or a difference.

        The caller must apply the joint positions of the robot.
        """
        if not message.is_diff:
            self._objects.clear()
            self._attached.clear()
            self._colors.clear()
            self.problems.clear()
            self.octomap = None
            self.has_full_scene = True
        if message.name:
            self.name = message.name
        for object_color in message.object_colors:
            self._colors[object_color.id] = rgba_from_message(object_color.color)
        if not message.robot_state.is_diff and not message.is_diff:
            self._attached.clear()
        for collision_object in message.world.collision_objects:
            self._apply_object(collision_object)
        self.attach(message.robot_state.attached_collision_objects)
        octomap = message.world.octomap
        if octomap.octomap.id or octomap.octomap.data:
            self._apply_octomap(octomap)

    @property
    def objects(self) -> Mapping[str, SceneObject]:
        """The objects around the robot by ID."""
        return self._objects

    @property
    def attached(self) -> Mapping[str, tuple[str, SceneObject]]:
        """The attached objects by ID, each with the link to which it is attached."""
        return self._attached

    def attach(self, messages: Iterable[Any]) -> None:
        """Attach and detach objects, as moveit_msgs/msg/AttachedCollisionObject messages request."""
        for attached in messages:
            self._attach(attached)

    def make_object_markers(self, namespace: str, color: Color) -> list[MarkerShape]:
        """Return the markers of the objects that are not attached to the robot."""
        shape_markers: list[MarkerShape] = []
        for scene_object in self._objects.values():
            object_color = self._colors.get(scene_object.id, color)
            shape_markers += self._make_markers(scene_object, namespace, object_color, scene_object.frame, IDENTITY)
        return shape_markers

    def make_attached_markers(
        self, robot: PosableRobot, state: JointPositions, namespace: str, color: Color
    ) -> list[MarkerShape]:
        """Return the markers of the attached objects, with the robot in the given state."""
        links = robot.link_poses(state)
        shape_markers: list[MarkerShape] = []
        for link, attached_object in self._attached.values():
            frame = attached_object.frame or link
            if frame not in links:
                self.problems[attached_object.id] = phrase(
                    "The robot has no link '{link}' for the attached object '{name}'",
                    link=frame,
                    name=attached_object.id,
                )
                continue
            object_color = self._colors.get(attached_object.id, color)
            shape_markers += self._make_markers(
                attached_object, namespace, object_color, robot.frame_of(state), links[frame]
            )
        return shape_markers

    def _make_markers(
        self, scene_object: SceneObject, namespace: str, color: Color, frame: str, base: Transform
    ) -> list[MarkerShape]:
        try:
            shape_markers = make_object_markers(scene_object, namespace, color, frame=frame, base=base)
        except BadObjectError as error:
            self.problems[scene_object.id] = foreign(error)
            return []
        self.problems.pop(scene_object.id, None)
        return shape_markers

    def _apply_object(self, message: Any) -> None:
        name, operation = message.id, message.operation
        existing = self._objects.get(name)
        if operation == _REMOVE:
            if not name:
                self._objects.clear()
            self._objects.pop(name, None)
            self.problems.pop(name, None)
        elif operation == _MOVE:
            if existing is None:
                self.problems[name] = phrase("Object '{name}' cannot be moved, because it does not exist", name=name)
            else:
                self._objects[name] = existing.moved(message)
        elif operation == _APPEND and existing is not None:
            self._objects[name] = existing.with_added_shapes(message)
        else:
            self._objects[name] = SceneObject.of(message)

    def _attach(self, message: Any) -> None:
        name, link = message.object.id, message.link_name
        if message.object.operation == _REMOVE:
            removed_ids = [
                object_id
                for object_id, (attached_link, _) in self._attached.items()
                if object_id == name or (not name and link in ("", attached_link))
            ]
            for object_id in removed_ids:
                del self._attached[object_id]
                self.problems.pop(object_id, None)
            return
        attached_object = SceneObject.of(message.object)
        previous = self._attached.get(name)
        if message.object.operation == _APPEND and previous is not None:
            attached_object = previous[1].with_added_shapes(message.object)
        if not attached_object.has_shapes:
            self.problems[name] = phrase("The attached object '{name}' has no shapes", name=name)
            return
        self._objects.pop(name, None)
        self.problems.pop(name, None)
        self._attached[name] = (link, attached_object)

    def _apply_octomap(self, message: Any) -> None:
        octomap = message.octomap
        self.octomap = None
        try:
            cells = read_octree(
                data=np.asarray(octomap.data, dtype=np.int8).tobytes(),
                binary=octomap.binary,
                kind=octomap.id,
                resolution=octomap.resolution,
            )
        except BadOctreeError as error:
            self.problems[OCTOMAP] = foreign(error)
            return
        self.problems.pop(OCTOMAP, None)
        if len(cells.sizes):
            x, y, z, qx, qy, qz, qw = pose_to_values(message.origin)
            frame = message.header.frame_id or octomap.header.frame_id
            self.octomap = PlacedCells(cells, frame.removeprefix("/"), (x, y, z, qx, qy, qz, qw))
