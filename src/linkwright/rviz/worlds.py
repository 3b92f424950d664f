"""Convert a world to the page's form: shapes and initial poses of all links."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Transform, compose, rotation_from_z
from linkwright.images.heights import read_heights
from linkwright.page.files import IMAGE_TYPES, MESH_TYPES, MeshIndex
from linkwright.page.protocol.robot import LinkScene, Shape, Submesh, Surface
from linkwright.sdf.frames import Frames, PlacedLink, place_links
from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.materials import Workflow
from linkwright.sdf.plugins import library_name
from linkwright.sdf.poses import RawPose
from linkwright.sdf.scripts import find_appearance
from linkwright.sdf.shapes import (
    Cone,
    Ellipsoid,
    Empty,
    Heightmap,
    Image,
    Mesh,
    Plane,
    Polyline,
)
from linkwright.sdf.shapes import Shape as SdfShape
from linkwright.sdf.worlds import World

_DEFAULT_COLOR = (0.7, 0.7, 0.7, 1.0)
"""The color of shapes without a material: gray, as in Gazebo."""
_MAX_HEIGHTS = 257
"""The largest number of heights along a side of a heightmap."""
_WAVE_VISUAL = "WaveVisual"
_COLLISION_COLOR = [1.0, 0.55, 0.1, 0.6]

_PoseInLink = Callable[[RawPose], Transform]
"""Converts the pose of a visual or collision to the frame of its link."""


@dataclass(slots=True)
class WorldContent:
    """The content that is drawn for a world.

    Attributes:
        links: all links that draw something or move, named as in the poses of the simulation: ``robot::arm::tip``.
        poses: the initial pose of each link in the world.
        problems: the problems with mesh and texture files, by link name.
    """

    links: list[LinkScene] = field(default_factory=list)
    poses: list[Transform] = field(default_factory=list)
    problems: dict[str, list[str]] = field(default_factory=dict)


def make_content(world: World, index: MeshIndex) -> WorldContent:
    """Return the content drawn for a world.

    Args:
        world: the world, with its includes resolved.
        index: finds the files that the world refers to, and collects them.

    Raises:
        FrameError: the pose of an element cannot be determined.
    """
    return _Builder(index).build(world)


class _Builder:
    def __init__(self, index: MeshIndex) -> None:
        self._index = index
        self._content = WorldContent()

    def build(self, world: World) -> WorldContent:
        frames = Frames(world)
        for model in world.models:
            model_frames = frames.inside(model.name)
            for placed_link in place_links(model, model_frames, frames.pose(model.name), model.name):
                self._add_link(placed_link)
        return self._content

    def _add_link(self, placed_link: PlacedLink) -> None:
        link, frames, content = placed_link.link, placed_link.frames, self._content

        def pose(raw: RawPose) -> Transform:
            return frames.in_link(raw, link.name)

        content.poses.append(placed_link.pose)
        content.links.append(
            LinkScene(
                name=placed_link.name,
                frame=placed_link.name,
                parent_joint=None,
                visuals=list(self._make_shapes(placed_link.name, link.visuals, pose)),
                collisions=list(self._make_shapes(placed_link.name, link.collisions, pose)),
            )
        )

    def _make_shapes(
        self, link: str, elements: Sequence[Visual | Collision], pose_in_link: _PoseInLink
    ) -> Iterator[Shape]:
        for element in elements:
            if isinstance(element, Visual) and _is_water(element):
                continue
            shape = self._make_shape(link, element, pose_in_link(element.pose))
            if shape is not None:
                yield shape

    def _make_shape(self, link: str, element: Visual | Collision, pose: Transform) -> Shape | None:
        shape = Shape(kind="mesh", size=[], position=[], quaternion=[], name=element.name)
        if isinstance(element, Visual):
            self._set_material(link, shape, element)
        else:
            shape.color, shape.repaints = list(_COLLISION_COLOR), True
        pose = compose(pose, self._set_geometry(link, shape, element.geometry) or (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        shape.position, shape.quaternion = list(pose[:3]), list(pose[3:])
        return shape if shape.size else None

    def _set_geometry(self, link: str, shape: Shape, geometry: SdfShape) -> Transform | None:
        """Set the kind and the size of a shape, and return its pose in the geometry's frame.

        None means the identity.
        """
        match geometry:
            case Box():
                shape.kind, shape.size = "box", list(geometry.size)
            case Cylinder():
                shape.kind, shape.size = "cylinder", [geometry.radius, geometry.length]
            case Capsule():
                shape.kind, shape.size = "capsule", [geometry.radius, geometry.length]
            case Sphere():
                shape.kind, shape.size = "sphere", [geometry.radius]
            case Ellipsoid():
                shape.kind, shape.size = "ellipsoid", list(geometry.radii)
            case Cone():
                shape.kind, shape.size = "cone", [geometry.radius, geometry.length]
            case Plane():
                shape.kind, shape.size = "plane", list(geometry.size)
                return (0.0, 0.0, 0.0, *rotation_from_z(geometry.normal))
            case Polyline():
                self._set_polygons(shape, (geometry,))
            case tuple():
                self._set_polygons(shape, geometry)
            case Heightmap():
                self._set_terrain(link, shape, geometry)
            case Mesh():
                self._set_mesh(link, shape, geometry)
            case Image() | Empty():
                pass
        return None

    def _set_polygons(self, shape: Shape, polygons: Sequence[Polyline]) -> None:
        shape.kind, shape.size = "polyline", [polygons[0].height]
        shape.outlines = [[number for point in polygon.points for number in point] for polygon in polygons]

    def _set_mesh(self, link: str, shape: Shape, mesh: Mesh) -> None:
        shape.url = self._find_url(link, mesh.uri, MESH_TYPES)
        if shape.url is None:
            return
        shape.size = list(mesh.scale)
        shape.format = mesh.uri.rpartition(".")[2].lower()
        if mesh.submesh is not None:
            shape.submesh = Submesh(mesh.submesh.name, mesh.submesh.center)

    def _set_terrain(self, link: str, shape: Shape, terrain: Heightmap) -> None:
        heights = self._read_heights(link, terrain.uri)
        if heights is None:
            return
        shape.heights, shape.columns = heights.ravel(), heights.shape[1]
        texture = terrain.textures[0] if terrain.textures else None
        shape.kind = "heightmap"
        shape.size = [*terrain.size, *terrain.position, texture.size if texture else 1.0]
        if texture is not None and texture.diffuse:
            shape.texture = self._find_url(link, texture.diffuse, IMAGE_TYPES)

    def _read_heights(self, link: str, uri: str) -> NDArray[np.float32] | None:
        """Return the heights of a heightmap as in the simulation, or None if it cannot be read.

        The image is decoded here, because browsers decode neither TIFF nor 16-bit gray.
        """
        if self._find_url(link, uri, IMAGE_TYPES) is None:
            return None
        try:
            values = read_heights(self._index.finder.resolve(uri)).values
        except LinkwrightError as error:
            self._add_problem(link, error.diagnostics[0].message)
            return None
        rows, columns = (np.linspace(0, size - 1, min(size, _MAX_HEIGHTS)).round().astype(int) for size in values.shape)
        samples: NDArray[np.float32] = values[np.ix_(rows, columns)].astype(np.float32)
        return samples

    def _set_material(self, link: str, shape: Shape, visual: Visual) -> None:
        material = visual.material
        color, image = find_appearance(material) if material else (None, "")
        shape.repaints = color is not None or image != ""
        if color is None:
            color = _DEFAULT_COLOR
        red, green, blue, alpha = color
        shape.color = [red, green, blue, alpha * (1.0 - visual.transparency)]
        if image:
            shape.texture = self._find_url(link, image, IMAGE_TYPES)
        workflow = material.pbr.metal if material and material.pbr else None
        if workflow and _has_surface(workflow):
            urls = [self._find_url(link, file, IMAGE_TYPES) if file else None for file in _list_maps(workflow)]
            shape.surface = Surface(workflow.roughness, workflow.metalness, *urls)

    def _find_url(self, link: str, uri: str, types: dict[str, str]) -> str | None:
        located = self._index.locate(uri, None, types)
        if located.url is None:
            self._add_problem(link, f"Could not load '{uri}': {located.problem}")
        return located.url

    def _add_problem(self, link: str, text: str) -> None:
        problems = self._content.problems.setdefault(link, [])
        if text not in problems:
            problems.append(text)


def _list_maps(workflow: Workflow) -> tuple[str, ...]:
    """Return the texture files of a material except the albedo map, in the order of `Surface`."""
    surface_maps = (workflow.normal_map, workflow.roughness_map, workflow.metalness_map)
    return (*surface_maps, workflow.emissive_map, workflow.ambient_occlusion_map)


def _has_surface(workflow: Workflow) -> bool:
    """Return whether a material has images other than the color image, roughness or metalness."""
    default = Workflow()
    return any(_list_maps(workflow)) or (workflow.roughness, workflow.metalness) != (
        default.roughness,
        default.metalness,
    )


def _is_water(visual: Visual) -> bool:
    """Return whether a visual is the water of VRX, whose shape a shader moves: the moving surface is drawn instead."""
    return any(library_name(plugin.filename) == _WAVE_VISUAL for plugin in visual.plugins)
