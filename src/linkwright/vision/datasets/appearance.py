"""The random appearance of an image: lights, colors, patterns, backdrop, camera effects."""

from __future__ import annotations

import colorsys
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.lights import Light
from linkwright.vision.datasets.arrangement import Arrangement
from linkwright.vision.datasets.randomized_world import RandomizedWorld
from linkwright.vision.datasets.textures import Pixels, make_smooth_noise

_NOISE_VALUE_COUNT = 1 << 21
"""The number of noise values. They are drawn once, and each image uses them from a different offset."""


def set_lights(world: RandomizedWorld, generator: np.random.Generator) -> None:
    """Replace the lights of a world with one to three random lights.

    All lights are directional. With a nearby light, OpenGL's rendering of an infinite plane would depend on the
    previous frame.
    """
    lights = []
    for index in range(int(generator.integers(1, 4))):
        intensity = 1.0 if index == 0 else 0.5
        color = _choose_tint(generator, 0.25) * generator.uniform(0.3, 1.0) * intensity
        red, green, blue = (float(channel) for channel in color)
        diffuse = red, green, blue, 1.0
        x, y, z = (float(component) for component in generator.normal(size=3))
        direction = x, y, -abs(z) - 0.2
        lights.append(Light(f"light {index}", "directional", diffuse=diffuse, direction=direction))
    ambient = _choose_tint(generator, 0.15) * generator.uniform(0.1, 0.55)
    world.set_lights(lights, ambient, generator.random(3))


def paint_surfaces(world: RandomizedWorld, arrangement: Arrangement, generator: np.random.Generator) -> None:
    """Recolor all objects and surroundings.

    Most objects keep their color or get a similar one.
    """
    for movable in arrangement.placed_objects:
        choice, new_colors = generator.random(), {}
        is_textured = generator.random() < 0.3
        number = int(generator.integers(1 << 16))
        for geom in movable.geoms:
            original_color = tuple(float(channel) for channel in world.get_original_color(geom)[:3])
            if original_color not in new_colors:
                new_colors[original_color] = _choose_object_color(original_color, choice, generator)
            if not world.has_material(geom):
                world.paint(geom, new_colors[original_color], "object" if is_textured else "", number)
    for geom in world.distractors:
        is_patterned = generator.random() < 0.5
        world.paint(geom, generator.random(3), "wall" if is_patterned else "", int(generator.integers(1 << 16)))
    for kind, geoms in (("wall", arrangement.structures), ("ground", world.ground)):
        is_uniform = generator.random() < 0.7
        color, is_patterned, number = _choose_surface(generator)
        for geom in geoms:
            if not is_uniform:
                color, is_patterned, number = _choose_surface(generator)
            world.paint(geom, color, kind if is_patterned else "", number)


def fill_backdrop(color: Pixels, geoms: Any, generator: np.random.Generator) -> None:
    """Fill the empty parts of an image with a random backdrop: a gradient with clouds."""
    is_empty = geoms < 0
    if not is_empty.any():
        return
    height, width = geoms.shape
    top_color, bottom_color = generator.uniform(0.2, 1.0, 3), generator.uniform(0.2, 1.0, 3)
    blend = np.linspace(0.0, 1.0, height)[:, None]
    if generator.random() < 0.5:
        blend = 0.5 * blend + 0.5 * make_smooth_noise(generator, int(generator.integers(2, 12)), height, width)
    blend = np.broadcast_to(blend, (height, width))[is_empty].astype(np.float32)
    for channel in range(3):
        color[..., channel][is_empty] = (
            255 * (top_color[channel] + (bottom_color[channel] - top_color[channel]) * blend)
        ).astype(np.uint8)


class LensEffects:
    """The effects of a lens and a sensor: exposure, white balance, blur and noise."""

    def __init__(self) -> None:
        self._noise = np.random.default_rng(0).standard_normal(_NOISE_VALUE_COUNT, dtype=np.float32)

    def apply(self, color: Pixels, generator: np.random.Generator) -> Pixels:
        """Return an image with random effects of lens and sensor."""
        gain, gamma = np.exp(generator.normal(0.0, 0.18)), np.exp(generator.normal(0.0, 0.15))
        balance = np.exp(generator.normal(0.0, 0.05, 3))
        levels = np.linspace(0.0, 1.0, 256)[:, None] ** gamma * gain * balance
        lookup_table = np.clip(np.round(levels * 255), 0, 255).astype(np.uint8)
        result = np.empty_like(color)
        for channel in range(3):
            result[..., channel] = lookup_table[:, channel].take(color[..., channel])
        if generator.random() < 0.35:
            result = _blur(result, float(generator.uniform(0.3, 1.6)))
        if generator.random() < 0.7:
            strength = np.float32(generator.uniform(0.5, 9.0))
            start = int(generator.integers(_NOISE_VALUE_COUNT - result.size)) if result.size < _NOISE_VALUE_COUNT else 0
            noise = np.resize(self._noise[start:], result.size).reshape(result.shape)
            result = np.clip(result + strength * noise, 0, 255).astype(np.uint8)
        return result


def _blur(color: Pixels, radius: float) -> Pixels:
    from PIL import Image, ImageFilter

    blurred: Pixels = np.asarray(Image.fromarray(color).filter(ImageFilter.GaussianBlur(radius)))
    return blurred


def _choose_tint(generator: np.random.Generator, max_saturation: float) -> Array:
    """Return white with a random tint, as red, green and blue with a maximum of 1."""
    return np.array(colorsys.hsv_to_rgb(generator.random(), generator.uniform(0.0, max_saturation), 1.0))


def _choose_object_color(color: tuple[float, ...], choice: float, generator: np.random.Generator) -> Array:
    """Return a color for an object: the same, one with a similar hue, or a random one."""
    hue, saturation, value = colorsys.rgb_to_hsv(*color)
    if choice < 0.45:
        return np.array(color)
    if choice < 0.85:
        hue = (hue + generator.normal(0.0, 0.02)) % 1.0
        saturation = float(np.clip(saturation * generator.uniform(0.7, 1.2), 0.0, 1.0))
        value = float(np.clip(value * generator.uniform(0.6, 1.2) + generator.uniform(0.0, 0.05), 0.0, 1.0))
    else:
        hue, saturation, value = generator.random(), generator.uniform(0.0, 1.0), generator.uniform(0.1, 1.0)
    return np.array(colorsys.hsv_to_rgb(hue, saturation, value))


def _choose_surface(generator: np.random.Generator) -> tuple[Array, bool, int]:
    color = np.array(colorsys.hsv_to_rgb(generator.random(), generator.beta(1.0, 2.5), generator.uniform(0.25, 1.0)))
    return color, bool(generator.random() < 0.6), int(generator.integers(1 << 16))
