"""Offscreen rendering with OpenGL: MuJoCo's classic renderer on EGL, OSMesa or CGL.

On a CPU, MuJoCo's defaults (four samples per pixel, shadow maps of 4096 pixels, reflections) take twenty times as long
as the settings used here.
"""

from __future__ import annotations

import os
import sys
import threading
from ctypes.util import find_library
from importlib import import_module
from itertools import pairwise
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, Vector3
from linkwright.sdf.optics import Optics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.lens import Lens
from linkwright.simulation.rendering.lights import PlacedLight, collect_lights
from linkwright.simulation.rendering.renderer import Channels, Pixels, RenderedImage, compute_image_axes
from linkwright.simulation.rendering.triangles import is_infinite_plane
from linkwright.simulation.scene.bodies import COLLISION_GROUP, VISUAL_GROUP
from linkwright.simulation.simulation import Simulation

_LIBRARIES = {"cgl": ""} if sys.platform == "darwin" else {"egl": "EGL", "osmesa": "OSMesa"}
"""The shared library that each of MuJoCo's backends needs, or empty for none."""
_BACKEND_NAMES = {"egl": "EGL", "osmesa": "OSMesa", "cgl": "CGL"}
BACKENDS = tuple(_LIBRARIES)
_MAX_LIGHTS = 8
"""The maximum number of lights in OpenGL."""
_GROUND_SIZE = 4.0
"""The half width of the ground in multiples of the far clip distance, so that its edges are outside the image."""
_RADIUS_TOLERANCE = 1e-6
"""The relative tolerance of a geom's bounding radius, which covers rounding errors."""
_UNIFORM_LIGHT_QUADS, _OTHER_LIGHT_QUADS = 1, 4
"""The squares along each edge of a box's face, in uniform and in other light. Light is computed at their corners."""
_SLICES, _STACKS = 28, 14
"""The slices of spheres and cylinders, as in MuJoCo, and the stacks of spheres, which cover half the angle."""
_GL_COMPILE, _GL_TRIANGLE_STRIP, _GL_TRIANGLE_FAN = 0x1300, 0x5, 0x6
"""OpenGL's GL_COMPILE, GL_TRIANGLE_STRIP and GL_TRIANGLE_FAN."""
_BUILT_IN, _SPHERE, _CYLINDER, _TUBE = 8, 0, 3, 4
"""The number of MuJoCo's display lists, and the indices of the sphere, the cylinder and the side of a capsule."""
_SPARE_GEOMS = 100
"""The number of geoms for which the scene has space in addition to those of the model."""


