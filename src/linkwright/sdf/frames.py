"""Computes poses of frames in models and worlds, by SDF's "pose frame semantics".

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

_NO_ANGLE = 1e-12
"""Half an angle in radians that is none."""


class FrameError(Exception):
    """Raised when a pose cannot be computed.

    Attributes:
        name: the frame that does not exist, or one frame of a cycle.
        circle: the frames of the cycle, in order; empty for a frame that does not exist.
    """

    def __init__(self, name: str, circle: Sequence[str] = ()) -> None:
        super().__init__(name)
        self.name = name
        self.circle = tuple(circle)


class Frames:
    """The frames of a model or world, by their names.

    Args:
        owner: the model or world, with its includes resolved.
    """

    def __init__(self, owner: Owner) -> None:
        self.owner = owner
        named: dict[str, Framed] = {}
        links = owner.links if isinstance(owner, Model) else ()
        parts: tuple[Framed, ...] = (*links, *owner.frames, *owner.joints, *owner.models)
        for part in parts:
            named.setdefault(part.name, part)
        self.named = named
        self._roots = frozenset({"", MODEL} if isinstance(owner, Model) else {"", WORLD})
        self._inner: dict[str, Frames] = {}
        self._poses: dict[str, Transform] = {}

    def __contains__(self, name: str) -> bool:
        head, colon, tail = name.partition(SEPARATOR)
        if not colon or name in self.named:  # Link names in old files contain '::'.
            return name in self._roots or name in self.named
        return isinstance(self.named.get(head), Model) and tail in self.inside(head)

    def inside(self, name: str) -> Frames:
        """Return the frames of a nested model.

        Raises:
            FrameError: there is no nested model with this name.
        """
        frames = self._inner.get(name)
        if frames is None:
            model = self.named.get(name)
            if not isinstance(model, Model):
                raise FrameError(name)
            frames = self._inner[name] = Frames(model)
        return frames

    def pose(self, name: str) -> Transform:
        """Return the pose of a frame in the model or world.

        Raises:
            FrameError: the frame does not exist, or is indirectly defined relative to itself.
        """
        pending: dict[str, None] = {}  # frames from the requested one to one with a known pose
        while name not in self._roots and name not in self._poses:
            if name in pending:
                circle = list(pending)
                raise FrameError(name, [*circle[circle.index(name) :], name])
            pending[name] = None
            name = self._base(name)
        found = self._poses.get(name, IDENTITY)
        for item in reversed(pending):
            found = self._poses[item] = compose(found, self._in_base(item))
        return found

    def placed(self, pose: RawPose, absent: str = "") -> Transform:
        """Return a written pose as a transform in the model or world.

        Args:
            pose: the pose as written.
            absent: the frame to which a pose is relative that does not name a frame; the model or world if empty.

        Raises:
            FrameError: as for `pose`.
        """
        return compose(self.pose(pose.relative_to or absent), transform_of(pose.pose))

    def in_link(self, pose: RawPose, link: str) -> Transform:
        """Return the pose of a part of a link in the frame of the link.

        As in libsdformat, a pose relative to an unknown frame is treated as relative to the link; `check` reports it.

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
        in_owner = rotate(self.pose(axis.expressed_in)[3:], axis.xyz)
        return rotate(invert(self.pose(joint.name))[3:], in_owner)

    def link(self, name: str) -> str:
        """Return the name of the link to which a frame is attached.

        The name is relative to this model or world; ``world`` is returned for a frame fixed to the world.

        Raises:
            FrameError: the frame does not exist, is indirectly attached to itself, or the model has no link.
        """
        seen: dict[str, None] = {}
        while True:
            if name in seen:
                raise FrameError(name, [*list(seen)[list(seen).index(name) :], name])
            seen[name] = None
            if name == WORLD or (name == "" and isinstance(self.owner, World)):
                return WORLD
            if name in ("", MODEL):
                return self._canonical_link()
            found = self.named.get(name)
            head, colon, tail = name.partition(SEPARATOR)
            if found is None and colon:
                return f"{head}{SEPARATOR}{self.inside(head).link(tail)}"
            if found is None:
                raise FrameError(name)
            if isinstance(found, Link):
                return name
            if isinstance(found, Model):
                return f"{name}{SEPARATOR}{self.inside(name).link(MODEL)}"
            name = found.attached_to if isinstance(found, Frame) else found.child

    def _canonical_link(self) -> str:
        """Return the name of the canonical link: the link that the model declares, or else its first link.

        Raises:
            FrameError: the model has no link.
        """
        model = self.owner
        assert isinstance(model, Model)
        if model.canonical_link:
            return self.link(model.canonical_link)
        if model.links:
            return model.links[0].name
        for inner in model.models:
            return f"{inner.name}{SEPARATOR}{self.inside(inner.name).link(MODEL)}"
        raise FrameError(MODEL)

    def _base(self, name: str) -> str:
        """Return the name of the frame to which the pose of a frame is relative.

        Raises:
            FrameError: the frame does not exist.
        """
        found = self.named.get(name)
        head, colon, _ = name.partition(SEPARATOR)
        if found is None and colon:
            return head
        if found is None:
            raise FrameError(name)
        absent = found.attached_to if isinstance(found, Frame) else found.child if isinstance(found, Joint) else ""
        return found.pose.relative_to or absent

    def _in_base(self, name: str) -> Transform:
        """Return the pose of a frame in the frame that `_base` returns."""
        found = self.named.get(name)
        if found is None:
            head, _, tail = name.partition(SEPARATOR)
            return self.inside(head).pose(tail)
        pose = transform_of(found.pose.pose)
        if isinstance(found, Model) and found.placement_frame:
            return compose(pose, invert(self.inside(name).pose(found.placement_frame)))
        return pose


@dataclass(frozen=True, slots=True)
class PlacedLink:
    """A link with its pose in the world.

    Attributes:
        name: the name with the enclosing models: ``robot::arm::tip``.
        link: the parsed link.
        model: the model that directly contains the link.
        frames: the frames of that model.
        pose: the pose of the link's frame in the world.
        static: whether that model, or a model that encloses it, never moves.
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
        yield from links_of(model, frames.inside(model.name), frames.pose(model.name), model.name)


def links_of(model: Model, frames: Frames, pose: Transform, name: str, *, static: bool = False) -> Iterator[PlacedLink]:
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
        place = compose(pose, frames.pose(link.name))
        yield PlacedLink(f"{name}{SEPARATOR}{link.name}", link, model, frames, place, static)
    for inner in model.models:
        place = compose(pose, frames.pose(inner.name))
        path = f"{name}{SEPARATOR}{inner.name}"
        yield from links_of(inner, frames.inside(inner.name), place, path, static=static)


def transform_of(pose: Pose) -> Transform:
    """Return a pose as a transform."""
    return (*pose.xyz, *pose_quaternion(pose))


def pose_of(transform: Transform) -> Pose:
    """Return a transform as a pose with angles.

    The pose also has the quaternion if the angles do not represent the rotation exactly.
    """
    rotation = transform[3:]
    rpy = rpy_from_quaternion(rotation)
    difference = quaternion_multiply(quaternion_from_rpy(rpy), quaternion_inverse(rotation))
    exact = max(map(abs, difference[:3])) < _NO_ANGLE
    return Pose(transform[:3], rpy, None if exact else rotation)
