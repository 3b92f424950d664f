"""Triangles with materials: mesh files, by the rules of RViz that the page follows too, and URDF's shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import missing_extra
from linkwright.geometry.mesh_files import BadMeshError, PlacedMesh, placed_meshes, said_by_parser

Array = NDArray[np.float64]
_SIDES = 32
_RINGS = 16


@dataclass(frozen=True, slots=True)
class Triangles:
    """A surface.

    Attributes:
        positions: shape (N, 3), metres.
        indices: three of each triangle, counterclockwise from outside; flat.
        normals: shape (N, 3), or None for flat triangles.
        coordinates: of a texture, shape (N, 2), from its upper left corner; None without.
        colors: red, green, blue and alpha of each corner, 0 to 1, shape (N, 4); None without.
    """

    positions: Array
    indices: NDArray[np.int64]
    normals: Array | None = None
    coordinates: Array | None = None
    colors: Array | None = None


def box(size: Sequence[float]) -> Triangles:
    """Around the origin."""
    positions, normals, coordinates = [], [], []
    for axis in range(3):
        for side in (1.0, -1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            normal = np.eye(3)[axis] * side
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                positions.append(normal + (u * a * side) + v * b)
                normals.append(normal)
                coordinates.append(((a + 1) / 2, (1 - b) / 2))
    quads = np.arange(6)[:, np.newaxis] * 4 + np.array([0, 1, 2, 0, 2, 3])
    scale = np.asarray(size, dtype=np.float64) / 2
    return Triangles(np.array(positions) * scale, quads.reshape(-1), np.array(normals), np.array(coordinates))


def cylinder(radius: float, length: float) -> Triangles:
    """Along z, around the origin, with caps."""
    half = length / 2
    profile = [(0.0, half, 0, 1), (radius, half, 0, 1), (radius, half, 1, 0), (radius, -half, 1, 0)]
    profile += [(radius, -half, 0, -1), (0.0, -half, 0, -1)]
    return _turned(np.array(profile, dtype=np.float64))


def sphere(radius: float) -> Triangles:
    """Around the origin."""
    angles = np.linspace(np.pi / 2, -np.pi / 2, _RINGS + 1)
    cosines, sines = np.cos(angles), np.sin(angles)
    return _turned(np.stack([radius * cosines, radius * sines, cosines, sines], axis=1))


def capsule(radius: float, length: float) -> Triangles:
    """A cylinder along z, around the origin, with half spheres beyond its ends."""
    angles = np.linspace(np.pi / 2, -np.pi / 2, _RINGS + 1)
    angles = np.insert(angles, _RINGS // 2, 0.0)
    shift = np.where(np.arange(_RINGS + 2) <= _RINGS // 2, length / 2, -length / 2)
    cosines, sines = np.cos(angles), np.sin(angles)
    return _turned(np.stack([radius * cosines, radius * sines + shift, cosines, sines], axis=1))


def _turned(profile: Array) -> Triangles:
    """The surface that a profile from top to bottom sweeps around z; its rows are r, z and the normal's r, z."""
    around = np.linspace(0.0, 2 * np.pi, _SIDES + 1)
    cosines, sines = np.cos(around), np.sin(around)
    rows, columns = len(profile), _SIDES + 1
    radius, height, normal_r, normal_z = (column[:, np.newaxis] for column in profile.T)
    level = np.ones_like(cosines)
    positions = np.stack([radius * cosines, radius * sines, height * level], axis=2).reshape(-1, 3)
    normals = np.stack([normal_r * cosines, normal_r * sines, normal_z * level], axis=2).reshape(-1, 3)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    u = np.broadcast_to(around / (2 * np.pi), (rows, columns))
    v = np.broadcast_to(np.linspace(0.0, 1.0, rows)[:, np.newaxis], (rows, columns))
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(_SIDES), indexing="ij")
    first = (row * columns + column).reshape(-1)
    below = first + columns
    triangles = np.stack([first, below, below + 1, first, below + 1, first + 1], axis=1)
    corners = positions[triangles.reshape(-1, 3)]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    kept = triangles.reshape(-1, 3)[areas > 1e-9 * max(areas.max(initial=0.0), 1e-300)]
    return Triangles(positions, kept.reshape(-1), normals / lengths, np.stack([u, v], axis=2).reshape(-1, 2))


UNCOLOURED = 0.6
"""The grey of a mesh that says nothing of its colour."""

_UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""glTF's y up turned to z up."""


@dataclass(frozen=True, slots=True)
class OwnLook:
    """A material that came with the file.

    Attributes:
        color: red, green, blue as they are to be seen, 0 to 1.
        image: its texture as PNG, or None.
    """

    color: tuple[float, float, float]
    image: bytes | None = None