class OpenGlRenderer:
    """A renderer that uses OpenGL.

    The OpenGL context belongs to the thread that created the renderer.

    Args:
        simulation: the simulation of the world.
        backend: one of `BACKENDS`.

    Raises:
        Exception: of any class, if this backend does not work.
    """

    def __init__(self, simulation: Simulation, backend: str) -> None:
        self.method: Phrase = phrase("OpenGL with {backend}", backend=_BACKEND_NAMES[backend])
        self._simulation = simulation
        self._mujoco = mujoco = load_mujoco()
        self._thread = threading.get_ident()
        self._size = (640, 480)
        self._gl = _import_context_class(backend)(*self._size)
        self._gl.make_current()
        self._functions: Any = import_module("OpenGL.raw.GL.VERSION.GL_1_0")
        self._visual_options = mujoco.MjvOption()
        for attribute in (
            "geomgroup",
            "sitegroup",
            "jointgroup",
            "tendongroup",
            "actuatorgroup",
            "flexgroup",
            "skingroup",
        ):
            if hasattr(self._visual_options, attribute):
                getattr(self._visual_options, attribute)[:] = 0
        self._visual_options.geomgroup[VISUAL_GROUP] = 1
        self._mujoco_camera = mujoco.MjvCamera()
        self._lenses: WeakKeyDictionary[Optics, Lens] = WeakKeyDictionary()
        self._revision = -1
        self._infinite_planes: frozenset[int] = frozenset()
        self._draw_context: Any = None
        self._scene: Any = None
        try:
            self._update_context()
        except BaseException:
            self._gl.free()
            raise

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera."""
        self._gl.make_current()
        pinhole = optics.pinhole
        self._simulation.refresh()
        self._update_context()
        self._enlarge_buffer(pinhole)
        self._update_scene(pinhole, pose)
        color, depth = self._draw_pixels(pinhole, channels)
        geoms = self._draw_geoms(pinhole) if Channels.GEOMS in channels else None
        if optics.is_pinhole:
            return RenderedImage(color, depth, geoms)
        lens = self._lenses.get(optics) or self._lenses.setdefault(optics, Lens(optics))
        return RenderedImage(
            None if color is None else lens.resample_colors(color),
            None if depth is None else lens.resample_nearest(depth),
            None if geoms is None else lens.resample_nearest(geoms),
        )

    def close(self) -> None:
        """Free the OpenGL context, if this thread created the renderer."""
        if self._thread == threading.get_ident():
            self._gl.make_current()
            if self._draw_context is not None:
                self._draw_context.free()
            self._gl.free()

    def _update_context(self) -> None:
        """Upload meshes and textures again if MuJoCo's model was rebuilt."""
        simulation, mujoco = self._simulation, self._mujoco
        if self._revision == simulation.revision:
            return
        model = simulation.model
        model.vis.quality.offsamples = 0
        model.vis.quality.shadowsize = 0
        model.vis.global_.offwidth, model.vis.global_.offheight = self._size
        is_uniform = _is_uniform(collect_lights(simulation, np.zeros(3)))
        model.vis.quality.numquads = _UNIFORM_LIGHT_QUADS if is_uniform else _OTHER_LIGHT_QUADS
        model.vis.quality.numslices, model.vis.quality.numstacks = _SLICES, _STACKS
        model.stat.extent = 1.0
        if self._draw_context is not None:
            self._draw_context.free()
        self._draw_context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._draw_context)
        if self._draw_context.rangeBuiltin == _BUILT_IN:
            self._simplify_round_shapes()
        self._draw_context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._scene = mujoco.MjvScene(model=model, maxgeom=model.ngeom + _SPARE_GEOMS)
        flags = mujoco.mjtRndFlag
        for flag in (flags.mjRND_SHADOW, flags.mjRND_REFLECTION, flags.mjRND_SKYBOX, flags.mjRND_HAZE, flags.mjRND_FOG):
            self._scene.flags[flag] = 0
        self._infinite_planes = frozenset(
            geom for geom in range(model.ngeom) if is_infinite_plane(model, geom) and not _is_textured(model, geom)
        )
        self._revision = simulation.revision

    def _simplify_round_shapes(self) -> None:
        """Draw spheres, and cylinders in uniform light, with fewer vertices than MuJoCo does.

        MuJoCo draws each quad separately, and divides the sides of cylinders into stacks and their ends into rings.
        These divisions change the image only if there is a point or spot light, because light is computed at the
        vertices.
        """
        azimuths, elevations = (
            np.linspace(0.0, 2.0 * np.pi, _SLICES + 1),
            np.linspace(-0.5 * np.pi, 0.5 * np.pi, _STACKS + 1),
        )
        circle = [*zip(np.cos(azimuths).tolist(), np.sin(azimuths).tolist(), strict=True)]
        arc = [*zip(np.cos(elevations).tolist(), np.sin(elevations).tolist(), strict=True)]
        sphere_strips = [[(x * r, y * r, z) for r, z in arc for x, y in segment] for segment in pairwise(circle)]
        self._replace_display_list(
            _SPHERE, [(_GL_TRIANGLE_STRIP, [(corner, corner) for corner in strip]) for strip in sphere_strips]
        )
        tube_strip = (_GL_TRIANGLE_STRIP, [((x, y, 0.0), (x, y, z)) for x, y in circle for z in (1.0, -1.0)])
        end_fans = [(_GL_TRIANGLE_FAN, [((0.0, 0.0, z), (x, y, z)) for x, y in circle[:: int(z)]]) for z in (1.0, -1.0)]
        if _is_uniform(collect_lights(self._simulation, np.zeros(3))):
            self._replace_display_list(_TUBE, [tube_strip])
            self._replace_display_list(_CYLINDER, [tube_strip, *end_fans])

    def _replace_display_list(self, shape: int, primitives: list[tuple[int, list[tuple[Vector3, Vector3]]]]) -> None:
        """Replace one of MuJoCo's display lists with other primitives.

        Each primitive consists of its OpenGL kind and the normal and position of each vertex.
        """
        gl = self._functions
        gl.glNewList(self._draw_context.baseBuiltin + shape, _GL_COMPILE)
        for kind, vertices in primitives:
            gl.glBegin(kind)
            for normal, position in vertices:
                gl.glNormal3f(*normal)
                gl.glVertex3f(*position)
            gl.glEnd()
        gl.glEndList()

    def _enlarge_buffer(self, pinhole: Optics) -> None:
        width, height = max(self._size[0], pinhole.width), max(self._size[1], pinhole.height)
        if (width, height) != self._size:
            self._size = width, height
            self._mujoco.mjr_resizeOffscreen(width, height, self._draw_context)

    def _update_scene(self, pinhole: Optics, pose: Transform) -> None:
        simulation, mujoco = self._simulation, self._mujoco
        model, axes = simulation.model, compute_image_axes(pose)
        model.vis.map.zfar = pinhole.far  # MuJoCo draws infinite planes up to zfar.
        groups = model.geom_group.copy()
        model.geom_group[_find_geoms_outside_image(simulation, pinhole, np.array(pose[:3]), axes)] = COLLISION_GROUP
        categories = mujoco.mjtCatBit.mjCAT_ALL.value
        try:
            mujoco.mjv_updateScene(
                model, simulation.data, self._visual_options, None, self._mujoco_camera, categories, self._scene
            )
        finally:
            model.geom_group[:] = groups
        lights = collect_lights(simulation, axes[:, 2])
        if _is_uniform(lights):
            self._flatten_planes(pinhole, np.array(pose[:3]))
        _, down, forwards = axes.T
        self._set_lights(lights)
        scale = pinhole.near / pinhole.fy
        for camera in self._scene.camera:
            camera.pos[:] = pose[:3]
            camera.forward[:], camera.up[:] = forwards, -down
            camera.frustum_near, camera.frustum_far = pinhole.near, pinhole.far
            camera.frustum_top, camera.frustum_bottom = pinhole.cy * scale, (pinhole.cy - pinhole.height) * scale
            camera.frustum_center = (pinhole.width / 2 - pinhole.cx) * scale
            camera.frustum_width = pinhole.width / 2 * scale

    def _flatten_planes(self, pinhole: Optics, origin: Array) -> None:
        """Draw infinite planes without textures, as seen from above, as the tops of boxes.

        MuJoCo draws 40 000 squares for each plane, but only nonuniform light and textures require them.
        """
        kinds, data, remaining_planes = self._mujoco.mjtGeom, self._simulation.data, len(self._infinite_planes)
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if not remaining_planes:
                break
            if geom.objid not in self._infinite_planes:
                continue
            remaining_planes -= 1
            normal = data.geom_xmat[geom.objid].reshape(3, 3)[:, 2]
            height = float((origin - data.geom_xpos[geom.objid]) @ normal)
            if height > 0:
                geom.type = kinds.mjGEOM_BOX.value
                geom.size[:] = _GROUND_SIZE * pinhole.far, _GROUND_SIZE * pinhole.far, 1.0
                geom.pos[:] = origin - (height + 1.0) * normal

    def _set_lights(self, lights: list[PlacedLight]) -> None:
        scene, kinds = self._scene, self._mujoco.mjtLightType
        scene.nlight = min(len(lights), _MAX_LIGHTS)
        ambient = np.array(self._simulation.world.scene.ambient[:3])
        for light, placed_light in zip(scene.lights, lights[:_MAX_LIGHTS], strict=False):
            description = placed_light.light
            directional = description.type == "directional"  # A point light is a spot light in all directions.
            light.type = (kinds.mjLIGHT_DIRECTIONAL if directional else kinds.mjLIGHT_SPOT).value
            light.pos[:], light.dir[:] = placed_light.position, placed_light.direction
            light.attenuation[:] = (
                description.attenuation.constant,
                description.attenuation.linear,
                description.attenuation.quadratic,
            )
            if directional:
                light.attenuation[:] = 1.0, 0.0, 0.0
            cone = (
                description.spot.outer_angle / 2
                if description.type == "spot" and description.spot is not None
                else np.pi
            )
            light.cutoff = float(np.degrees(cone)) if cone < np.pi / 2 else 180.0
            light.exponent = 0.0
            light.diffuse[:] = placed_light.color
            light.specular[:] = description.specular[:3]
            light.ambient[:] = ambient
            ambient = np.zeros(3)
            light.headlight = light.castshadow = 0

    def _draw_pixels(self, pinhole: Optics, channels: Channels) -> tuple[Pixels | None, Pixels | None]:
        if not channels & (Channels.COLOR | Channels.DEPTH):
            return None, None
        rect = self._mujoco.MjrRect(0, 0, pinhole.width, pinhole.height)
        color: Pixels | None = None
        if Channels.COLOR in channels:
            color = np.empty((pinhole.height, pinhole.width, 3), np.uint8)
            self._mujoco.mjr_render(rect, self._scene, self._draw_context)
        else:
            self._draw_without_colors(rect)
        depth_buffer = np.empty((pinhole.height, pinhole.width), np.float32)
        self._mujoco.mjr_readPixels(color, depth_buffer, rect, self._draw_context)
        is_background = depth_buffer <= 0
        if color is not None:
            self._fill_background(color, is_background)
            color = np.ascontiguousarray(color[::-1])
        if Channels.DEPTH not in channels:
            return color, None
        near, far = np.float32(pinhole.near), np.float32(pinhole.far)
        depth_buffer *= far - near
        depth_buffer += near
        distances = np.empty_like(depth_buffer)
        np.divide(far * near, depth_buffer, out=distances[::-1])
        np.copyto(distances, np.inf, where=is_background[::-1])
        return color, distances

    def _fill_background(self, color: Pixels, is_background: Any) -> None:
        """Fill the background in the rows that show it."""
        rows = np.flatnonzero(is_background.any(axis=1))
        if not len(rows):
            return
        shown = slice(rows[0], rows[-1] + 1)
        background = np.clip(np.array(self._simulation.world.scene.background[:3]), 0, 1) * 255
        for channel, shade in enumerate(np.round(background).astype(np.uint8)):
            # takes a tenth of the time of copying all channels
            np.copyto(color[shown, :, channel], shade, where=is_background[shown])

    def _draw_without_colors(self, rect: Any) -> None:
        """Render into the depth buffer only, without lights or colors."""
        lights, self._scene.nlight = self._scene.nlight, 0
        self._functions.glColorMask(False, False, False, False)
        try:
            self._mujoco.mjr_render(rect, self._scene, self._draw_context)
        finally:
            self._functions.glColorMask(True, True, True, True)
            self._scene.nlight = lights

    def _draw_geoms(self, pinhole: Optics) -> Pixels:
        flags, scene = self._mujoco.mjtRndFlag, self._scene
        rect = self._mujoco.MjrRect(0, 0, pinhole.width, pinhole.height)
        try:
            scene.flags[flags.mjRND_SEGMENT] = scene.flags[flags.mjRND_IDCOLOR] = 1
            self._mujoco.mjr_render(rect, scene, self._draw_context)
        finally:
            scene.flags[flags.mjRND_SEGMENT] = scene.flags[flags.mjRND_IDCOLOR] = 0
        colors = np.empty((pinhole.height, pinhole.width, 3), np.uint8)
        self._mujoco.mjr_readPixels(colors, None, rect, self._draw_context)
        segment_ids = colors[::-1].astype(np.int32) @ np.array([1, 1 << 8, 1 << 16], dtype=np.int32)
        segments = [(geom.segid + 1, geom.objid) for geom in scene.geoms[: scene.ngeom] if geom.segid >= 0]
        geom_by_segment = np.full(max((number for number, _ in segments), default=0) + 1, -1, dtype=np.int32)
        for segment_id, geom in segments:
            geom_by_segment[segment_id] = geom
        geoms: Pixels = geom_by_segment[np.where(segment_ids < len(geom_by_segment), segment_ids, 0)]
        return geoms


