"""Read mesh files with their materials, as triangles grouped by material.

The rules for materials are those of RViz, which the page also follows.
"""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import missing_extra
from linkwright.geometry.arrays import Array, transform_points
from linkwright.geometry.collada_colors import read_colored_meshes
from linkwright.geometry.mesh_files import BadMeshError, PlacedMesh, describe_parser_error, read_placed_meshes
from linkwright.loading.lean_dataclasses import dataclass, replace
from linkwright.loading.lean_typing import Any


@dataclass(frozen=True, slots=True)
class Triangles:
    """A surface of triangles.

    Attributes:
        positions: the corners in m, shape (N, 3).
        indices: the indices of corners in a flat array, three per triangle, counterclockwise from outside.
        normals: the normals at the corners, shape (N, 3), or None for flat triangles.
        coordinates: texture coordinates from the upper left corner of the texture, shape (N, 2), or None.
        colors: red, green, blue and alpha of each corner, 0 to 1, shape (N, 4), or None.
    """

    positions: Array
    indices: NDArray[np.int64]
    normals: Array | None = None
    coordinates: Array | None = None
    colors: Array | None = None


UNCOLORED = 0.6
"""The gray value of a mesh without a color, from 0 for black to 1 for white."""

_Y_UP_TO_Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""The matrix that converts glTF's axes, with y up, to axes with z up."""


@dataclass(frozen=True, slots=True)
class FileMaterial:
    """A material from the mesh file.

    Attributes:
        color: red, green and blue as displayed, 0 to 1.
        image: the texture as PNG, or None.
    """

    color: tuple[float, float, float]
    image: bytes | None = None


@dataclass(frozen=True, slots=True)
class MeshPart:
    """Triangles with one material, in the frame of the file.

    Attributes:
        triangles: the triangles.
        file_material: the material from the file; None to use the material of the description.
        names: the names of the part in the file.
    """

    triangles: Triangles
    file_material: FileMaterial | None
    names: frozenset[str] = frozenset()

    def moved(self, offset: Array) -> MeshPart:
        """Return a copy of the part moved by an offset in m, shape (3,)."""
        return replace(self, triangles=replace(self.triangles, positions=self.triangles.positions + offset))


def read_simple_parts(path: Path) -> list[MeshPart] | None:
    """Return the parts of a COLLADA file without normals and names, or None if `read_parts` is needed.

    Such a file has textures, unusual content or mistakes. Unlike `read_parts`, this needs no library.

    Raises:
        OSError: the file cannot be read.
    """
    meshes = read_colored_meshes(path.read_bytes()) if path.suffix.lower() == ".dae" else None
    if not meshes:
        return None
    parts = []
    for mesh, matrix, unit, color in meshes:
        placed_mesh = PlacedMesh(mesh, np.diag([unit, unit, unit, 1.0]) @ matrix, 1.0, frozenset())
        triangles = _create_triangles(placed_mesh, placed_mesh.matrix, smooth=False)
        parts.append(MeshPart(triangles, None if color is None else FileMaterial(color)))
    return parts


def read_parts(path: Path, *, resolver: Any, with_normals: bool = True) -> list[MeshPart]:
    """Return the parts of an STL, COLLADA, OBJ or glTF file.

    Args:
        path: the path of the file.
        resolver: provides files that the mesh file refers to, by ``get(name)``, as trimesh expects.
        with_normals: whether to return the normals of smooth surfaces.

    Raises:
        BadMeshError: the file cannot be read; the message gives the reason.
        LinkwrightError: INR104, a library for the file is not installed.
    """
    kind = path.suffix.lower().removeprefix(".")
    try:
        return _read_parts(path.read_bytes(), "stl" if kind == "stlb" else kind, resolver, with_normals)
    except ModuleNotFoundError as error:
        raise missing_extra("INR104", error) from None
    except BadMeshError:
        raise
    except Exception as error:  # noqa: BLE001 - an unknown image or material may raise anything
        raise BadMeshError(describe_parser_error(error)) from None


def _read_parts(data: bytes, kind: str, resolver: Any, with_normals: bool) -> list[MeshPart]:
    parts = []
    for placed_mesh in read_placed_meshes(data, kind, resolver=resolver):
        matrix = placed_mesh.matrix
        if kind == "dae":
            matrix = np.diag([*[placed_mesh.unit] * 3, 1.0]) @ matrix
        elif kind in ("glb", "gltf"):
            matrix = _Y_UP_TO_Z_UP @ matrix
        parts.append(
            MeshPart(
                _create_triangles(placed_mesh, matrix, smooth=with_normals and kind != "stl"),
                _read_file_material(placed_mesh.mesh, kind),
                placed_mesh.names,
            )
        )
    return parts


