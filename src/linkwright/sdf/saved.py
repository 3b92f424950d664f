"""The saved state of a world: the element ``<state>`` of Gazebo classic.

A saved world contains each pose twice: the original pose in the model, and the saved pose in ``<state>``, which the
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
    """Return a world with its last saved state applied, if it has one.

    Includes must be resolved first.
    """
    if not world.states:
        return world
    state = world.states[-1]
    deleted_names = set(state.deletions.names)
    models = [model for model in (*world.models, *state.insertions.models) if model.name not in deleted_names]
    lights = [light for light in (*world.lights, *state.insertions.lights) if light.name not in deleted_names]
    model_states = {model_state.name: model_state for model_state in state.models}
    frames = Frames(world)
    light_poses = {light_state.name: light_state.pose for light_state in state.lights if light_state.pose is not None}
    return replace(
        world,
        models=tuple(
            _with_state(model, model_states.get(model.name), _compute_world_pose(frames, model)) for model in models
        ),
        lights=tuple(replace(light, pose=light_poses.get(light.name, light.pose)) for light in lights),
    )


def _compute_world_pose(frames: Frames, model: Model) -> Transform:
    try:
        return frames.pose(model.name)
    except FrameError:
        return transform_of(model.pose.pose)  # `check` reports the missing frame.


def _with_state(model: Model, state: ModelState | None, model_pose: Transform) -> Model:
    """Return a model with its saved state applied.

    `model_pose` is the pose of the model in the world, for a state without a pose.
    """
    if state is None:
        return model
    if state.pose is not None:
        model_pose = transform_of(state.pose.pose)
        model = replace(model, pose=state.pose, placement_frame="")
    to_model = invert(model_pose)
    link_poses = {link_state.name: link_state.pose for link_state in state.links if link_state.pose is not None}
    model_states = {model_state.name: model_state for model_state in state.models}

    def to_model_frame(pose: RawPose) -> RawPose:
        return RawPose(pose_of(compose(to_model, transform_of(pose.pose))))

    def with_nested_state(nested_model: Model) -> Model:
        nested_state = model_states.get(nested_model.name)
        if nested_state is None or nested_state.pose is None:
            return nested_model
        restored = _with_state(nested_model, nested_state, model_pose)
        return replace(restored, pose=to_model_frame(nested_state.pose))

    return replace(
        model,
        scale=state.scale if state.scale != (1.0, 1.0, 1.0) else model.scale,
        links=tuple(
            replace(link, pose=to_model_frame(link_poses[link.name])) if link.name in link_poses else link
            for link in model.links
        ),
        models=tuple(map(with_nested_state, model.models)),
    )
