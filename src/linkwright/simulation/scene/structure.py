"""The kinematic trees of a model, as MuJoCo requires, and the joints that close loops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf

from linkwright.geometry.single import Transform, Vector3, compose
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, place_links
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.simulation.scene.breaking import is_breakable

_MIN_AXIS_LENGTH = 1e-9
"""The length up to which an axis counts as having no direction."""


@dataclass(frozen=True, slots=True)
class PlacedJoint:
    """A joint of a model, or a joint of a world between two models.

    Attributes:
        name: the name with the enclosing models, such as ``robot::arm::elbow``; a joint of the world has no prefix.
        joint: the parsed joint.
        parent: the parent link, named as in `PlacedLink`; ``world`` for the world.
        child: the link that the joint moves.
        pose: the pose of the joint's frame in the world.
        axes: the axes of the joint, each with its direction in the frame of the joint.
    """

    name: str
    joint: Joint
    parent: str
    child: str
    pose: Transform
    axes: tuple[tuple[Axis, Vector3], ...]

    @property
    def is_continuous(self) -> bool:
        """Whether the joint turns without limits. In SDF, a URDF's continuous joint is revolute."""
        limit = self.axes[0][0].limit if self.axes else None
        return self.joint.type == "continuous" or (
            self.joint.type == "revolute" and limit is not None and limit.lower == -inf and limit.upper == inf
        )


@dataclass(frozen=True, slots=True)
class TreeLink:
    """A link of a kinematic tree, and the joint that connects it to its parent.

    The joint is None for the root of a tree.
    """

    link: PlacedLink
    joint: PlacedJoint | None


@dataclass(frozen=True, slots=True)
class KinematicTrees:
    """A model as kinematic trees.

    Attributes:
        links: all links, each after its parent.
        loops: the joints that would give a link a second parent or close a cycle, the gearboxes and the joints that can
            break.
    """

    links: tuple[TreeLink, ...]
    loops: tuple[PlacedJoint, ...]


def build_kinematic_trees(model: Model, name: str, pose: Transform) -> KinematicTrees:
    """Return the kinematic trees of a model.

    Joints with missing links are ignored.

    Args:
        model: the model, with its includes resolved.
        name: the name of the model in the world.
        pose: the pose of the model's frame in the world.

    Raises:
        FrameError: the pose of a link is not defined.
    """
    frames = Frames(model)
    links = {placed_link.name: placed_link for placed_link in place_links(model, frames, pose, name)}
    joints: dict[str, PlacedJoint] = {}
    for owner, owner_frames, owner_pose, path in _find_nested_models(model, frames, pose, name):
        for joint in owner.joints:
            try:
                candidate = place_joint(joint, owner_frames, owner_pose, path)
            except FrameError:
                continue  # `linkwright check` reports this joint.
            has_links = candidate.child in links and (candidate.parent in links or candidate.parent == WORLD)
            if has_links and candidate.parent != candidate.child:
                while candidate.name in joints:  # MuJoCo requires unique names; `linkwright check` reports duplicates
                    candidate = replace(candidate, name=f"{candidate.name}~")
                joints[candidate.name] = candidate
    return _build_trees(links, joints.values())


def _find_nested_models(
    model: Model, frames: Frames, pose: Transform, path: str
) -> Iterator[tuple[Model, Frames, Transform, str]]:
    """Yield a model and its nested models, with their frames, poses and names.

    Poses are in the world, and names are qualified.
    """
    yield model, frames, pose, path
    for nested_model in model.models:
        nested_pose = compose(pose, frames.pose(nested_model.name))
        yield from _find_nested_models(
            nested_model, frames.inside(nested_model.name), nested_pose, f"{path}{SEPARATOR}{nested_model.name}"
        )


def place_joint(joint: Joint, frames: Frames, pose: Transform, path: str) -> PlacedJoint:
    """Return a joint with its links, its pose and its axes.

    Args:
        joint: the parsed joint.
        frames: the frames of the enclosing model or world.
        pose: the pose in the world of the model or world to which `frames` belongs.
        path: the name of the model with its enclosing models; empty for the world.

    Raises:
        FrameError: the pose of the joint, or one of its links, refers to a frame that does not exist.
    """
    link_names = [frames.link(end) for end in (joint.parent, joint.child)]
    parent, child = (link_name if link_name == WORLD else _qualify_name(path, link_name) for link_name in link_names)
    declared_axes = [axis for axis in (joint.axis, joint.axis2) if axis is not None]
    axes = tuple((axis, _nonzero_direction(frames.axis(joint, axis))) for axis in declared_axes)
    name = _qualify_name(path, joint.name)
    return PlacedJoint(name, joint, parent, child, compose(pose, frames.pose(joint.name)), axes)


def _qualify_name(path: str, name: str) -> str:
    return f"{path}{SEPARATOR}{name}" if path else name


def _nonzero_direction(axis: Vector3) -> Vector3:
    """Return the direction of an axis, or the z axis instead of zero, as in libsdformat.

    `linkwright check` reports a direction that is zero.
    """
    return axis if sum(value * value for value in axis) > _MIN_AXIS_LENGTH**2 else (0.0, 0.0, 1.0)


def _build_trees(links: dict[str, PlacedLink], joints: Iterable[PlacedJoint]) -> KinematicTrees:
    parent_joints: dict[str, PlacedJoint] = {}
    loops: list[PlacedJoint] = []
    child_links: dict[str, list[str]] = {}
    for joint in joints:
        closes_loop = joint.child in parent_joints or is_below(parent_joints, joint.child, joint.parent)
        can_break = not links[joint.child].static and is_breakable(joint.joint)
        if closes_loop or can_break or joint.joint.type == "gearbox":  # A gearbox couples joints.
            loops.append(joint)
        else:
            parent_joints[joint.child] = joint
            child_links.setdefault(joint.parent, []).append(joint.child)

    ordered = [name for name in links if name not in parent_joints or parent_joints[name].parent == WORLD]
    for name in ordered:  # The list grows during the iteration.
        ordered += child_links.get(name, ())
    return KinematicTrees(tuple(TreeLink(links[name], parent_joints.get(name)) for name in ordered), tuple(loops))


def is_below(parent_joints: Mapping[str, PlacedJoint], link: str, descendant: str) -> bool:
    """Return whether `descendant` is `link` or one of its descendants.

    `parent_joints` maps each child link to the joint that moves it.
    """
    while descendant != link:
        if descendant not in parent_joints:
            return False
        descendant = parent_joints[descendant].parent
    return True
