"""Rendering by OpenGL, with MuJoCo's classic renderer, offscreen on EGL, OSMesa or CGL.

MuJoCo's defaults (four samples per pixel, shadow maps of 4096 pixels, reflections) take twenty times as long on a CPU
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

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, Vector3
from linkwright.sdf.optics import Optics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.lights import PlacedLight, lights_of
from linkwright.simulation.rendering.renderer import Channels, Pixels, RenderedImage, axes_of
from linkwright.simulation.rendering.triangles import is_endless
from linkwright.simulation.scene.bodies import COLLISION_GROUP, VISUAL_GROUP
from linkwright.simulation.simulation import Simulation

_LIBRARIES = {"cgl": ""} if sys.platform == "darwin" else {"egl": "EGL", "osmesa": "OSMesa"}
"""The libraries that MuJoCo's backends need."""
_NAMES = {"egl": "EGL", "osmesa": "OSMesa", "cgl": "CGL"}
BACKENDS = tuple(_LIBRARIES)
_LIGHTS = 8
"""The greatest number of lights of OpenGL."""
_FARTHER = 4.0
"""The size of the ground, in far clip distances of the camera: its edges are outside the image."""
_ROUNDING = 1e-6
"""The fraction of its size by which rounding may put a geom outside the view."""
_QUADS, _LIT_QUADS = 1, 4
"""Into how many squares a side of a box is cut each way: light is computed at their corners."""
_SLICES, _STACKS = 28, 14
"""Into how many slices balls and cylinders are cut, as by MuJoCo; half as many stacks reach as near to a ball."""
_COMPILE, _STRIP, _FAN = 0x1300, 0x5, 0x6
"""OpenGL's GL_COMPILE, GL_TRIANGLE_STRIP and GL_TRIANGLE_FAN."""
_BUILT_IN, _BALL, _CYLINDER, _TUBE = 8, 0, 3, 4
"""The number of display lists of MuJoCo's shapes, and which are a ball, a cylinder and the side of a capsule."""
_SPARE_GEOMS = 100
"""Spare geoms in the scene beside those of the model."""


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
        self.way: Phrase = phrase("OpenGL by {backend}", backend=_NAMES[backend])
        self._simulation = simulation
        self._mujoco = mujoco = load_mujoco()
        self._thread = threading.get_ident()
        self._size = (640, 480)
        self._gl = _context_class(backend)(*self._size)
        self._gl.make_current()
        self._functions: Any = import_module("OpenGL.raw.GL.VERSION.GL_1_0")
        self._option = mujoco.MjvOption()
        for groups in (
            "geomgroup",
            "sitegroup",
            "jointgroup",
            "tendongroup",
            "actuatorgroup",
            "flexgroup",
            "skingroup",
        ):
            if hasattr(self._option, groups):
                getattr(self._option, groups)[:] = 0
        self._option.geomgroup[VISUAL_GROUP] = 1
        self._view = mujoco.MjvCamera()
        self._revision = -1
        self._endless: frozenset[int] = frozenset()
        self._draw_context: Any = None
        self._scene: Any = None
        try:
            self._renew()
        except BaseException:
            self._gl.free()
            raise

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera."""
        self._gl.make_current()
        hole = optics.pinhole
        self._simulation.refresh()
        self._renew()
        self._make_room(hole)
        self._update(hole, pose)
        colour, depth = self._draw(hole, channels)
        geoms = self._draw_geoms(hole) if Channels.GEOMS in channels else None
        if optics.is_pinhole:
            return RenderedImage(colour, depth, geoms)
        return RenderedImage(
            None if colour is None else _resample_interpolated(colour, optics),
            None if depth is None else _resample_nearest(depth, optics),
            None if geoms is None else _resample_nearest(geoms, optics),
        )

    def close(self) -> None:
        """Free the OpenGL context; a call in a thread other than the creating one has no effect."""
        if self._thread == threading.get_ident():
            self._gl.make_current()
            if self._draw_context is not None:
                self._draw_context.free()
            self._gl.free()

    def _renew(self) -> None:
        """Upload meshes and textures again if MuJoCo's model was rebuilt."""
        simulation, mujoco = self._simulation, self._mujoco
        if self._revision == simulation.revision:
            return
        model = simulation.model
        model.vis.quality.offsamples = 0
        model.vis.quality.shadowsize = 0
        model.vis.global_.offwidth, model.vis.global_.offheight = self._size
        even = _is_uniform(lights_of(simulation, np.zeros(3)))
        model.vis.quality.numquads = _QUADS if even else _LIT_QUADS
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
        self._endless = frozenset(
            geom for geom in range(model.ngeom) if is_endless(model, geom) and not _is_textured(model, geom)
        )
        self._revision = simulation.revision

    def _simplify_round_shapes(self) -> None:
        """Draw spheres, and cylinders in uniform light, with fewer vertices than MuJoCo does.

        MuJoCo draws each quad separately, and divides the sides of cylinders into stacks and their ends into rings.
        These divisions are visible only where a point or spot light lights their vertices. In uniform light the
        image is the same.
        """
        turns, rises = np.linspace(0.0, 2.0 * np.pi, _SLICES + 1), np.linspace(-0.5 * np.pi, 0.5 * np.pi, _STACKS + 1)
        circle = [*zip(np.cos(turns).tolist(), np.sin(turns).tolist(), strict=True)]
        arc = [*zip(np.cos(rises).tolist(), np.sin(rises).tolist(), strict=True)]
        ball = [[(x * r, y * r, z) for r, z in arc for x, y in sides] for sides in pairwise(circle)]
        self._replace_display_list(_BALL, [(_STRIP, [(corner, corner) for corner in strip]) for strip in ball])
        tube = (_STRIP, [((x, y, 0.0), (x, y, z)) for x, y in circle for z in (1.0, -1.0)])
        ends = [(_FAN, [((0.0, 0.0, z), (x, y, z)) for x, y in circle[:: int(z)]]) for z in (1.0, -1.0)]
        if _is_uniform(lights_of(self._simulation, np.zeros(3))):
            self._replace_display_list(_TUBE, [tube])
            self._replace_display_list(_CYLINDER, [tube, *ends])

    def _replace_display_list(self, shape: int, pieces: list[tuple[int, list[tuple[Vector3, Vector3]]]]) -> None:
        """Replace one of MuJoCo's display lists by the given primitives.

        Each primitive has a kind, and the normals and positions of its vertices.
        """
        gl = self._functions
        gl.glNewList(self._draw_context.baseBuiltin + shape, _COMPILE)
        for kind, corners in pieces:
            gl.glBegin(kind)
            for normal, place in corners:
                gl.glNormal3f(*normal)
                gl.glVertex3f(*place)
            gl.glEnd()
        gl.glEndList()

    def _make_room(self, hole: Optics) -> None:
        width, height = max(self._size[0], hole.width), max(self._size[1], hole.height)
        if (width, height) != self._size:
            self._size = width, height
            self._mujoco.mjr_resizeOffscreen(width, height, self._draw_context)

    def _update(self, hole: Optics, pose: Transform) -> None:
        simulation, mujoco = self._simulation, self._mujoco
        model, axes = simulation.model, axes_of(pose)
        model.vis.map.zfar = hole.far  # MuJoCo draws infinite planes up to zfar.
        groups = model.geom_group.copy()
        model.geom_group[_outside_image(simulation, hole, np.array(pose[:3]), axes)] = COLLISION_GROUP
        catches = mujoco.mjtCatBit.mjCAT_ALL.value
        try:
            mujoco.mjv_updateScene(model, simulation.data, self._option, None, self._view, catches, self._scene)
        finally:
            model.geom_group[:] = groups
        lights = lights_of(simulation, axes[:, 2])
        if _is_uniform(lights):
            self._flatten_planes(hole, np.array(pose[:3]))
        _, down, forwards = axes.T
        self._set_lights(lights)
        scale = hole.near / hole.fy
        for camera in self._scene.camera:
            camera.pos[:] = pose[:3]
            camera.forward[:], camera.up[:] = forwards, -down
            camera.frustum_near, camera.frustum_far = hole.near, hole.far
            camera.frustum_top, camera.frustum_bottom = hole.cy * scale, (hole.cy - hole.height) * scale
            camera.frustum_center = (hole.width / 2 - hole.cx) * scale
            camera.frustum_width = hole.width / 2 * scale

    def _flatten_planes(self, hole: Optics, origin: Array) -> None:
        """Draw infinite planes without textures, if seen from above, as the tops of boxes.

        MuJoCo draws 40 000 squares for each plane, which only nonuniform light and textures require.
        """
        kinds, data, left = self._mujoco.mjtGeom, self._simulation.data, len(self._endless)
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if not left:
                break
            if geom.objid not in self._endless:
                continue
            left -= 1
            normal = data.geom_xmat[geom.objid].reshape(3, 3)[:, 2]
            above = float((origin - data.geom_xpos[geom.objid]) @ normal)
            if above > 0:
                geom.type = kinds.mjGEOM_BOX.value
                geom.size[:] = _FARTHER * hole.far, _FARTHER * hole.far, 1.0
                geom.pos[:] = origin - (above + 1.0) * normal

    def _set_lights(self, lights: list[PlacedLight]) -> None:
        scene, kinds = self._scene, self._mujoco.mjtLightType
        scene.nlight = min(len(lights), _LIGHTS)
        ambient = np.array(self._simulation.world.scene.ambient[:3])
        for light, placed in zip(scene.lights, lights[:_LIGHTS], strict=False):
            description = placed.light
            directional = description.type == "directional"  # A point light is a spot light in all directions.
            light.type = (kinds.mjLIGHT_DIRECTIONAL if directional else kinds.mjLIGHT_SPOT).value
            light.pos[:], light.dir[:] = placed.position, placed.direction
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
            light.diffuse[:] = placed.colour
            light.specular[:] = description.specular[:3]
            light.ambient[:] = ambient
            ambient = np.zeros(3)
            light.headlight = light.castshadow = 0

    def _draw(self, hole: Optics, channels: Channels) -> tuple[Pixels | None, Pixels | None]:
        if not channels & (Channels.COLOUR | Channels.DEPTH):
            return None, None
        rect = self._mujoco.MjrRect(0, 0, hole.width, hole.height)
        colour: Pixels | None = None
        if Channels.COLOUR in channels:
            colour = np.empty((hole.height, hole.width, 3), np.uint8)
            self._mujoco.mjr_render(rect, self._scene, self._draw_context)
        else:
            self._draw_without_colours(rect)
        raw = np.empty((hole.height, hole.width), np.float32)
        self._mujoco.mjr_readPixels(colour, raw, rect, self._draw_context)
        nothing = raw <= 0
        if colour is not None:
            background = np.clip(np.array(self._simulation.world.scene.background[:3]), 0, 1) * 255
            for channel, shade in enumerate(np.round(background).astype(np.uint8)):
                np.copyto(colour[:, :, channel], shade, where=nothing)  # a tenth of the time of copying all channels
            colour = np.ascontiguousarray(colour[::-1])
        if Channels.DEPTH not in channels:
            return colour, None
        near, far = np.float32(hole.near), np.float32(hole.far)
        raw *= far - near
        raw += near
        distances = np.empty_like(raw)
        np.divide(far * near, raw, out=distances[::-1])
        np.copyto(distances, np.inf, where=nothing[::-1])
        return colour, distances

    def _draw_without_colours(self, rect: Any) -> None:
        """Render depth only, without lighting or colours."""
        lights, self._scene.nlight = self._scene.nlight, 0
        self._functions.glColorMask(False, False, False, False)
        try:
            self._mujoco.mjr_render(rect, self._scene, self._draw_context)
        finally:
            self._functions.glColorMask(True, True, True, True)
            self._scene.nlight = lights

    def _draw_geoms(self, hole: Optics) -> Pixels:
        flags, scene = self._mujoco.mjtRndFlag, self._scene
        rect = self._mujoco.MjrRect(0, 0, hole.width, hole.height)
        try:
            scene.flags[flags.mjRND_SEGMENT] = scene.flags[flags.mjRND_IDCOLOR] = 1
            self._mujoco.mjr_render(rect, scene, self._draw_context)
        finally:
            scene.flags[flags.mjRND_SEGMENT] = scene.flags[flags.mjRND_IDCOLOR] = 0
        colours = np.empty((hole.height, hole.width, 3), np.uint8)
        self._mujoco.mjr_readPixels(colours, None, rect, self._draw_context)
        numbers = colours[::-1].astype(np.int32) @ np.array([1, 1 << 8, 1 << 16], dtype=np.int32)
        known = [(geom.segid + 1, geom.objid) for geom in scene.geoms[: scene.ngeom] if geom.segid >= 0]
        table = np.full(max((number for number, _ in known), default=0) + 1, -1, dtype=np.int32)
        for number, geom in known:
            table[number] = geom
        named: Pixels = table[np.where(numbers < len(table), numbers, 0)]
        return named


