"""The saved state of a world: ``<state>``, which Gazebo classic writes.

A saved world contains each pose twice: in the models as they were first written, and in ``<state>``, which the
simulator uses. Poses in a state are in the frame of the world.
"""

from __future__ import annotations

from dataclasses import replace

from linkwright.geometry.single import Transform, compose, invert
from linkwright.sdf.frames import FrameError, Frames, pose_of, transform_of
from linkwright.sdf.models import Model
from linkwright.sdf.poses import RawPose
from linkwright.sdf.states import ModelState
from linkwright.sdf.worlds import World


def with_saved_state(world: World) -> World:
    """Return a world with its last saved state applied; unchanged if there is no saved state.

    The includes of the world must have been resolved.
    """
    if not world.states:
        return world
    state = world.states[-1]
    gone = set(state.deletions.names)
    models = [each for each in (*world.models, *state.insertions.models) if each.name not in gone]
    lights = [each for each in (*world.lights, *state.insertions.lights) if each.name not in gone]
    placed = {each.name: each for each in state.models}
    frames = Frames(world)
    poses = {each.name: each.pose for each in state.lights if each.pose is not None}
    return replace(
        world,
        models=tuple(_restore(model, placed.get(model.name), _place(frames, model)) for model in models),
        lights=tuple(replace(each, pose=poses.get(each.name, each.pose)) for each in lights),
    )


def _place(frames: Frames, model: Model) -> Transform:
    try:
        return frames.pose(model.name)
    except FrameError:
        return transform_of(model.pose.pose)  # `check` reports the missing frame.


def _restore(model: Model, state: ModelState | None, place: Transform) -> Model:
    """Return a model with its saved state applied.

    `place` is the pose of the model in the world, which applies if the state does not contain a pose.
    """
    if state is None:
        return model
    if state.pose is not None:
        place = transform_of(state.pose.pose)
        model = replace(model, pose=state.pose, placement_frame="")
    to_model = invert(place)
    links = {each.name: each.pose for each in state.links if each.pose is not None}
    models = {each.name: each for each in state.models}

    def inside(pose: RawPose) -> RawPose:
        return RawPose(pose_of(compose(to_model, transform_of(pose.pose))))

    def inner(each: Model) -> Model:
        found = models.get(each.name)
        if found is None or found.pose is None:
            return each
        restored = _restore(each, found, place)
        return replace(restored, pose=inside(found.pose))

    return replace(
        model,
        scale=state.scale if state.scale != (1.0, 1.0, 1.0) else model.scale,
        links=tuple(
            replace(each, pose=inside(links[each.name])) if each.name in links else each for each in model.links
        ),
        models=tuple(map(inner, model.models)),
    )
