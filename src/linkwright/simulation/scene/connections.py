"""Joints of a world, which connect links of its models (SDF 1.7 and later).

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
from linkwright.simulation.scene.structure import PlacedJoint, Structure, TreeLink, is_below, placed_joint, structure_of


@dataclass(frozen=True, slots=True)
class Connections:
    """The joints of a world that connect its models.

    Attributes:
        hanging: joints that attach models to their parents, by the names of the child links.
        loops: joints between links that already have a parent.
        poses: the poses of the connected models' frames in the world.
    """

    hanging: dict[str, PlacedJoint]
    loops: tuple[PlacedJoint, ...]
    poses: dict[str, Transform]

    def of(self, structure: Structure, name: str, pose: Transform, others: Iterable[str]) -> Connected:
        """Return a model with the joints that connect it to earlier models.

        Args:
            structure: the model's own links and joints.
            name: the model's name in the world.
            pose: the pose of the model's frame in the world; a model that is not at its pose in `poses` is not
                connected.
            others: the names of the earlier models.
        """
        if self.poses.get(name) != pose:
            return Connected(structure, (), frozenset())
        there = {WORLD, name, *others}
        joints = (*self.hanging.values(), *self.loops)
        own = [joint for joint in joints if name in _models(joint) and _models(joint) <= there]
        hung = {
            joint.child: joint
            for joint in own
            if self.hanging.get(joint.child) is joint and model_of(joint.child) == name
        }
        links = tuple(TreeLink(held.link, hung.get(held.link.name, held.joint)) for held in structure.links)
        loops = tuple(joint for joint in own if hung.get(joint.child) is not joint)
        hangs_on = frozenset(model for joint in own for model in _models(joint)) - {WORLD, name}
        return Connected(replace(structure, links=links), loops, hangs_on)

    def in_order(self, names: Sequence[str]) -> list[str]:
        """Return model names in the given order, but each after the models to which it is attached."""
        above: dict[str, list[str]] = {}
        for joint in self.hanging.values():
            above.setdefault(model_of(joint.child), []).append(model_of(joint.parent))
        wanted = set(names)
        ordered: dict[str, None] = {}
        begun: set[str] = set()  # joints may connect the models in a cycle
        pending = list(reversed(names))
        while pending:
            name = pending[-1]
            missing = (
                [] if name in begun else [each for each in above.get(name, ()) if each in wanted and each not in begun]
            )
            begun.add(name)
            if missing:
                pending += missing
            else:
                ordered[pending.pop()] = None
        return list(ordered)


@dataclass(frozen=True, slots=True)
class Connected:
    """A model with the joints that connect it to other models.

    Attributes:
        structure: the links, attached by their own joints or by joints of the world.
        loops: joints of the world that close loops with links of other models, or within the model.
        hangs_on: names of the models to which these joints connect the model.
    """

    structure: Structure
    loops: tuple[PlacedJoint, ...]
    hangs_on: frozenset[str]


def connections_of(world: World) -> Connections:
    """Return the joints of a world, except joints whose links are missing or never move.

    Args:
        world: the world, with its includes resolved and as it was saved.
    """
    if not world.joints:
        return Connections({}, (), {})
    frames = Frames(world)
    placed = _placed(world, frames)
    models = {model for joint in placed for model in _models(joint)}
    poses: dict[str, Transform] = {}
    held: dict[str, TreeLink] = {}
    for model in world.models:
        if model.name in models - poses.keys():
            try:
                structure = structure_of(model, model.name, frames.pose(model.name))
            except FrameError:
                continue  # The scene reports this model.
            poses[model.name] = frames.pose(model.name)
            held |= {link.link.name: link for link in structure.links}

    holding = {name: each.joint for name, each in held.items() if each.joint is not None}
    moving = {name for name, each in held.items() if not each.link.static}
    free = {name for name in moving - holding.keys() if not held[name].link.link.kinematic}
    hanging: dict[str, PlacedJoint] = {}
    loops: list[PlacedJoint] = []
    for joint in placed:
        there = held.keys() | {WORLD}
        if not {joint.parent, joint.child} <= there or not {joint.parent, joint.child} & moving:
            continue
        can_hang = len(_models(joint)) > 1 and joint.joint.type != "gearbox"  # A model orders its own links.
        ways = (joint, _reversed_joint(joint)) if can_hang else ()
        fit = (way for way in ways if way.child in free and not is_below(holding, way.child, way.parent))
        hung = next(fit, None)
        if hung is None:
            loops.append(joint)
        else:
            free.discard(hung.child)
            hanging[hung.child] = holding[hung.child] = hung
    return Connections(hanging, tuple(loops), poses)


def model_of(link: str) -> str:
    """Return the top-level model of a link or joint name; ``world`` for the world itself."""
    return link.partition(SEPARATOR)[0]


def _models(joint: PlacedJoint) -> set[str]:
    return {model_of(joint.parent), model_of(joint.child)}


def _placed(world: World, frames: Frames) -> list[PlacedJoint]:
    found: dict[str, PlacedJoint] = {}
    for joint in world.joints:
        try:
            placed = placed_joint(joint, frames, IDENTITY, "")
        except FrameError:
            continue  # `check` reports this joint.
        if placed.name not in found and placed.parent != placed.child:
            found[placed.name] = placed
    return list(found.values())


def _reversed_joint(joint: PlacedJoint) -> PlacedJoint:
    """Return a joint with its parent and child exchanged; positions keep their signs."""
    axes = tuple((axis, (-x, -y, -z)) for axis, (x, y, z) in reversed(joint.axes))
    return replace(joint, parent=joint.child, child=joint.parent, axes=axes)