@dataclass(frozen=True, slots=True)
class MeshPart:
    """Triangles in the frame of the file, and their material; None where the URDF's applies."""

    triangles: Triangles
    own: OwnLook | None


def read_parts(path: Path, *, resolver: Any) -> list[MeshPart]:
    """The parts of an STL, COLLADA, OBJ or glTF file.

    Args:
        path: of the file.
        resolver: gives trimesh the files that it names, by ``get(name)``.

    Raises:
        BadMeshError: it cannot be read; says why.
        LinkwrightError: VIEW205, a library for it is not installed.
    """
    kind = path.suffix.lower().removeprefix(".")
    try:
        return _parts(path.read_bytes(), "stl" if kind == "stlb" else kind, resolver)
    except ModuleNotFoundError as error:
        raise missing_extra("VIEW205", error) from None
    except BadMeshError:
        raise
    except Exception as error:  # noqa: BLE001 - of a foreign picture or material anything may come
        raise BadMeshError(said_by_parser(error)) from None


def _parts(data: bytes, kind: str, resolver: Any) -> list[MeshPart]:
    parts = []
    for placed in placed_meshes(data, kind, resolver=resolver):
        matrix = placed.matrix
        if kind == "dae":
            matrix = np.diag([*[placed.unit] * 3, 1.0]) @ matrix
        elif kind in ("glb", "gltf"):
            matrix = _UPRIGHT @ matrix
        parts.append(MeshPart(_triangles(placed, matrix, smooth=kind != "stl"), _own(placed.mesh, kind)))
    return parts


def _triangles(placed: PlacedMesh, matrix: Array, *, smooth: bool) -> Triangles:
    mesh, faces = placed.mesh, placed.faces
    positions = np.asarray(mesh.vertices, dtype=np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    normals = _normals(mesh, positions, faces, matrix) if smooth else None
    uv = getattr(mesh.visual, "uv", None)
    coordinates = None
    if uv is not None and np.shape(uv) == (len(positions), 2):
        coordinates = np.asarray(uv, dtype=np.float64) * (1, -1) + (0, 1)  # trimesh counts from below
    return Triangles(positions, faces.reshape(-1), normals, coordinates, _vertex_colors(mesh, len(positions)))


def _normals(mesh: Any, positions: Array, faces: Any, matrix: Array) -> Array | None:
    """The normals of the file, else those that its triangles have at each corner together."""
    if "vertex_normals" in mesh._cache.cache and len(mesh.vertex_normals) == len(positions):
        normals = np.asarray(mesh.vertex_normals, dtype=np.float64) @ np.linalg.pinv(matrix[:3, :3])
    else:
        a, b, c = (positions[faces[:, corner]] for corner in range(3))
        areas = np.cross(b - a, c - a)
        normals = np.zeros_like(positions)
        for corner in range(3):
            np.add.at(normals, faces[:, corner], areas)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / lengths if np.isfinite(lengths).all() and (lengths > 0).all() else None


def _vertex_colors(mesh: Any, count: int) -> Array | None:
    if mesh.visual.kind != "vertex":
        return None
    colors = np.asarray(mesh.visual.vertex_colors, dtype=np.float64) / 255.0
    return colors if colors.shape == (count, 4) else None


def _own(mesh: Any, kind: str) -> OwnLook | None:
    if kind == "stl":
        return None
    if mesh.visual.kind == "vertex":
        return OwnLook((1.0, 1.0, 1.0)) if kind != "dae" else None
    material = getattr(mesh.visual, "material", None)
    if material is None:
        return OwnLook((1.0, 1.0, 1.0)) if kind in ("glb", "gltf") else None  # glTF's default material is white
    if kind == "obj":
        color = material.kwargs.get("kd", np.asarray(material.diffuse[:3]) / 255.0)
        return OwnLook(_rgb(color), _png(getattr(material, "image", None)))
    factor = material.baseColorFactor
    color = np.ones(3) if factor is None else np.asarray(factor, dtype=np.float64)[:3] / 255.0
    return OwnLook(_rgb(color), _png(material.baseColorTexture))


def _rgb(color: Any) -> tuple[float, float, float]:
    red, green, blue = (min(1.0, max(0.0, float(part))) for part in list(color)[:3])
    return red, green, blue


def _png(image: Any) -> bytes | None:
    if image is None:
        return None
    file = BytesIO()
    image.convert("RGBA" if image.mode in ("RGBA", "LA", "PA", "P") else "RGB").save(file, "PNG")
    return file.getvalue()
