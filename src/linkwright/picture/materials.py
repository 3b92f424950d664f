"""Surfaces of shapes and mesh files, with their materials."""

from __future__ import annotations

import os
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.mesh_content import ContentKey, surface_key
from linkwright.geometry.mesh_files import MESH_SUFFIXES, BadMeshError, create_file_resolver
from linkwright.geometry.mesh_parts import UNCOLORED, FileMaterial, MeshPart, Triangles, read_parts, read_simple_parts
from linkwright.geometry.meshes import MAX_FILE_SIZE, read_mesh, unreadable_mesh_error
from linkwright.geometry.shapes import Box, Capsule, Cylinder, SimpleShape
from linkwright.geometry.surfaces import box, capsule, cylinder, sphere
from linkwright.picture.bodies import Color, Surface, Texture

ROUND_SIDES = 72
"""The number of sides of round shapes, which is high enough that their edges are invisible."""
DEFAULT_COLOR: Color = (1.0, 0.0, 0.0)
"""The color of a shape without a material, as in RViz."""
_MAX_TEXTURE_SIDE = 768
"""The maximum width and height of textures in pixels. Larger textures are downsampled."""
_MISSING_EXTRA_CODE = "INR104"


@dataclass(frozen=True, eq=False, slots=True)
class MeshSurface:
    """A part of a mesh file with one material.

    Attributes:
        surface: the white surface of the part, in meters.
        file_material: the material in the file; None to use that of the description.
        names: the names of the part in the file.
    """

    surface: Surface
    file_material: FileMaterial | None
    names: frozenset[str]


class SurfaceLibrary:
    """A cache of the surfaces of mesh files, which reads each file once.

    Attributes:
        errors_of_colorless_files: the files that were read without their colors, because a library is not installed,
            each with the error that names the library.
    """

    def __init__(self) -> None:
        self.errors_of_colorless_files: dict[Path, LinkwrightError] = {}
        self._surfaces: dict[tuple[str, int, int, bool], list[MeshSurface]] = {}
        self._by_content: dict[tuple[ContentKey, bool], list[MeshSurface]] = {}

    def read(self, path: Path, *, with_names: bool = False) -> list[MeshSurface]:
        """Return the surfaces of a mesh file.

        Args:
            path: the path of the file.
            with_names: whether the surfaces must have their names.

        Raises:
            LinkwrightError: INR101 to INR104, the file cannot be read.
        """
        try:
            status = path.stat()
        except OSError as error:
            read_mesh(path)  # raises an error with the reason
            raise unreadable_mesh_error(path, error.strerror or str(error)) from None
        key = os.path.realpath(path), status.st_mtime_ns, status.st_size, with_names
        if key not in self._surfaces:
            content = surface_key(path)
            known = None if content is None else self._by_content.get((content, with_names))
            self._surfaces[key] = self._read(path, status.st_size, with_names=with_names) if known is None else known
            if content is not None:
                self._by_content[content, with_names] = self._surfaces[key]
        return self._surfaces[key]

    def _read(self, path: Path, size: int, *, with_names: bool) -> list[MeshSurface]:
        return [
            MeshSurface(Surface.of_triangles(part.triangles, _read_texture(part)), part.file_material, part.names)
            for part in self._read_parts(path, size, with_names=with_names)
            if len(part.triangles.indices)
        ]

    def _read_parts(self, path: Path, size: int, *, with_names: bool) -> list[MeshPart]:
        kind = path.suffix.lower()
        if size > MAX_FILE_SIZE or kind == ".stl" or kind not in MESH_SUFFIXES or not path.is_file():
            return [_read_plain_part(path)]
        simple_parts = None if with_names else read_simple_parts(path)
        if simple_parts is not None:
            return simple_parts
        try:
            return read_parts(path, resolver=_make_resolver(path), with_normals=False)
        except BadMeshError as error:
            raise unreadable_mesh_error(path, error.reason) from None
        except LinkwrightError as error:
            if error.diagnostics[0].code != _MISSING_EXTRA_CODE:
                raise
            part = _read_plain_part(path)
            self.errors_of_colorless_files[path] = error
            return [part]


def _make_resolver(path: Path) -> object:
    try:
        return create_file_resolver(str(path))
    except ModuleNotFoundError:
        return None  # the reader reports the missing library


def _read_plain_part(path: Path) -> MeshPart:
    """Return the triangles of a mesh file as one surface without its colors."""
    mesh = read_mesh(path)
    return MeshPart(Triangles(mesh.vertices, np.asarray(mesh.faces, np.int64).reshape(-1)), None)


def make_shape_surface(shape: SimpleShape, texture: Texture | None = None) -> Surface:
    """Return the surface of a primitive shape."""
    if isinstance(shape, Box):
        triangles = box(shape.size)
    elif isinstance(shape, Cylinder):
        triangles = cylinder(shape.radius, shape.length, ROUND_SIDES)
    elif isinstance(shape, Capsule):
        triangles = capsule(shape.radius, shape.length, ROUND_SIDES)
    else:
        triangles = sphere(shape.radius, ROUND_SIDES)
    return Surface.of_triangles(triangles, texture)


def choose_surface_color(
    file_material: FileMaterial | None, description_color: Color | None, *, is_textured: bool, format_has_colors: bool
) -> Color:
    """Return the color of a surface by RViz's rules.

    Args:
        file_material: the material in the mesh file, which takes precedence over the description's.
        description_color: the color in the description, or None.
        is_textured: whether the description sets a texture.
        format_has_colors: whether the surface is that of a mesh file whose format has colors.
    """
    if file_material is not None:
        return file_material.color
    if is_textured:
        return 1.0, 1.0, 1.0
    if description_color is not None:
        return description_color
    return (UNCOLORED,) * 3 if format_has_colors else DEFAULT_COLOR


def _read_texture(part: MeshPart) -> Texture | None:
    image = part.file_material.image if part.file_material is not None else None
    return None if image is None or part.triangles.coordinates is None else decode_texture(image)


def decode_texture(data: bytes) -> Texture | None:
    """Return the pixels of an image file, or None if they cannot be decoded.

    Decoding may fail because Pillow is missing.
    """
    try:
        from PIL import Image
    except ModuleNotFoundError:
        return None
    try:
        pixels: Texture = np.asarray(Image.open(BytesIO(data)).convert("RGB"), np.uint8)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    factor = -(-max(pixels.shape[:2]) // _MAX_TEXTURE_SIDE)
    height, width = (pixels.shape[0] // factor) * factor, (pixels.shape[1] // factor) * factor
    if factor == 1 or not height or not width:
        return pixels
    sums = np.zeros((height // factor, width // factor, 3), np.int64)
    for row in range(factor):
        for column in range(factor):
            sums += pixels[row:height:factor, column:width:factor]
    return np.asarray(sums // (factor * factor), np.uint8)
