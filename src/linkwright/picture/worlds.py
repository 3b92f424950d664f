"""Scenes of worlds and models in SDF."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Placement, Sphere
from linkwright.geometry.single import IDENTITY, Transform, normalized, rotation_matrix
from linkwright.geometry.surfaces import cone
from linkwright.picture.bodies import Anchor, Body, Labels, Surface, Texture
from linkwright.picture.materials import ROUND_SIDES, SurfaceLibrary, decode_texture, make_shape_surface
from linkwright.picture.scene import Scene
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, place_links, placed_links
from linkwright.sdf.links import Visual
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.scripts import find_appearance
from linkwright.sdf.shapes import Cone, Ellipsoid, Empty, Mesh, Plane, Shape
from linkwright.sdf.worlds import Sdf

_DEFAULT_COLOR = (0.7, 0.7, 0.7, 1.0)
"""The color of shapes without a material: gray, as in Gazebo."""
_MIN_GROUND_RATIO = 3.0
"""The minimum ratio of the sizes of the ground and of everything else."""
_MAX_GROUND_THICKNESS = 0.05
"""The maximum height of the ground, as a fraction of its width."""
_POSE_GRID = float(1 << 36)
"""Poses are rounded to multiples of 1 / _POSE_GRID, because the last bits of sines differ between machines."""


def world_scene(sdf: Sdf, finder: ResourceFinder, *, library: SurfaceLibrary | None = None) -> Scene:
    """Return the scene of the visuals of a world, or of the models in a file.

    Planes are left out: a plane is the ground of an image. A flat link that is much larger than everything else is the
    ground as well, and images need not show it as a whole. Heightmaps and extruded polygons are left out with a
    finding.

    Args:
        sdf: the world, with its includes resolved.
        finder: finds meshes and textures.
        library: the meshes that were already read, to share them between scenes.

    Raises:
        FrameError: a link cannot be placed.
    """
    reader = _WorldReader(library or SurfaceLibrary(), finder)
    bodies, anchors = [], []
    for placed_link in _iterate_placed_links(sdf):
        frame = _placement_from_pose(placed_link.pose)
        bodies.append(Body(placed_link.name, frame, tuple(reader.read_surfaces(placed_link))))
        anchors.append(Anchor(placed_link.name, frame.position))
    return Scene(_find_ground(bodies), reader.problems, Labels(tuple(anchors)))


def _find_ground(bodies: Sequence[Body]) -> list[Body]:
    """Return the bodies, with a flat one that is much larger than all others marked as the ground."""
    boxes = [_compute_box(body) for body in bodies]
    sizes = [0.0 if box is None else float(np.linalg.norm(box[1] - box[0])) for box in boxes]
    if len(bodies) < 2:
        return list(bodies)
    largest = int(np.argmax(sizes))
    others = [box for index, box in enumerate(boxes) if box is not None and index != largest]
    ground = boxes[largest]
    if ground is None or not others:
        return list(bodies)
    low, high = np.min([box[0] for box in others], axis=0), np.max([box[1] for box in others], axis=0)
    lengths = ground[1] - ground[0]
    is_flat = lengths[2] <= _MAX_GROUND_THICKNESS * min(lengths[:2])
    if not is_flat or sizes[largest] < _MIN_GROUND_RATIO * float(np.linalg.norm(high - low)):
        return list(bodies)
    return [replace(body, is_ground=index == largest) for index, body in enumerate(bodies)]


def _compute_box(body: Body) -> tuple[Array, Array] | None:
    """Return the corners of the box around a body in the scene, or None if it has no surfaces."""
    points = [surface.placed(body.frame).points for surface in body.surfaces if len(surface.points)]
    if not points:
        return None
    return np.min([array.min(axis=0) for array in points], axis=0), np.max(
        [array.max(axis=0) for array in points], axis=0
    )


def _iterate_placed_links(sdf: Sdf) -> Iterator[PlacedLink]:
    for world in sdf.worlds[:1]:
        yield from placed_links(world)
    if not sdf.worlds:
        for model in sdf.models:
            yield from place_links(model, Frames(model), IDENTITY, model.name)


def _placement_from_pose(pose: Transform) -> Placement:
    x, y, z, *quaternion = (round(value * _POSE_GRID) / _POSE_GRID for value in pose)
    return Placement(rotation_matrix(normalized(*quaternion)), (x, y, z))


class _WorldReader:
    """A converter of SDF visuals to surfaces.

    Attributes:
        problems: the findings about visuals that are drawn incompletely.
    """

    def __init__(self, library: SurfaceLibrary, finder: ResourceFinder) -> None:
        self.problems: list[Diagnostic] = []
        self._library = library
        self._finder = finder
        self._files: dict[tuple[str, Path], Path | Missing] = {}

    def read_surfaces(self, placed_link: PlacedLink) -> Iterator[Surface]:
        """Yield the surfaces of a link's visuals in the link's frame."""
        link, frames = placed_link.link, placed_link.frames
        for visual in link.visuals:
            try:
                frame = _placement_from_pose(frames.in_link(visual.pose, link.name))
            except FrameError:
                continue  # The check of references reports this error.
            for surface in self._read_visual(placed_link.name, visual):
                surface_in_link = surface.placed(frame)
                if surface_in_link.is_in_range:
                    yield surface_in_link
                else:
                    self._add_incomplete(placed_link.name, phrase("a coordinate is out of range"))

    def _read_visual(self, link: str, visual: Visual) -> Iterator[Surface]:
        color, image = find_appearance(visual.material) if visual.material else (None, "")
        red, green, blue, alpha = color or _DEFAULT_COLOR
        alpha *= 1.0 - visual.transparency
        texture = self._read_texture(link, visual, image) if image else None
        if texture is not None:
            red = green = blue = 1.0
        geometry = visual.geometry
        if isinstance(geometry, Mesh):
            for surface, has_material in self._read_mesh(link, visual, geometry):
                keeps_color = has_material and color is None and not image
                yield surface.colored(surface.color if keeps_color else (red, green, blue), alpha)
            return
        simple = self._read_simple_shape(link, geometry, texture)
        if simple is not None:
            yield simple.colored((red, green, blue), alpha)

    def _read_simple_shape(self, link: str, shape: Shape, texture: Texture | None) -> Surface | None:
        if isinstance(shape, Box | Cylinder | Capsule | Sphere):
            return make_shape_surface(shape, texture)
        if isinstance(shape, Ellipsoid):
            return make_shape_surface(Sphere(1.0), texture).scaled(shape.radii)
        if isinstance(shape, Cone):
            return Surface.of_triangles(cone(shape.radius, shape.length, ROUND_SIDES), texture)
        if not isinstance(shape, Plane | Empty):
            self._add_incomplete(link, phrase("its shape is neither a mesh nor a simple shape"))
        return None

    def _read_mesh(self, link: str, visual: Visual, mesh: Mesh) -> Iterator[tuple[Surface, bool]]:
        path = self._find_file(visual, mesh.uri)
        if isinstance(path, Missing):
            self._add_incomplete(link, path.reason, path.hint)
            return
        try:
            parts = self._library.read(path, with_names=mesh.submesh is not None)
        except LinkwrightError as error:
            self._add_incomplete(link, error.diagnostics[0].message, error.diagnostics[0].hint)
            return
        submesh = mesh.submesh
        for part in parts:
            if submesh is not None and submesh.name not in part.names:
                continue
            surface, file_material = part.surface, part.file_material
            if submesh is not None and submesh.center:
                middle = (surface.points.min(axis=0) + surface.points.max(axis=0)) / 2
                surface = replace(surface, points=surface.points - middle)
            own_color = (1.0, 1.0, 1.0) if file_material is None else file_material.color
            yield surface.scaled(mesh.scale).colored(own_color, 1.0), file_material is not None

    def _read_texture(self, link: str, visual: Visual, address: str) -> Texture | None:
        path = self._find_file(visual, address)
        try:
            texture = None if isinstance(path, Missing) else decode_texture(path.read_bytes())
        except OSError:
            texture = None
        if texture is None:
            message = phrase("link '{link}' is drawn without its texture '{name}'", link=link, name=address)
            self._add(Diagnostic("PIC102", message, severity=Severity.WARNING))
        return texture

    def _find_file(self, visual: Visual, address: str) -> Path | Missing:
        source = visual.element.source if visual.element is not None else None
        key = address, Path.cwd() if source is None else Path(source.name).parent
        if key not in self._files:
            self._files[key] = self._finder.file(*key)
        return self._files[key]

    def _add_incomplete(self, link: str, reason: Phrase, hint: Phrase | None = None) -> None:
        message = phrase("link '{link}' is drawn incompletely: {reason}", link=link, reason=reason)
        self._add(Diagnostic("PIC101", message, severity=Severity.WARNING, hint=hint))

    def _add(self, problem: Diagnostic) -> None:
        if problem not in self.problems:
            self.problems.append(problem)
