"""Collects the plugins and sensors of a model or world, each with its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.geometry.single import Transform, compose, invert
from linkwright.sdf.frames import FrameError, Frames, transform_of
from linkwright.sdf.joints import Joint
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import Plugin
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.plugin import PlacedSensor, PluginPlace
from linkwright.simulation.plugins.registry import is_built_in


def world_plugins(world: World, systems: Sequence[Plugin] = ()) -> Iterator[PluginPlace]:
    """Yield the plugins that belong to a world and not to one of its models.

    Args:
        world: the world, as it was read.
        systems: the plugins of a world that does not declare any.
    """
    for plugin in world.plugins or systems:
        yield PluginPlace(plugin.name or plugin.filename, plugin, world, None, "", None)


def model_plugins(world: World, model: Model, path: str) -> Iterator[PluginPlace]:
    """Yield the plugins of a model and of its sensors, and the sensors that no plugin publishes.

    The plugins and sensors of nested models follow.

    Args:
        world: the world, as it was read.
        model: the model, with its includes resolved.
        path: the model's name in the world.
    """
    frames = Frames(model)
    yield from _of_model(world, model, path, frames)


def _of_model(world: World, model: Model, path: str, frames: Frames) -> Iterator[PluginPlace]:
    for plugin in model.plugins:
        yield PluginPlace(plugin.name or plugin.filename, plugin, world, model, path, None)
    for placed in _sensors(model, path, frames):
        plugins = placed.sensor.plugins
        for plugin in plugins:
            yield PluginPlace(plugin.name or placed.sensor.name, plugin, world, model, path, placed)
        if all(is_built_in(plugin.filename) for plugin in plugins):  # true if a sensor has only systems of gz
            yield PluginPlace(placed.sensor.name, None, world, model, path, placed)
    for inner in model.models:
        yield from _of_model(world, inner, f"{path}{SEPARATOR}{inner.name}", frames.inside(inner.name))


def _sensors(model: Model, path: str, frames: Frames) -> Iterator[PlacedSensor]:
    for link in model.links:
        for sensor in link.sensors:
            name = SEPARATOR.join((path, link.name, sensor.name))
            pose = frames.in_link(sensor.pose, link.name)
            yield PlacedSensor(name, sensor, f"{path}{SEPARATOR}{link.name}", "", pose)
    for joint in model.joints:
        for sensor in joint.sensors:
            try:
                child = frames.link(joint.child)
                pose = compose(_joint_in_link(frames, joint, child), transform_of(sensor.pose.pose))
            except FrameError:
                continue
            name = SEPARATOR.join((path, joint.name, sensor.name))
            yield PlacedSensor(name, sensor, f"{path}{SEPARATOR}{child}", f"{path}{SEPARATOR}{joint.name}", pose)


def _joint_in_link(frames: Frames, joint: Joint, link: str) -> Transform:
    return compose(invert(frames.pose(link)), frames.pose(joint.name))
