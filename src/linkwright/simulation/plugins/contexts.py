"""The plugins and sensors of a model or world, with the elements that contain them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.geometry.single import Transform, compose, invert
from linkwright.sdf.figures import ACTOR_WALK_LIBRARY
from linkwright.sdf.frames import FrameError, Frames, transform_of
from linkwright.sdf.joints import Joint
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import Plugin, library_name
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.plugin import PlacedSensor, PlacedVisual, PluginContext
from linkwright.simulation.plugins.registry import is_built_in


def world_plugins(world: World, systems: Sequence[Plugin] = ()) -> Iterator[PluginContext]:
    """Yield the plugins that are direct children of a world, and those that move its actors.

    Args:
        world: the world as it was read from SDF.
        systems: the plugins to use if the world does not declare any.
    """
    for plugin in world.plugins or systems:
        yield PluginContext(plugin.name or plugin.filename, plugin, world, None, "", None)
    for actor in world.actors:
        for plugin in actor.plugins:
            if library_name(plugin.filename) == ACTOR_WALK_LIBRARY:
                yield PluginContext(plugin.name or plugin.filename, plugin, world, None, actor.name, None)


def model_plugins(world: World, model: Model, path: str) -> Iterator[PluginContext]:
    """Yield the plugins of a model and its sensors, followed by those of nested models.

    A sensor without a publishing plugin is yielded, too. The plugins of visuals come after those of sensors.

    Args:
        world: the world, as it was read.
        model: the model, with its includes resolved.
        path: the model's name in the world.
    """
    frames = Frames(model)
    yield from _find_model_plugins(world, model, path, frames)


def _find_model_plugins(world: World, model: Model, path: str, frames: Frames) -> Iterator[PluginContext]:
    for plugin in model.plugins:
        yield PluginContext(plugin.name or plugin.filename, plugin, world, model, path, None)
    for placed_sensor in _find_sensors(model, path, frames):
        plugins = placed_sensor.sensor.plugins
        for plugin in plugins:
            yield PluginContext(plugin.name or placed_sensor.sensor.name, plugin, world, model, path, placed_sensor)
        if all(is_built_in(plugin.filename) for plugin in plugins):  # true if a sensor has only systems of gz
            yield PluginContext(placed_sensor.sensor.name, None, world, model, path, placed_sensor)
    for link in model.links:
        for visual in link.visuals:
            for plugin in visual.plugins:
                placed_visual = PlacedVisual(
                    visual.name, f"{path}{SEPARATOR}{link.name}", frames.in_link(visual.pose, link.name)
                )
                name = plugin.name or plugin.filename
                yield PluginContext(name, plugin, world, model, path, None, placed_visual)
    for nested_model in model.models:
        yield from _find_model_plugins(
            world, nested_model, f"{path}{SEPARATOR}{nested_model.name}", frames.inside(nested_model.name)
        )


def _find_sensors(model: Model, path: str, frames: Frames) -> Iterator[PlacedSensor]:
    for link in model.links:
        for sensor in link.sensors:
            name = SEPARATOR.join((path, link.name, sensor.name))
            pose = frames.in_link(sensor.pose, link.name)
            yield PlacedSensor(name, sensor, f"{path}{SEPARATOR}{link.name}", "", pose)
    for joint in model.joints:
        for sensor in joint.sensors:
            try:
                child = frames.link(joint.child)
                pose = compose(_compute_joint_pose(frames, joint, child), transform_of(sensor.pose.pose))
            except FrameError:
                continue
            name = SEPARATOR.join((path, joint.name, sensor.name))
            yield PlacedSensor(name, sensor, f"{path}{SEPARATOR}{child}", f"{path}{SEPARATOR}{joint.name}", pose)


def _compute_joint_pose(frames: Frames, joint: Joint, link: str) -> Transform:
    return compose(invert(frames.pose(link)), frames.pose(joint.name))