def _find_geoms_outside_image(simulation: Simulation, pinhole: Optics, origin: Array, axes: Array) -> Any:
    """Return whether each geom is outside the image, shape (geoms,).

    These geoms are hidden, because OpenGL would process all their vertices.
    """
    normals, offsets = pinhole.bounds
    radii = simulation.model.geom_rbound * (1 + _RADIUS_TOLERANCE)
    distances = normals @ axes.T @ (simulation.data.geom_xpos - origin).T
    distances -= offsets
    return (distances > radii).any(axis=0) & (radii > 0)  # MuJoCo gives infinite geoms the radius 0.


def _is_uniform(lights: list[PlacedLight]) -> bool:
    return all(light.light.type == "directional" for light in lights)


def _is_textured(model: Any, geom: int) -> bool:
    material = int(model.geom_matid[geom])
    return material >= 0 and bool((np.atleast_1d(model.mat_texid[material]) >= 0).any())


def _import_context_class(backend: str) -> Any:
    library = _LIBRARIES[backend]
    if library and find_library(library) is None:
        raise OSError(library)
    previous_platform = os.environ.get("PYOPENGL_PLATFORM")
    try:
        return import_module(f"mujoco.{backend}").GLContext
    finally:
        if previous_platform is None:  # child processes must not inherit the variable, which MuJoCo sets
            os.environ.pop("PYOPENGL_PLATFORM", None)