def _create_triangles(placed_mesh: PlacedMesh, matrix: Array, *, smooth: bool) -> Triangles:
    mesh, faces = placed_mesh.mesh, placed_mesh.faces
    positions = transform_points(matrix, mesh.vertices)
    normals = _compute_normals(mesh, positions, faces, matrix) if smooth else None
    uv = getattr(mesh.visual, "uv", None)
    coordinates = None
    if uv is not None and np.shape(uv) == (len(positions), 2):
        coordinates = np.asarray(uv, dtype=np.float64) * (1, -1) + (0, 1)  # trimesh counts from the bottom.
    return Triangles(positions, faces.reshape(-1), normals, coordinates, _read_vertex_colors(mesh, len(positions)))


def _compute_normals(mesh: Any, positions: Array, faces: Any, matrix: Array) -> Array | None:
    """Return the unit normals at the corners, or None if one of them is zero.

    If the file contains no normals, the normals of the triangles are averaged.
    """
    if "vertex_normals" in mesh._cache.cache and len(mesh.vertex_normals) == len(positions):
        normals = np.asarray(mesh.vertex_normals, dtype=np.float64) @ np.linalg.pinv(matrix[:3, :3])
    else:
        a, b, c = (positions[faces[:, corner]] for corner in range(3))
        area_vectors = np.cross(b - a, c - a)
        normals = np.zeros_like(positions)
        for corner in range(3):
            np.add.at(normals, faces[:, corner], area_vectors)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / lengths if np.isfinite(lengths).all() and (lengths > 0).all() else None


def _read_vertex_colors(mesh: Any, count: int) -> Array | None:
    if mesh.visual.kind != "vertex":
        return None
    colors = np.asarray(mesh.visual.vertex_colors, dtype=np.float64) / 255.0
    return colors if colors.shape == (count, 4) else None


def _read_file_material(mesh: Any, kind: str) -> FileMaterial | None:
    if kind == "stl":
        return None
    if mesh.visual.kind == "vertex":
        return FileMaterial((1.0, 1.0, 1.0)) if kind != "dae" else None
    material = getattr(mesh.visual, "material", None)
    if material is None:
        return FileMaterial((1.0, 1.0, 1.0)) if kind in ("glb", "gltf") else None  # glTF's default is white.
    if kind == "obj":
        color = material.kwargs.get("kd", np.asarray(material.diffuse[:3]) / 255.0)
        return FileMaterial(_to_rgb(color), _image_to_png(getattr(material, "image", None)))
    factor = material.baseColorFactor
    color = np.ones(3) if factor is None else np.asarray(factor, dtype=np.float64)[:3] / 255.0
    return FileMaterial(_to_rgb(color), _image_to_png(material.baseColorTexture))


def _to_rgb(color: Any) -> tuple[float, float, float]:
    red, green, blue = (min(1.0, max(0.0, float(component))) for component in list(color)[:3])
    return red, green, blue


def read_png(path: Path) -> bytes | None:
    """Return an image file as PNG, or None if it is not an image or Pillow is missing."""
    try:
        return _to_png(path.read_bytes())
    except (ModuleNotFoundError, OSError, ValueError, SyntaxError):
        return None


def _image_to_png(image: Any) -> bytes | None:
    """Return an image as PNG data, or None if the image is None.

    The data that the image was read from is reused if it is PNG, because encoding is slow.
    """
    if image is None:
        return None
    source = getattr(image, "fp", None)  # Pillow keeps the file until the pixels are decoded.
    return _to_png(source.getvalue()) if isinstance(source, BytesIO) else _encode_png(image)


@lru_cache(maxsize=8)
def _to_png(data: bytes) -> bytes:
    """Convert image data to PNG.

    Results are cached, because many meshes share an image.
    """
    from PIL import Image  # Pillow is an optional extra.

    image = Image.open(BytesIO(data))
    if image.format != "PNG":
        return _encode_png(image)
    image.verify()
    return data


def _encode_png(image: Any) -> bytes:
    file = BytesIO()
    image.convert("RGBA" if image.mode in ("RGBA", "LA", "PA", "P") else "RGB").save(file, "PNG")
    return file.getvalue()
