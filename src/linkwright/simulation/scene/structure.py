"""A model as the kinematic trees that MuJoCo requires, and the joints that close loops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from linkwright.geometry.single import Transform, Vector3, compose
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, links_of
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR, WORLD

_LEAST = 1e-9
"""An axis that is no longer points nowhere."""


@dataclass(frozen=True, slots=True)
class PlacedJoint:
    """A joint of a model, or a joint of a world between two models.

    Attributes:
        name: the name with the enclosing models, ``robot::arm::elbow``; a joint of the world has only its own name.
        joint: the parsed joint.
        parent: the parent link, named as in `PlacedLink`; ``world`` for the world.
        child: the link that the joint moves.
        pose: the pose of the joint's frame in the world.
        axes: the axes of the joint, with the direction of each in the frame of the joint.
    """

    name: str
    joint: Joint
    parent: str
    child: str
    pose: Transform
    axes: tuple[tuple[Axis, Vector3], ...]


@dataclass(frozen=True, slots=True)
class HeldLink:
    """A link, and the joint that connects it to its parent; the joint of a root is None."""

    link: PlacedLink
    joint: PlacedJoint | None


@dataclass(frozen=True, slots=True)
class Structure:
    """A model as kinematic trees.

    Attributes:
        links: all links, each after its parent.
        loops: joints between links that already have parents.
    """

    links: tuple[HeldLink, ...]
    loops: tuple[PlacedJoint, ...]


def structure_of(model: Model, name: str, pose: Transform) -> Structure:
    """Return the kinematic trees of a model, without joints whose links are missing.

    Args:
        model: the model, with its includes resolved.
        name: the name of the model in the world.
        pose: the pose of the model's frame in the world.

    Raises:
        FrameError: a link cannot be placed.
    """
    frames = Frames(model)
    links = {placed_link.name: placed_link for placed_link in links_of(model, frames, pose, name)}
    joints: dict[str, PlacedJoint] = {}
    for owner, inner, place, path in _models(model, frames, pose, name):
        for joint in owner.joints:
            try:
                placed = placed_joint(joint, inner, place, path)
            except FrameError:
                continue  # `check` reports this joint.
            ends_are_there = placed.child in links and (placed.parent in links or placed.parent == WORLD)
            if ends_are_there and placed.parent != placed.child:
                while placed.name in joints:  # MuJoCo requires unique names; `check` reports duplicates
                    placed = replace(placed, name=f"{placed.name}~")
                joints[placed.name] = placed
    return _trees(links, joints.values())


def _models(model: Model, frames: Frames, pose: Transform, path: str) -> Iterator[tuple[Model, Frames, Transform, str]]:
    """Yield a model and its nested models, each with its frames, its pose in the world and its name."""
    yield model, frames, pose, path
    for inner in model.models:
        place = compose(pose, frames.pose(inner.name))
        yield from _models(inner, frames.inside(inner.name), place, f"{path}{SEPARATOR}{inner.name}")


def placed_joint(joint: Joint, frames: Frames, pose: Transform, path: str) -> PlacedJoint:
    """Return a joint with its links, its pose and its axes.

    Args:
        joint: the parsed joint.
        frames: the frames of the enclosing model or world.
        pose: the pose in the world of the origin of `frames`.
        path: the name of the model, with its enclosing models; empty for the world.

    Raises:
        FrameError: the pose of the joint, or one of its links, refers to a frame that does not exist.
    """
    ends = [frames.link(end) for end in (joint.parent, joint.child)]
    parent, child = (end if end == WORLD else _within(path, end) for end in ends)
    given = [axis for axis in (joint.axis, joint.axis2) if axis is not None]
    axes = tuple((axis, _direction(frames.axis(joint, axis))) for axis in given)
    name = _within(path, joint.name)
    return PlacedJoint(name, joint, parent, child, compose(pose, frames.pose(joint.name)), axes)


def _within(path: str, name: str) -> str:
    return f"{path}{SEPARATOR}{name}" if path else name


def _direction(axis: Vector3) -> Vector3:
    """Return the direction of an axis; the z axis, as in libsdformat, if the direction is zero.

    `check` reports a zero direction.
    """
    return axis if sum(value * value for value in axis) > _LEAST**2 else (0.0, 0.0, 1.0)


def _trees(links: dict[str, PlacedLink], joints: Iterable[PlacedJoint]) -> Structure:
    holding: dict[str, PlacedJoint] = {}
    loops: list[PlacedJoint] = []
    held: dict[str, list[str]] = {}
    for joint in joints:
        is_taken = joint.child in holding or is_below(holding, joint.child, joint.parent)
        if is_taken or joint.joint.type == "gearbox":  # A gearbox couples joints and is not a parent joint.
            loops.append(joint)
        else:
            holding[joint.child] = joint
            held.setdefault(joint.parent, []).append(joint.child)

    ordered = [name for name in links if name not in holding or holding[name].parent == WORLD]
    for name in ordered:  # the list grows during the iteration
        ordered += held.get(name, ())
    return Structure(tuple(HeldLink(links[name], holding.get(name)) for name in ordered), tuple(loops))


def is_below(holding: Mapping[str, PlacedJoint], link: str, other: str) -> bool:
    """Return whether `other` is `link` or one of its descendants.

    `holding` maps child links to their joints.
    """
    while other != link:
        if other not in holding:
            return False
        other = holding[other].parent
    return True
