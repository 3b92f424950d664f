"""Rendering by ray casting: one ray per pixel, flat shading, no shadows."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform
from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.lights import PlacedLight, lights_of
from linkwright.simulation.rendering.movable import View
from linkwright.simulation.rendering.ray_casters import Caster, Hits
from linkwright.simulation.rendering.renderer import Channels, RenderedImage, axes_of
from linkwright.simulation.simulation import Simulation

_UNSET = (0.5, 0.5, 0.5, 1.0)
"""The colour in MuJoCo of a geom that has the colour of its material."""


class RayRenderer:
    """A renderer that uses ray casting.

    Args:
        simulation: the simulation of the world.
        caster: casts the rays.
    """

    def __init__(self, simulation: Simulation, caster: Caster) -> None:
        self.way = caster.way
        self._simulation = simulation
        self._caster = caster
        self._colours: Any = None
        self._paints: tuple[Any, ...] = ()
        self._revision = -1

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera."""
        axes = axes_of(pose)
        origin, rays = np.array(pose[:3]), optics.directions(axes)
        hits = self._caster.cast(View(optics, origin, axes, rays), normals=Channels.COLOUR in channels)
        unseen = ~((hits.distances >= optics.near) & (hits.distances <= optics.far))
        np.copyto(hits.distances, np.inf, where=unseen)
        np.copyto(hits.geoms, -1, where=unseen)
        shape = optics.height, optics.width
        return RenderedImage(
            self._shaded(hits, origin, rays, axes[:, 2]).reshape(*shape, 3) if Channels.COLOUR in channels else None,
            hits.distances.reshape(shape) if Channels.DEPTH in channels else None,
            hits.geoms.reshape(shape) if Channels.GEOMS in channels else None,
        )

    def close(self) -> None:
        """Do nothing: the renderer does not hold system resources."""

    def _shaded(self, hits: Hits, origin: Array, rays: Any, forwards: Array) -> Any:
        simulation = self._simulation
        paints = simulation.model.geom_rgba, simulation.model.geom_matid  # a data set varies them for each image
        if self._revision != simulation.revision or not all(map(np.array_equal, paints, self._paints)):
            self._colours = geom_colours(simulation.model)
            self._paints = tuple(paint.copy() for paint in paints)
            self._revision = simulation.revision
        scene = simulation.world.scene
        turned = np.where(np.einsum("ij,ij->i", hits.normals, rays) > 0, np.float32(-1), np.float32(1))
        light = np.empty_like(hits.normals)
        light[:] = scene.ambient[:3]
        for placed_light in lights_of(simulation, forwards):
            share = _share(placed_light, hits, turned, origin, rays)
            for channel, strength in enumerate(placed_light.colour.astype(np.float32)):
                light[:, channel] += share * strength
        light *= self._colours.take(hits.geoms, axis=0, mode="wrap")
        np.minimum(light, 1.0, out=light)
        light *= 255
        rendered = light.astype(np.uint8)
        np.copyto(rendered, _background(scene.background), where=(hits.geoms < 0)[:, None])
        return rendered


def _background(colour: Sequence[float]) -> Any:
    return np.round(np.clip(np.array(colour[:3]), 0, 1) * 255).astype(np.uint8)


def _share(placed: PlacedLight, hits: Hits, turned: Any, origin: Array, rays: Any) -> Any:
    """Return the fraction of a light's brightness that each hit surface receives, shape (n,)."""
    if placed.light.type == "directional":
        share = (hits.normals @ -placed.direction.astype(np.float32)) * turned
        return np.maximum(share, 0, out=share)
    with np.errstate(invalid="ignore"):  # Rays without a hit have infinite distances.
        away = placed.position.astype(np.float32) - (origin.astype(np.float32) + rays * hits.distances[:, None])
        distance = np.linalg.norm(away, axis=1)
        away /= np.maximum(distance, 1e-9)[:, None]
        fading = placed.light.attenuation
        share = np.maximum(np.einsum("ij,ij->i", hits.normals, away) * turned, 0)
        share /= np.maximum(fading.constant + fading.linear * distance + fading.quadratic * distance**2, 1e-3)
        share[~(distance <= fading.range)] = 0
        if placed.light.type == "spot" and placed.light.spot is not None:
            outside = away @ -placed.direction.astype(np.float32) < cos(placed.light.spot.outer_angle / 2)
            share[outside] = 0
    return share


def geom_colours(model: Any) -> Any:
    """Return the colours of all geoms, from 0 to 1, shape (geoms, 3), float32.

    The colour of a textured geom is multiplied by the mean colour of its texture.
    """
    colours = np.array(model.geom_rgba[:, :3], dtype=np.float64)
    for geom in np.nonzero(model.geom_matid >= 0)[0]:
        material = model.geom_matid[geom]
        if (model.geom_rgba[geom] == _UNSET).all():
            colours[geom] = model.mat_rgba[material, :3]
        for texture in np.atleast_1d(model.mat_texid[material]):
            if texture >= 0:
                colours[geom] *= mean_colour(model, int(texture))
                break
    return colours.astype(np.float32)


def mean_colour(model: Any, texture: int) -> Array:
    """Return the mean colour of a texture in a MuJoCo model: red, green and blue from 0 to 1."""
    first, channels = model.tex_adr[texture], model.tex_nchannel[texture]
    count = model.tex_width[texture] * model.tex_height[texture] * channels
    mean: Array = model.tex_data[first : first + count].reshape(-1, channels).mean(axis=0) / 255
    return mean[:3] if channels >= 3 else np.repeat(mean[:1], 3)
