"""Poses of frames in models and worlds, according to SDF's "pose frame semantics".

Source: the proposal "Pose Frame Semantics" of SDFormat, for SDF 1.7 and later. Poses in older files, which do not name
frames, have the same result. A frame is named within its model or world; ``arm::tip`` is the frame ``tip`` of the
nested model ``arm``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.geometry.single import (
    IDENTITY,
    Pose,
    Transform,
    Vector3,
    compose,
    invert,
    pose_quaternion,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rpy_from_quaternion,
)
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.links import Link
from linkwright.sdf.models import Frame, Model
from linkwright.sdf.poses import MODEL, SEPARATOR, WORLD, RawPose
from linkwright.sdf.worlds import World

Owner = Model | World
Framed = Link | Joint | Frame | Model

_ANGLE_TOLERANCE = 1e-12
"""Rotation differences below this, in half radians, are rounding errors."""


class FrameError(Exception):
    """Raised when a pose cannot be computed.

    Attributes:
        name: the missing frame, or one frame of a cycle.
        cycle: the frames of the cycle, in order; empty for a frame that does not exist.
    """

    def __init__(self, name: str, cycle: Sequence[str] = ()) -> None:
        super().__init__(name)
        self.name = name
        self.cycle = tuple(cycle)


class Frames:
    """The frames of a model or world, by name, with their poses.

    Args:
        owner: the model or world, with its includes resolved.
    """

    def __init__(self, owner: Owner) -> None:
        self.owner = owner
        elements_by_name: dict[str, Framed] = {}
        links = owner.links if isinstance(owner, Model) else ()
        elements: tuple[Framed, ...] = (*links, *owner.frames, *owner.joints, *owner.models)
        for element in elements:
            elements_by_name.setdefault(element.name, element)
        self.elements_by_name = elements_by_name
        self._roots = frozenset({"", MODEL} if isinstance(owner, Model) else {"", WORLD})
        self._inner: dict[str, Frames] = {}
        self._poses: dict[str, Transform] = {}

    def __contains__(self, name: str) -> bool:
        head, colon, tail = name.partition(SEPARATOR)
        if not colon or name in self.elements_by_name:  # Link names in old files contain '::'.
            return name in self._roots or name in self.elements_by_name
        return isinstance(self.elements_by_name.get(head), Model) and tail in self.inside(head)

    def inside(self, name: str) -> Frames:
        """Return the frames of a nested model.

        Raises:
            FrameError: there is no nested model with this name.
        """
        frames = self._inner.get(name)
        if frames is None:
            model = self.elements_by_name.get(name)
            if not isinstance(model, Model):
                raise FrameError(name)
            frames = self._inner[name] = Frames(model)
        return frames

    def pose(self, name: str) -> Transform:
        """Return the pose of a frame in the model or world.

        Raises:
            FrameError: the frame does not exist, or its pose depends on itself.
        """
        pending: dict[str, None] = {}  # The chain from the requested frame to one with a computed pose.
        while name not in self._roots and name not in self._poses:
            if name in pending:
                pending_names = list(pending)
                raise FrameError(name, [*pending_names[pending_names.index(name) :], name])
            pending[name] = None
            name = self._base(name)
        pose = self._poses.get(name, IDENTITY)
        for pending_name in reversed(pending):
            pose = self._poses[pending_name] = compose(pose, self._in_base(pending_name))
        return pose

    def placed(self, pose: RawPose, default_frame: str = "") -> Transform:
        """Return a written pose as a transform in the model or world.

        Args:
            pose: the pose as written.
            default_frame: the frame for a pose that does not name one; empty for the model or world.

        Raises:
            FrameError: as for `pose`.
        """
        return compose(self.pose(pose.relative_to or default_frame), transform_of(pose.pose))

    def in_link(self, pose: RawPose, link: str) -> Transform:
        """Return the pose of a part of a link in the frame of the link.

        As in libsdformat, a pose relative to a frame that does not exist is treated as relative to the link; `check`
        reports the missing frame.

        Raises:
            FrameError: the link cannot be placed.
        """
        if not pose.relative_to or pose.relative_to not in self:
            return transform_of(pose.pose)
        return compose(invert(self.pose(link)), self.placed(pose))

    def axis(self, joint: Joint, axis: Axis) -> Vector3:
        """Return the direction of an axis in the frame of its joint.

        Raises:
            FrameError: as for `pose`.
        """
        if not axis.expressed_in:
            return axis.xyz
        owner_direction = rotate(self.pose(axis.expressed_in)[3:], axis.xyz)
        return rotate(invert(self.pose(joint.name))[3:], owner_direction)

    def link(self, name: str) -> str:
        """Return the name of the link that a frame is attached to.

        The name is relative to this model or world. For a frame that is fixed to the world, return ``world``.

        Raises:
            FrameError: the frame does not exist, its attachment leads back to itself, or the model has no link.
        """
        visited_names: dict[str, None] = {}
        while True:
            if name in visited_names:
                raise FrameError(name, [*list(visited_names)[list(visited_names).index(name) :], name])
            visited_names[name] = None
            if name == WORLD or (name == "" and isinstance(self.owner, World)):
                return WORLD
            if name in ("", MODEL):
                return self._canonical_link()
            element = self.elements_by_name.get(name)
            head, colon, tail = name.partition(SEPARATOR)
            if element is None and colon:
                return f"{head}{SEPARATOR}{self.inside(head).link(tail)}"
            if element is None:
                raise FrameError(name)
            if isinstance(element, Link):
                return name
            if isinstance(element, Model):
                return f"{name}{SEPARATOR}{self.inside(name).link(MODEL)}"
            name = element.attached_to if isinstance(element, Frame) else element.child

    def _canonical_link(self) -> str:
        """Return the name of the canonical link: the declared link, or else the first link.

        Raises:
            FrameError: the model has no link.
        """
        model = self.owner
        assert isinstance(model, Model)
        if model.canonical_link:
            return self.link(model.canonical_link)
        if model.links:
            return model.links[0].name
        for nested_model in model.models:
            return f"{nested_model.name}{SEPARATOR}{self.inside(nested_model.name).link(MODEL)}"
        raise FrameError(MODEL)

    def _base(self, name: str) -> str:
        """Return the name of the reference frame of a frame's pose.

        Raises:
            FrameError: the frame does not exist.
        """
        element = self.elements_by_name.get(name)
        head, colon, _ = name.partition(SEPARATOR)
        if element is None and colon:
            return head
        if element is None:
            raise FrameError(name)
        default_frame = (
            element.attached_to if isinstance(element, Frame) else element.child if isinstance(element, Joint) else ""
        )
        return element.pose.relative_to or default_frame

    def _in_base(self, name: str) -> Transform:
        """Return the pose of a frame in the frame that `_base` returns."""
        element = self.elements_by_name.get(name)
        if element is None:
            head, _, tail = name.partition(SEPARATOR)
            return self.inside(head).pose(tail)
        pose = transform_of(element.pose.pose)
        if isinstance(element, Model) and element.placement_frame:
            return compose(pose, invert(self.inside(name).pose(element.placement_frame)))
        return pose


@dataclass(frozen=True, slots=True)
class PlacedLink:
    """A link with its pose in the world.

    Attributes:
        name: the name with the enclosing models: ``robot::arm::tip``.
        link: the link as the file describes it.
        model: the model that directly contains the link.
        frames: the frames of `model`.
        pose: the pose of the link's frame in the world.
        static: whether `model`, or a model that encloses it, never moves.
    """

    name: str
    link: Link
    model: Model
    frames: Frames
    pose: Transform
    static: bool


def placed_links(world: World) -> Iterator[PlacedLink]:
    """Yield all links of a world with their poses, in document order.

    Raises:
        FrameError: a link cannot be placed.
    """
    frames = Frames(world)
    for model in world.models:
        yield from place_links(model, frames.inside(model.name), frames.pose(model.name), model.name)


def place_links(
    model: Model, frames: Frames, pose: Transform, name: str, *, static: bool = False
) -> Iterator[PlacedLink]:
    """Yield all links of a model and its nested models, with their poses.

    Args:
        model: the model, with its includes resolved.
        frames: the frames of the model.
        pose: the pose of the model's frame in the world.
        name: the name of the model in the world.
        static: whether an enclosing model never moves.

    Raises:
        FrameError: a link cannot be placed.
    """
    static = static or model.static
    for link in model.links:
        link_pose = compose(pose, frames.pose(link.name))
        yield PlacedLink(f"{name}{SEPARATOR}{link.name}", link, model, frames, link_pose, static)
    for nested_model in model.models:
        link_pose = compose(pose, frames.pose(nested_model.name))
        path = f"{name}{SEPARATOR}{nested_model.name}"
        yield from place_links(nested_model, frames.inside(nested_model.name), link_pose, path, static=static)


def transform_of(pose: Pose) -> Transform:
    """Return a pose as x, y, z in m and a quaternion x, y, z, w."""
    return (*pose.xyz, *pose_quaternion(pose))


def pose_of(transform: Transform) -> Pose:
    """Return a transform as a pose with roll, pitch and yaw.

    If these angles do not represent the rotation exactly, the pose also contains the quaternion.
    """
    rotation = transform[3:]
    rpy = rpy_from_quaternion(rotation)
    difference = quaternion_multiply(quaternion_from_rpy(rpy), quaternion_inverse(rotation))
    is_exact = max(map(abs, difference[:3])) < _ANGLE_TOLERANCE
    return Pose(transform[:3], rpy, None if is_exact else rotation)
