"""A planning scene, which is updated by messages that contain changes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.geometry.single import IDENTITY, Transform
from linkwright.page.protocol.markers import MarkerShape
from linkwright.rviz.displays.moveit.octree import BadOctreeError, Cells, read_octree
from linkwright.rviz.displays.moveit.properties import rgba
from linkwright.rviz.displays.moveit.robot import JointPositions, PosableRobot
from linkwright.rviz.displays.moveit.solids import BadObjectError, Color, object_markers
from linkwright.rviz.markers.shapes import pose_of

_REMOVE, _APPEND, _MOVE = b"\x01", b"\x02", b"\x03"

OCTOMAP = "<octomap>"
"""The name that MoveIt gives the octomap among the objects."""


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

        Poses of shapes that the message omits stay unchanged.
        """
        poses: dict[str, Any] = {name: tuple(found) for name in _POSES if (found := getattr(message, name))}
        return replace(self, frame=message.header.frame_id.removeprefix("/"), pose=message.pose, **poses)

    @property
    def has_shapes(self) -> bool:
        """Whether the object has shapes to draw."""
        return bool(self.primitives or self.meshes or self.planes)


_POSES = ("primitive_poses", "mesh_poses", "plane_poses")
_SHAPES = ("primitives", "meshes", "planes", *_POSES)


@dataclass(frozen=True, slots=True)
class PlacedCells:
    """The cells of an octomap and the octomap's pose."""

    cells: Cells
    frame: str
    base: Transform


class Scene:
    """The objects around a robot, the objects attached to it, and its joint positions.

    Attributes:
        name: the name of the scene.
        is_whole: whether the full scene is known, and not only the changes since the subscription.
        state: the robot's state.
        octomap: the cells and the pose of the octomap, or None.
        problems: the problems with objects, by object ID.
    """

    def __init__(self) -> None:
        self.name = ""
        self.is_whole = False
        self.state = JointPositions()
        self.octomap: PlacedCells | None = None
        self.problems: dict[str, Phrase] = {}
        self._objects: dict[str, SceneObject] = {}
        self._held: dict[str, tuple[str, SceneObject]] = {}
        self._colors: dict[str, Color] = {}

    def apply(self, message: Any) -> None:
        """Apply a moveit_msgs/msg/PlanningScene, either a full scene or a difference.

        The caller applies the robot's joint positions.
        """
        if not message.is_diff:
            self._objects.clear()
            self._held.clear()
            self._colors.clear()
            self.problems.clear()
            self.octomap = None
            self.is_whole = True
        if message.name:
            self.name = message.name
        for object_color in message.object_colors:
            self._colors[object_color.id] = rgba(object_color.color)
        if not message.robot_state.is_diff and not message.is_diff:
            self._held.clear()
        for collision_object in message.world.collision_objects:
            self._change(collision_object)
        self.attach(message.robot_state.attached_collision_objects)
        octomap = message.world.octomap
        if octomap.octomap.id or octomap.octomap.data:
            self._map(octomap)

    def attach(self, messages: Iterable[Any]) -> None:
        """Apply moveit_msgs/msg/AttachedCollisionObject messages, which attach or detach objects."""
        for attached in messages:
            self._attach(attached)

    def object_markers(self, namespace: str, color: Color) -> list[MarkerShape]:
        """Return the markers of the objects that are not attached to the robot."""
        made: list[MarkerShape] = []
        for known_object in self._objects.values():
            chosen = self._colors.get(known_object.id, color)
            made += self._markers(known_object, namespace, chosen, known_object.frame, IDENTITY)
        return made

    def held_markers(
        self, robot: PosableRobot, state: JointPositions, namespace: str, color: Color
    ) -> list[MarkerShape]:
        """Return the markers of the attached objects, with the robot in the given state."""
        links = robot.link_poses(state)
        made: list[MarkerShape] = []
        for link, held in self._held.values():
            at = held.frame or link
            if at not in links:
                self.problems[held.id] = phrase(
                    "The robot has no link '{link}' for the attached object '{name}'", link=at, name=held.id
                )
                continue
            chosen = self._colors.get(held.id, color)
            made += self._markers(held, namespace, chosen, robot.frame_of(state), links[at])
        return made

    def _markers(
        self, scene_object: SceneObject, namespace: str, color: Color, frame: str, base: Transform
    ) -> list[MarkerShape]:
        try:
            made = object_markers(scene_object, namespace, color, frame=frame, base=base)
        except BadObjectError as error:
            self.problems[scene_object.id] = foreign(error)
            return []
        self.problems.pop(scene_object.id, None)
        return made

    def _change(self, message: Any) -> None:
        name, operation = message.id, message.operation
        known = self._objects.get(name)
        if operation == _REMOVE:
            if not name:
                self._objects.clear()
            self._objects.pop(name, None)
            self.problems.pop(name, None)
        elif operation == _MOVE:
            if known is None:
                self.problems[name] = phrase("Object '{name}' cannot be moved: it does not exist", name=name)
            else:
                self._objects[name] = known.moved(message)
        elif operation == _APPEND and known is not None:
            self._objects[name] = known.with_added_shapes(message)
        else:
            self._objects[name] = SceneObject.of(message)

    def _attach(self, message: Any) -> None:
        name, link = message.object.id, message.link_name
        if message.object.operation == _REMOVE:
            gone = [
                identity
                for identity, (at, _) in self._held.items()
                if identity == name or (not name and link in ("", at))
            ]
            for identity in gone:
                del self._held[identity]
                self.problems.pop(identity, None)
            return
        held = SceneObject.of(message.object)
        before = self._held.get(name)
        if message.object.operation == _APPEND and before is not None:
            held = before[1].with_added_shapes(message.object)
        if not held.has_shapes:
            self.problems[name] = phrase("The attached object '{name}' has no shapes", name=name)
            return
        self._objects.pop(name, None)
        self.problems.pop(name, None)
        self._held[name] = (link, held)

    def _map(self, message: Any) -> None:
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
            x, y, z, qx, qy, qz, qw = pose_of(message.origin)
            frame = message.header.frame_id or octomap.header.frame_id
            self.octomap = PlacedCells(cells, frame.removeprefix("/"), (x, y, z, qx, qy, qz, qw))