def _outside_image(simulation: Simulation, hole: Optics, origin: Array, axes: Array) -> Any:
    """Return whether each geom is outside the image, shape (geoms,).

    OpenGL would process all vertices of these geoms.
    """
    normals, places = hole.bounds
    reach = simulation.model.geom_rbound * (1 + _ROUNDING)
    beyond = normals @ axes.T @ (simulation.data.geom_xpos - origin).T
    beyond -= places
    return (beyond > reach).any(axis=0) & (reach > 0)  # MuJoCo gives infinite geoms the radius 0.


def _is_uniform(lights: list[PlacedLight]) -> bool:
    return all(light.light.type == "directional" for light in lights)


def _is_textured(model: Any, geom: int) -> bool:
    material = int(model.geom_matid[geom])
    return material >= 0 and bool((np.atleast_1d(model.mat_texid[material]) >= 0).any())


def _context_class(backend: str) -> Any:
    library = _LIBRARIES[backend]
    if library and find_library(library) is None:
        raise OSError(library)
    before = os.environ.get("PYOPENGL_PLATFORM")
    try:
        return import_module(f"mujoco.{backend}").GLContext
    finally:
        if before is None:  # child processes must not inherit the variables that MuJoCo sets
            os.environ.pop("PYOPENGL_PLATFORM", None)


