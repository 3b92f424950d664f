"""The parts of a model that have poses: nested models, links, and objects that are fixed to links."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum, auto
from functools import partial

from linkwright.geometry.single import Transform, compose, invert
from linkwright.sdf.frames import Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.simulation import Simulation

Pose = Callable[[], Transform]


class PartKind(Enum):
    """The kind of a part."""

    MODEL = auto()
    NESTED_MODEL = auto()
    LINK = auto()
    VISUAL = auto()
    COLLISION = auto()
    SENSOR = auto()


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a model that has a pose.

    Attributes:
        kind: the kind of the part.
        name: the name with the models and the link that contain the part, such as ``robot::arm::link``.
        parent: the name of the model, link or world in whose frame the pose is expressed.
        pose: returns the current pose.
    """

    kind: PartKind
    name: str
    parent: str
    pose: Pose


def parts_of(simulation: Simulation, model: Model, path: str) -> Iterator[Part]:
    """Yield the parts of a model of a simulation, each model and link before its own parts.

    Args:
        simulation: the simulation that contains the model.
        model: the model, with its includes resolved.
        path: the model's name in the world; a nested model such as ``robot::arm`` does not yield itself.
    """
    place = _frame_of(simulation, model, path)
    if SEPARATOR not in path:
        yield Part(PartKind.MODEL, path, simulation.world.name, place)
    yield from _parts(simulation, model, path, Frames(model), place)


def _frame_of(simulation: Simulation, model: Model, path: str) -> Pose:
    """Return a function that returns the current pose of a model's frame in the world."""
    top, _, inside = path.partition(SEPARATOR)
    whole = simulation.scene.models[top]
    if not whole.structure.links:  # no part of the model moves
        return partial(_same, whole.pose)
    if not inside or not model.links:
        return lambda: simulation.model_pose(top)
    first = model.links[0].name
    return _pose_on_link(simulation, f"{path}{SEPARATOR}{first}", Frames(model).pose(first))


def _pose_on_link(simulation: Simulation, link: str, place: Transform) -> Pose:
    """Return a function that returns the current pose in the world of a frame that is fixed to a link.

    `place` is the pose of the link in this frame.
    """
    back = invert(place)
    return lambda: compose(simulation.link_pose(link), back)


def _parts(simulation: Simulation, model: Model, path: str, frames: Frames, place: Pose) -> Iterator[Part]:
    """Yield the parts of a model; `place` returns the pose of the model's frame in the world."""
    for link in model.links:
        name = f"{path}{SEPARATOR}{link.name}"
        yield Part(PartKind.LINK, name, path, partial(_between, place, partial(simulation.link_pose, name)))
        for kind, fixed in (
            (PartKind.VISUAL, link.visuals),
            (PartKind.COLLISION, link.collisions),
            (PartKind.SENSOR, link.sensors),
        ):
            for item in fixed:
                pose = frames.in_link(item.pose, link.name)
                yield Part(kind, f"{name}{SEPARATOR}{item.name}", name, partial(_same, pose))
    for inner in model.models:
        name, inside = f"{path}{SEPARATOR}{inner.name}", frames.inside(inner.name)
        first = next((link.name for link in inner.links), "")
        if not first:
            continue
        deeper = _pose_on_link(simulation, f"{name}{SEPARATOR}{first}", inside.pose(first))
        yield Part(PartKind.NESTED_MODEL, name, path, partial(_between, place, deeper))
        yield from _parts(simulation, inner, name, inside, deeper)


def _same(pose: Transform) -> Transform:
    return pose


def _between(outer: Pose, inner: Pose) -> Transform:
    """Return the pose of one part in the frame of another."""
    return compose(invert(outer()), inner())
