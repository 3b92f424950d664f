"""The lights of a world, as renderers need them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import IDENTITY, Transform, compose, rotate
from linkwright.sdf.frames import FrameError, Frames, transform_of
from linkwright.sdf.lights import Light
from linkwright.simulation.simulation import Simulation

_SUN_DIRECTION = (-0.5, 0.1, -0.9)
"""The direction of the light in worlds without lights, which is that of Gazebo's sun."""
_CAMERA_LIGHT = Light("reflected", "directional", diffuse=(0.25, 0.25, 0.25, 1.0), specular=(0.0, 0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class PlacedLight:
    """A light with its position and direction in the world.

    Attributes:
        light: the parsed ``<light>``.
        position: the position of the light in the world in m, shape (3,).
        direction: the direction of the light in the world as a unit vector, shape (3,).
        color: red, green and blue from 0 to 1, scaled by the light's intensity, shape (3,).
    """

    light: Light
    position: Array
    direction: Array
    color: Array


def collect_lights(simulation: Simulation, forwards: Array) -> list[PlacedLight]:
    """Return the lights of a world and its links at their current poses, or else a sun.

    The first light is a faint light in the viewing direction of the camera, `forwards`. It replaces indirect light:
    without it, everything in the shade would have the same color.
    """
    lights = [*_find_world_lights(simulation), *_find_link_lights(simulation)]
    if not lights:
        lights = [
            _place_light(Light("sun", "directional", diffuse=(0.8, 0.8, 0.8, 1.0), direction=_SUN_DIRECTION), IDENTITY)
        ]
    return [PlacedLight(_CAMERA_LIGHT, np.zeros(3), forwards, np.array(_CAMERA_LIGHT.diffuse[:3])), *lights]


def _find_world_lights(simulation: Simulation) -> Iterator[PlacedLight]:
    frames = Frames(simulation.world)
    for light in simulation.world.lights:
        if light.light_on:
            try:
                pose = frames.placed(light.pose)
            except FrameError:
                continue
            yield _place_light(light, pose)


def _find_link_lights(simulation: Simulation) -> Iterator[PlacedLight]:
    for model in simulation.scene.models.values():
        for placed_link in model.structure.links:
            for light in placed_link.link.link.lights:
                if light.light_on:
                    pose = compose(simulation.link_pose(placed_link.link.name), transform_of(light.pose.pose))
                    yield _place_light(light, pose)


def _place_light(light: Light, pose: Transform) -> PlacedLight:
    direction = np.array(rotate(pose[3:], light.direction))
    length = float(np.linalg.norm(direction))
    default_direction = np.array([0.0, 0.0, -1.0])
    return PlacedLight(
        light,
        np.array(pose[:3]),
        direction / length if length > 0 else default_direction,
        np.array(light.diffuse[:3]) * light.intensity,
    )