def _resample_nearest(pixels: Pixels, optics: Optics) -> Pixels:
    """Return a pinhole image as seen through a lens, with nearest-neighbour interpolation."""
    column, row = optics.sources
    column = np.clip(np.round(column).astype(int), 0, optics.pinhole.width - 1)
    row = np.clip(np.round(row).astype(int), 0, optics.pinhole.height - 1)
    picked: Pixels = pixels[row, column].reshape(optics.height, optics.width, *pixels.shape[2:])
    return picked


def _resample_interpolated(pixels: Pixels, optics: Optics) -> Pixels:
    """Return the colours of a pinhole image as seen through a lens, with bilinear interpolation."""
    column = np.clip(optics.sources[0], 0, optics.pinhole.width - 1.001)
    row = np.clip(optics.sources[1], 0, optics.pinhole.height - 1.001)
    left, top = column.astype(int), row.astype(int)
    right, below = (column - left)[:, None], (row - top)[:, None]
    upper = pixels[top, left] * (1 - right) + pixels[top, left + 1] * right
    lower = pixels[top + 1, left] * (1 - right) + pixels[top + 1, left + 1] * right
    mixed: Pixels = np.round(upper * (1 - below) + lower * below)
    return mixed.astype(np.uint8).reshape(optics.height, optics.width, 3)
