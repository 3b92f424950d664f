"""Joints of a world that connect links of its models (SDF 1.7 and later).

If a link of a model can become the child of the other link, the joint moves the model as the model's own joints move
its links. If both links already have parents, the joint closes a loop.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from linkwright.geometry.single import IDENTITY, Transform
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.sdf.worlds import World
from linkwright.simulation.scene.structure import (
    KinematicTrees,
    PlacedJoint,
    TreeLink,
    build_kinematic_trees,
    is_below,
    place_joint,
)


@dataclass(frozen=True, slots=True)
class Connections:
    """The joints of a world that connect its models.

    Attributes:
        attaching: joints that attach models to their parents, by the names of the child links.
        loops: joints between links that already have a parent.
        poses: the poses of the connected models' frames in the world.
    """

    attaching: dict[str, PlacedJoint]
    loops: tuple[PlacedJoint, ...]
    poses: dict[str, Transform]

    def connect(
        self, structure: KinematicTrees, name: str, pose: Transform, earlier_models: Iterable[str]
    ) -> ConnectedModel:
        """Return a model with the joints that connect it to earlier models.

        Args:
            structure: the model's own links and joints.
            name: the model's name in the world.
            pose: the pose of the model's frame in the world; a model that is not at its pose in `poses` is not
                connected.
            earlier_models: the names of the earlier models.
        """
        if self.poses.get(name) != pose:
            return ConnectedModel(structure, (), frozenset())
        available_models = {WORLD, name, *earlier_models}
        joints = (*self.attaching.values(), *self.loops)
        own_joints = [
            joint for joint in joints if name in _get_model_names(joint) and _get_model_names(joint) <= available_models
        ]
        attaching_joints = {
            joint.child: joint
            for joint in own_joints
            if self.attaching.get(joint.child) is joint and get_model_name(joint.child) == name
        }
        links = tuple(
            TreeLink(tree_link.link, attaching_joints.get(tree_link.link.name, tree_link.joint))
            for tree_link in structure.links
        )
        loops = tuple(joint for joint in own_joints if attaching_joints.get(joint.child) is not joint)
        attached_to = frozenset(model for joint in own_joints for model in _get_model_names(joint)) - {WORLD, name}
        return ConnectedModel(replace(structure, links=links), loops, attached_to)

    def sort_by_attachment(self, names: Sequence[str]) -> list[str]:
        """Return model names in the given order, but each after the models that it is attached to."""
        parents: dict[str, list[str]] = {}
        for joint in self.attaching.values():
            parents.setdefault(get_model_name(joint.child), []).append(get_model_name(joint.parent))
        selected_names = set(names)
        ordered: dict[str, None] = {}
        visited: set[str] = set()  # Joints may connect the models in a cycle.
        pending = list(reversed(names))
        while pending:
            name = pending[-1]
            missing_parents = (
                []
                if name in visited
                else [parent for parent in parents.get(name, ()) if parent in selected_names and parent not in visited]
            )
            visited.add(name)
            if missing_parents:
                pending += missing_parents
            else:
                ordered[pending.pop()] = None
        return list(ordered)


@dataclass(frozen=True, slots=True)
class ConnectedModel:
    """A model with the joints that connect it to other models.

    Attributes:
        structure: the links, each attached by a joint of the model or of the world.
        loops: joints of the world that close loops with links of other models, or within the model.
        attached_to: the names of the models to which joints of the world connect this model.
    """

    structure: KinematicTrees
    loops: tuple[PlacedJoint, ...]
    attached_to: frozenset[str]


def find_connections(world: World) -> Connections:
    """Return the joints of a world, except joints whose links are missing or never move.

    Args:
        world: the world, with its includes resolved and as it was saved.
    """
    if not world.joints:
        return Connections({}, (), {})
    frames = Frames(world)
    placed_joints = _place_joints(world, frames)
    models = {model for joint in placed_joints for model in _get_model_names(joint)}
    poses: dict[str, Transform] = {}
    tree_links: dict[str, TreeLink] = {}
    for model in world.models:
        if model.name in models - poses.keys():
            try:
                structure = build_kinematic_trees(model, model.name, frames.pose(model.name))
            except FrameError:
                continue  # The scene reports this model.
            poses[model.name] = frames.pose(model.name)
            tree_links |= {link.link.name: link for link in structure.links}

    joints_by_child = {name: tree_link.joint for name, tree_link in tree_links.items() if tree_link.joint is not None}
    moving_links = {name for name, tree_link in tree_links.items() if not tree_link.link.static}
    free_links = {name for name in moving_links - joints_by_child.keys() if not tree_links[name].link.link.kinematic}
    attaching: dict[str, PlacedJoint] = {}
    loops: list[PlacedJoint] = []
    for joint in placed_joints:
        known_links = tree_links.keys() | {WORLD}
        if not {joint.parent, joint.child} <= known_links or not {joint.parent, joint.child} & moving_links:
            continue
        can_attach = len(_get_model_names(joint)) > 1 and joint.joint.type != "gearbox"  # A model orders its own links.
        candidates = (joint, _reverse_joint(joint)) if can_attach else ()
        suitable_joints = (
            candidate
            for candidate in candidates
            if candidate.child in free_links and not is_below(joints_by_child, candidate.child, candidate.parent)
        )
        attaching_joint = next(suitable_joints, None)
        if attaching_joint is None:
            loops.append(joint)
        else:
            free_links.discard(attaching_joint.child)
            attaching[attaching_joint.child] = joints_by_child[attaching_joint.child] = attaching_joint
    return Connections(attaching, tuple(loops), poses)


def get_model_name(link: str) -> str:
    """Return the top-level model of a link or joint name, or ``world`` for the world itself."""
    return link.partition(SEPARATOR)[0]


def _get_model_names(joint: PlacedJoint) -> set[str]:
    return {get_model_name(joint.parent), get_model_name(joint.child)}


def _place_joints(world: World, frames: Frames) -> list[PlacedJoint]:
    joints_by_name: dict[str, PlacedJoint] = {}
    for joint in world.joints:
        try:
            joint_at_pose = place_joint(joint, frames, IDENTITY, "")
        except FrameError:
            continue  # `check` reports this joint.
        if joint_at_pose.name not in joints_by_name and joint_at_pose.parent != joint_at_pose.child:
            joints_by_name[joint_at_pose.name] = joint_at_pose
    return list(joints_by_name.values())


def _reverse_joint(joint: PlacedJoint) -> PlacedJoint:
    """Return a joint with its parent and child exchanged.

    Positions keep their signs.
    """
    axes = tuple((axis, (-x, -y, -z)) for axis, (x, y, z) in reversed(joint.axes))
    return replace(joint, parent=joint.child, child=joint.parent, axes=axes)
