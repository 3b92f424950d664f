"""Lights of a world in the form that renderers need."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import IDENTITY, Transform, compose, rotate
from linkwright.sdf.frames import FrameError, Frames, transform_of
from linkwright.sdf.lights import Light
from linkwright.simulation.simulation import Simulation

_SUN = (-0.5, 0.1, -0.9)
"""The direction of light in worlds without any, that of Gazebo's sun."""
_REFLECTED = Light("reflected", "directional", diffuse=(0.25, 0.25, 0.25, 1.0), specular=(0.0, 0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class PlacedLight:
    """A light with its pose in the world.

    Attributes:
        light: the parsed light.
        position: the position of the light in m, shape (3,).
        direction: the unit vector of the light's direction, shape (3,).
        colour: red, green and blue from 0 to 1, scaled by the light's intensity, shape (3,).
    """

    light: Light
    position: Array
    direction: Array
    colour: Array


def lights_of(simulation: Simulation, forwards: Array) -> list[PlacedLight]:
    """Return the lights of a world and its links at their current poses; a sun if there are none.

    The first light is a faint light at the camera, which looks along `forwards`. It replaces indirect light: without
    it, everything in the shade would have the same colour.
    """
    lights = [*_of_world(simulation), *_of_links(simulation)]
    if not lights:
        lights = [_placed(Light("sun", "directional", diffuse=(0.8, 0.8, 0.8, 1.0), direction=_SUN), IDENTITY)]
    return [PlacedLight(_REFLECTED, np.zeros(3), forwards, np.array(_REFLECTED.diffuse[:3])), *lights]


def _of_world(simulation: Simulation) -> Iterator[PlacedLight]:
    frames = Frames(simulation.world)
    for light in simulation.world.lights:
        if light.light_on:
            try:
                pose = frames.placed(light.pose)
            except FrameError:
                continue
            yield _placed(light, pose)


def _of_links(simulation: Simulation) -> Iterator[PlacedLight]:
    for model in simulation.scene.models.values():
        for held in model.structure.links:
            for light in held.link.link.lights:
                if light.light_on:
                    pose = compose(simulation.link_pose(held.link.name), transform_of(light.pose.pose))
                    yield _placed(light, pose)


def _placed(light: Light, pose: Transform) -> PlacedLight:
    direction = np.array(rotate(pose[3:], light.direction))
    length = float(np.linalg.norm(direction))
    down = np.array([0.0, 0.0, -1.0])
    return PlacedLight(
        light,
        np.array(pose[:3]),
        direction / length if length > 0 else down,
        np.array(light.diffuse[:3]) * light.intensity,
    )
