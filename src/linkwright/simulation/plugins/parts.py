"""The parts of a model with poses: nested models, links, and objects fixed to links."""

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

PoseFunction = Callable[[], Transform]


class PartKind(Enum):
    """The kind of a part of a model."""

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
    pose: PoseFunction


def find_parts(simulation: Simulation, model: Model, path: str) -> Iterator[Part]:
    """Yield the parts of a model of a simulation.

    Each model and link precedes its parts.

    Args:
        simulation: the simulation that contains the model.
        model: the model, with its includes resolved.
        path: the name of the model in the world; no part is yielded for a nested model such as ``robot::arm`` itself.
    """
    frame_pose = _create_frame_pose(simulation, model, path)
    if SEPARATOR not in path:
        yield Part(PartKind.MODEL, path, simulation.world.name, frame_pose)
    yield from _find_nested_parts(simulation, model, path, Frames(model), frame_pose)


def _create_frame_pose(simulation: Simulation, model: Model, path: str) -> PoseFunction:
    """Return a function that returns the current pose of a model's frame in the world."""
    top_name, _, nested_path = path.partition(SEPARATOR)
    top_model = simulation.scene.models[top_name]
    if not top_model.structure.links:  # no part of the model moves
        return partial(_constant_pose, top_model.pose)
    if not nested_path or not model.links:
        return lambda: simulation.model_pose(top_name)
    first_link = model.links[0].name
    return _create_pose_on_link(simulation, f"{path}{SEPARATOR}{first_link}", Frames(model).pose(first_link))


def _create_pose_on_link(simulation: Simulation, link: str, link_in_frame: Transform) -> PoseFunction:
    """Return a function that returns the current pose of a frame that is fixed to a link.

    The pose is in the world. `link_in_frame` is the pose of the link in this frame.
    """
    frame_in_link = invert(link_in_frame)
    return lambda: compose(simulation.link_pose(link), frame_in_link)


def _find_nested_parts(
    simulation: Simulation, model: Model, path: str, frames: Frames, frame_pose: PoseFunction
) -> Iterator[Part]:
    """Yield the parts of a model.

    `frame_pose` returns the pose of the model's frame in the world.
    """
    for link in model.links:
        name = f"{path}{SEPARATOR}{link.name}"
        yield Part(
            PartKind.LINK, name, path, partial(_compute_relative_pose, frame_pose, partial(simulation.link_pose, name))
        )
        for kind, items in (
            (PartKind.VISUAL, link.visuals),
            (PartKind.COLLISION, link.collisions),
            (PartKind.SENSOR, link.sensors),
        ):
            for item in items:
                pose = frames.in_link(item.pose, link.name)
                yield Part(kind, f"{name}{SEPARATOR}{item.name}", name, partial(_constant_pose, pose))
    for nested_model in model.models:
        name, nested_frames = f"{path}{SEPARATOR}{nested_model.name}", frames.inside(nested_model.name)
        first_link = next((link.name for link in nested_model.links), "")
        if not first_link:
            continue
        nested_pose = _create_pose_on_link(simulation, f"{name}{SEPARATOR}{first_link}", nested_frames.pose(first_link))
        yield Part(PartKind.NESTED_MODEL, name, path, partial(_compute_relative_pose, frame_pose, nested_pose))
        yield from _find_nested_parts(simulation, nested_model, name, nested_frames, nested_pose)


def _constant_pose(pose: Transform) -> Transform:
    return pose


def _compute_relative_pose(reference: PoseFunction, target: PoseFunction) -> Transform:
    """Return the pose of the frame `target` in the frame `reference`."""
    return compose(invert(reference()), target())
