"""The planning scene of move_group.

It has objects in the world and on the robot, and the pairs that may collide.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from copy import deepcopy
from dataclasses import replace
from typing import Any

from linkwright.geometry.arrays import Array, compose, invert
from linkwright.messages import get_message
from linkwright.planning.collision_scene import AllowedCollisions, LinkMargin, SceneObject
from linkwright.planning.nodes.conversions import (
    FrameLookup,
    InvalidShapeError,
    UnknownFrameError,
    pose_message,
    pose_row,
    shapes_of,
)

_ADD, _REMOVE, _APPEND, _MOVE = b"\x00", b"\x01", b"\x02", b"\x03"
_SHAPE_FIELDS = ("primitives", "primitive_poses", "meshes", "mesh_poses", "planes", "plane_poses")
_SCENE_SETTINGS, _ROBOT_STATE, _ATTACHED = 1, 2, 4
_ALL_COMPONENTS = (1 << 10) - 1
_WORLD_NAMES, _WORLD_GEOMETRY, _OCTOMAP, _TRANSFORMS, _ALLOWED, _PADDING, _COLORS = 8, 16, 32, 64, 128, 256, 512


class SceneState:
    """A planning scene that messages change.

    Args:
        frame: the planning frame, which is the frame of the robot's root link.
        allowed: the pairs of links that may collide by the SRDF.
        links: the names of the robot's links.
        warn: receives the reasons why a part of a message was ignored.
        margins: the margins of links to objects of the world.

    Attributes:
        objects: the objects in the world by ID, with poses in the planning frame.
        attached: the attached objects by ID, with poses in the frame of their link.
        allowed: the pairs that may collide.
        margins: the margins of links to objects of the world, by link name.
    """

    def __init__(
        self,
        frame: str,
        allowed: AllowedCollisions,
        links: Collection[str],
        warn: Callable[[str], object],
        margins: Mapping[str, LinkMargin],
    ) -> None:
        self.frame = frame
        self.name = "(noname)"
        self.objects: dict[str, Any] = {}
        self.attached: dict[str, Any] = {}
        self.allowed = allowed
        self.margins = dict(margins)
        self._initial_allowed = deepcopy(allowed)
        self._colors: dict[str, Any] = {}
        self._links = links
        self._warn = warn

    def copy(self) -> SceneState:
        """Return a copy that can be changed."""
        other = SceneState(self.frame, self.allowed.copy(), self._links, self._warn, self.margins)
        other.name, other._initial_allowed = self.name, self._initial_allowed
        other.objects, other.attached, other._colors = dict(self.objects), dict(self.attached), dict(self._colors)
        return other

    def apply(self, message: Any, lookup: FrameLookup) -> bool:
        """Apply a moveit_msgs/msg/PlanningScene, and return whether all of it could be applied.

        Args:
            message: a full scene or a difference.
            lookup: returns the poses of frames, among them the links of the robot in its current state.
        """
        if not message.is_diff:
            self.objects.clear()
            self.attached.clear()
            self._colors.clear()
            self.allowed = deepcopy(self._initial_allowed)
        if message.name:
            self.name = message.name
        if message.allowed_collision_matrix.entry_names or message.allowed_collision_matrix.default_entry_names:
            self._set_allowed(message.allowed_collision_matrix)
        for color in message.object_colors:
            self.set_color(color)
        is_applied = True
        for margin in (*message.link_padding, *message.link_scale):
            is_applied &= self._apply_margin(margin)
        for collision_object in message.world.collision_objects:
            is_applied &= self.apply_object(collision_object, lookup)
        for attached in message.robot_state.attached_collision_objects:
            is_applied &= self.apply_attached(attached, lookup)
        return is_applied

    def _apply_margin(self, message: Any) -> bool:
        """Apply a moveit_msgs/msg/LinkPadding or LinkScale, and return whether that was possible."""
        link = message.link_name
        change = {"padding": message.padding} if hasattr(message, "padding") else {"scale": message.scale}
        margin = replace(self.margins.get(link, LinkMargin()), **change)
        reason = margin.find_error() or ("" if link in self._links else "the robot has no such link")
        if reason:
            self._warn(f"The padding and the scale of link '{link}' were not changed: {reason}")
            return False
        self.margins[link] = margin
        return True

    def set_color(self, message: Any) -> None:
        """Set the color of an object (moveit_msgs/msg/ObjectColor)."""
        self._colors[message.id] = message

    def apply_object(self, message: Any, lookup: FrameLookup) -> bool:
        """Apply a moveit_msgs/msg/CollisionObject, and return whether that was possible."""
        name, operation = message.id, message.operation
        if operation == _REMOVE:
            if name and name not in self.objects:
                self._warn(f"Tried to remove object '{name}', but it does not exist in this scene.")
                return False
            for removed in [name] if name else list(self.objects):
                del self.objects[removed]
            return True
        if name in self._links:
            self._warn(f"Cannot add object '{name}': a link of the robot has this name")
            return False
        existing = self.objects.get(name)
        if operation == _MOVE and existing is None:
            self._warn(f"World object '{name}' does not exist. Cannot move.")
            return False
        try:
            placed = self._place(message, lookup)
            if operation == _MOVE and existing is not None:
                moved = deepcopy(existing)
                moved.pose = placed.pose
                for field in _SHAPE_FIELDS[1::2]:
                    if getattr(message, field):
                        setattr(moved, field, getattr(placed, field))
                placed = moved
            elif operation == _APPEND and existing is not None:
                placed = _with_added_shapes(existing, placed)
            if not shapes_of(placed):
                self._warn(f"There are no shapes specified in the collision object message of '{name}'")
                return False
        except (UnknownFrameError, InvalidShapeError) as error:
            self._warn(f"Object '{name}' cannot be used: {error}")
            return False
        placed.operation = _ADD
        self.objects[name] = placed
        return True

    def apply_attached(self, message: Any, lookup: FrameLookup) -> bool:
        """Apply a moveit_msgs/msg/AttachedCollisionObject, and return whether that was possible."""
        name, link = message.object.id, message.link_name
        if message.object.operation == _REMOVE:
            names = [
                key for key, item in self.attached.items() if key == name or (not name and link in ("", item.link_name))
            ]
            for removed in names:
                self._detach(removed, lookup)
            return bool(names) or not name
        if link not in self._links:
            self._warn(f"Cannot attach object '{name}': the robot has no link '{link}'")
            return False
        try:
            link_pose = lookup(link)
            attached = deepcopy(message)
            if any(getattr(message.object, field) for field in ("primitives", "meshes", "planes")):
                placed = self._place(message.object, lookup)
            elif name in self.objects:
                placed = deepcopy(self.objects[name])
            else:
                self._warn(f"Attempting to attach object '{name}' to link '{link}' but no geometry specified")
                return False
            if not shapes_of(placed):
                return False
        except (UnknownFrameError, InvalidShapeError) as error:
            self._warn(f"Object '{name}' cannot be used: {error}")
            return False
        placed.header.frame_id = link
        placed.pose = pose_message(compose(invert(link_pose), pose_row(placed.pose)))
        placed.operation = _ADD
        attached.object = placed
        self.objects.pop(name, None)
        self.attached[name] = attached
        return True

    def collides_like(self, other: SceneState) -> bool:
        """Return whether all that matters for collisions is equal in another scene."""
        return (self.objects, self.attached, self.allowed, self.margins) == (
            other.objects,
            other.attached,
            other.allowed,
            other.margins,
        )

    def scene_objects(self) -> list[SceneObject]:
        """Return the objects for the detection of collisions."""
        world = [
            SceneObject(name, tuple(shapes_of(message)), pose_row(message.pose))
            for name, message in self.objects.items()
        ]
        attached = [
            SceneObject(
                name,
                tuple(shapes_of(message.object)),
                pose_row(message.object.pose),
                message.link_name,
                frozenset((message.link_name, *message.touch_links)),
            )
            for name, message in self.attached.items()
        ]
        return world + attached

    def object_pose(self, name: str, link_poses: Callable[[str], Array]) -> Array | None:
        """Return the pose of an object in the planning frame, shape (7,), or None."""
        if name in self.objects:
            return pose_row(self.objects[name].pose)
        if name in self.attached:
            attached = self.attached[name]
            return compose(link_poses(attached.link_name), pose_row(attached.object.pose))
        return None

    def to_message(self, state: Any, robot_name: str, components: int) -> Any:
        """Return a moveit_msgs/msg/PlanningScene.

        Args:
            state: the moveit_msgs/msg/RobotState of the robot without attached objects.
            robot_name: the name of the robot.
            components: the sum of the requested parts, by moveit_msgs/msg/PlanningSceneComponents; 0 for all.
        """
        components = components or _ALL_COMPONENTS
        message = get_message("moveit_msgs/msg/PlanningScene")()
        if components & _SCENE_SETTINGS:
            message.name, message.robot_model_name = self.name, robot_name
        if components & (_ROBOT_STATE | _ATTACHED):
            message.robot_state = state
        if components & _ATTACHED:
            message.robot_state.attached_collision_objects = list(self.attached.values())
        if components & _WORLD_GEOMETRY:
            message.world.collision_objects = list(self.objects.values())
        elif components & _WORLD_NAMES:
            message.world.collision_objects = [_without_shapes(item) for item in self.objects.values()]
        if components & _ALLOWED:
            message.allowed_collision_matrix = self._allowed_message()
        if components & _PADDING:
            margins = {link: self.margins.get(link, LinkMargin()) for link in self._links}
            padding_class, scale_class = map(get_message, ("moveit_msgs/msg/LinkPadding", "moveit_msgs/msg/LinkScale"))
            message.link_padding = [padding_class(link_name=link, padding=it.padding) for link, it in margins.items()]
            message.link_scale = [scale_class(link_name=link, scale=it.scale) for link, it in margins.items()]
        if components & _COLORS:
            message.object_colors = list(self._colors.values())
        return message

    def _place(self, message: Any, lookup: FrameLookup) -> Any:
        """Return a copy of a CollisionObject in the planning frame.

        Each of its shapes has a pose.
        """
        placed = deepcopy(message)
        for shapes, poses in zip(_SHAPE_FIELDS[::2], _SHAPE_FIELDS[1::2], strict=True):
            if not getattr(message, poses):
                setattr(placed, poses, [get_message("geometry_msgs/msg/Pose")() for _ in getattr(message, shapes)])
        frame = lookup(message.header.frame_id)
        placed.pose = pose_message(compose(frame, pose_row(message.pose)))
        placed.header.frame_id = self.frame
        return placed

    def _detach(self, name: str, lookup: FrameLookup) -> None:
        attached = self.attached.pop(name)
        released = deepcopy(attached.object)
        released.pose = pose_message(compose(lookup(attached.link_name), pose_row(released.pose)))
        released.header.frame_id = self.frame
        self.objects[name] = released

    def _set_allowed(self, matrix: Any) -> None:
        """Apply a moveit_msgs/msg/AllowedCollisionMatrix, whose entries replace all pairs."""
        names = matrix.entry_names
        pairs = {
            frozenset((name, other)): bool(is_allowed)
            for name, entry in zip(names, matrix.entry_values, strict=False)
            for other, is_allowed in zip(names, entry.enabled, strict=False)
            if name != other
        }
        defaults = dict(zip(matrix.default_entry_names, map(bool, matrix.default_entry_values), strict=False))
        self.allowed = AllowedCollisions(pairs or self.allowed.pairs, {**self.allowed.defaults, **defaults})

    def _allowed_message(self) -> Any:
        message = get_message("moveit_msgs/msg/AllowedCollisionMatrix")()
        names = sorted({name for pair in self.allowed.pairs for name in pair})
        message.entry_names = names
        entry_class = get_message("moveit_msgs/msg/AllowedCollisionEntry")
        pairs: Mapping[frozenset[str], bool] = self.allowed.pairs
        for name in names:
            entry = entry_class()
            entry.enabled = [name != other and pairs.get(frozenset((name, other)), False) for other in names]
            message.entry_values.append(entry)
        message.default_entry_names = list(self.allowed.defaults)
        message.default_entry_values = list(self.allowed.defaults.values())
        return message


def _with_added_shapes(existing: Any, addition: Any) -> Any:
    """Return an object with the shapes of another one, which are moved into its frame."""
    joined = deepcopy(existing)
    offset = compose(invert(pose_row(existing.pose)), pose_row(addition.pose))
    for field in _SHAPE_FIELDS:
        items = getattr(addition, field)
        if field.endswith("poses"):
            items = [pose_message(compose(offset, pose_row(pose))) for pose in items]
        setattr(joined, field, [*getattr(existing, field), *items])
    return joined


def _without_shapes(message: Any) -> Any:
    result = deepcopy(message)
    for field in _SHAPE_FIELDS:
        setattr(result, field, [])
    return result
