"""Rendering by ray casting: one ray per pixel, flat shading, no shadows."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform
from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.lights import PlacedLight, collect_lights
from linkwright.simulation.rendering.movable_geoms import CameraView
from linkwright.simulation.rendering.ray_casters import Caster, Hits
from linkwright.simulation.rendering.renderer import Channels, RenderedImage, compute_image_axes
from linkwright.simulation.simulation import Simulation

_DEFAULT_RGBA = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's default color, which a geom has if its material determines its color."""


class RayRenderer:
    """A renderer that uses ray casting.

    Args:
        simulation: the simulation of the world.
        caster: casts the rays.
    """

    def __init__(self, simulation: Simulation, caster: Caster) -> None:
        self.method = caster.method
        self._simulation = simulation
        self._caster = caster
        self._colors: Any = None
        self._known_paints: tuple[Any, ...] = ()
        self._revision = -1

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera."""
        axes = compute_image_axes(pose)
        origin, rays = np.array(pose[:3]), optics.directions(axes)
        hits = self._caster.cast(CameraView(optics, origin, axes, rays), normals=Channels.COLOR in channels)
        is_clipped = ~((hits.distances >= optics.near) & (hits.distances <= optics.far))
        np.copyto(hits.distances, np.inf, where=is_clipped)
        np.copyto(hits.geoms, -1, where=is_clipped)
        shape = optics.height, optics.width
        return RenderedImage(
            self._shade(hits, origin, rays, axes[:, 2]).reshape(*shape, 3) if Channels.COLOR in channels else None,
            hits.distances.reshape(shape) if Channels.DEPTH in channels else None,
            hits.geoms.reshape(shape) if Channels.GEOMS in channels else None,
        )

    def close(self) -> None:
        """Do nothing, because the renderer holds no system resources."""

    def _shade(self, hits: Hits, origin: Array, rays: Any, forwards: Array) -> Any:
        simulation = self._simulation
        paints = simulation.model.geom_rgba, simulation.model.geom_matid  # these vary with each image of a data set
        if self._revision != simulation.revision or not all(map(np.array_equal, paints, self._known_paints)):
            self._colors = compute_geom_colors(simulation.model)
            self._known_paints = tuple(paint.copy() for paint in paints)
            self._revision = simulation.revision
        scene = simulation.world.scene
        facing_signs = np.where(np.einsum("ij,ij->i", hits.normals, rays) > 0, np.float32(-1), np.float32(1))
        light = np.empty_like(hits.normals)
        light[:] = scene.ambient[:3]
        for placed_light in collect_lights(simulation, forwards):
            received = _compute_received_light(placed_light, hits, facing_signs, origin, rays)
            for channel, strength in enumerate(placed_light.color.astype(np.float32)):
                light[:, channel] += received * strength
        light *= self._colors.take(hits.geoms, axis=0, mode="wrap")
        np.minimum(light, 1.0, out=light)
        light *= 255
        rendered = light.astype(np.uint8)
        np.copyto(rendered, _to_background_color(scene.background), where=(hits.geoms < 0)[:, None])
        return rendered


def _to_background_color(color: Sequence[float]) -> Any:
    return np.round(np.clip(np.array(color[:3]), 0, 1) * 255).astype(np.uint8)


def _compute_received_light(placed_light: PlacedLight, hits: Hits, facing_signs: Any, origin: Array, rays: Any) -> Any:
    """Return the fraction of a light's intensity that each hit receives, shape (n,)."""
    if placed_light.light.type == "directional":
        fractions = (hits.normals @ -placed_light.direction.astype(np.float32)) * facing_signs
        return np.maximum(fractions, 0, out=fractions)
    with np.errstate(invalid="ignore"):  # Rays without a hit have infinite distances.
        to_light = placed_light.position.astype(np.float32) - (
            origin.astype(np.float32) + rays * hits.distances[:, None]
        )
        distance = np.linalg.norm(to_light, axis=1)
        to_light /= np.maximum(distance, 1e-9)[:, None]
        attenuation = placed_light.light.attenuation
        fractions = np.maximum(np.einsum("ij,ij->i", hits.normals, to_light) * facing_signs, 0)
        fractions /= np.maximum(
            attenuation.constant + attenuation.linear * distance + attenuation.quadratic * distance**2, 1e-3
        )
        fractions[~(distance <= attenuation.range)] = 0
        if placed_light.light.type == "spot" and placed_light.light.spot is not None:
            is_outside_cone = to_light @ -placed_light.direction.astype(np.float32) < cos(
                placed_light.light.spot.outer_angle / 2
            )
            fractions[is_outside_cone] = 0
    return fractions


def compute_geom_colors(model: Any) -> Any:
    """Return the colors of all geoms, from 0 to 1, shape (geoms, 3), float32.

    The color of a textured geom is multiplied by the mean color of the texture.
    """
    colors = np.array(model.geom_rgba[:, :3], dtype=np.float64)
    for geom in np.nonzero(model.geom_matid >= 0)[0]:
        material = model.geom_matid[geom]
        if (model.geom_rgba[geom] == _DEFAULT_RGBA).all():
            colors[geom] = model.mat_rgba[material, :3]
        for texture in np.atleast_1d(model.mat_texid[material]):
            if texture >= 0:
                colors[geom] *= compute_mean_color(model, int(texture))
                break
    return colors.astype(np.float32)


def compute_mean_color(model: Any, texture: int) -> Array:
    """Return the mean color of a texture in a MuJoCo model: red, green and blue from 0 to 1."""
    first, channels = model.tex_adr[texture], model.tex_nchannel[texture]
    count = model.tex_width[texture] * model.tex_height[texture] * channels
    mean: Array = model.tex_data[first : first + count].reshape(-1, channels).mean(axis=0) / 255
    return mean[:3] if channels >= 3 else np.repeat(mean[:1], 3)
