"""Read the triangles in mesh files, in meters and in the frame that RViz uses."""

from __future__ import annotations

import stat
from functools import cached_property
from pathlib import Path

import numpy as np

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    display_path,
    joined,
    missing_extra,
    missing_file_hint,
    phrase,
)
from linkwright.geometry.arrays import Array
from linkwright.geometry.hull import convex_hull
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.mesh_files import MESH_SUFFIXES, BadMeshError, create_file_resolver, read_placed_meshes
from linkwright.geometry.outlines import COLLADA_PADDING
from linkwright.geometry.polyhedron import Faces, is_closed, merge_corners, polyhedron_properties
from linkwright.geometry.shapes import MAX_COORDINATE, Bounds
from linkwright.geometry.single import Vector3
from linkwright.loading.lean_typing import Any

MAX_FILE_SIZE = 1 << 29
"""The maximum size of a mesh file that is read, in bytes."""


class TriangleMesh:
    """The triangles of a mesh file.

    Attributes:
        vertices: corners in m, in the frame of the file, unscaled; shape (vertices, 3).
        faces: indices of corners; shape (faces, 3).
    """

    def __init__(self, vertices: Array, faces: Faces) -> None:
        self.vertices = vertices
        self.faces = faces
        self._scaled: dict[Vector3, TriangleMesh] = {}

    @cached_property
    def bounds(self) -> Bounds:
        """The bounding box of the triangles, in m."""
        if not len(self.faces):
            return Bounds((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        used_vertices = self.used_vertices
        (left, front, bottom), (right, back, top) = (
            used_vertices.min(axis=0).tolist(),
            used_vertices.max(axis=0).tolist(),
        )
        return Bounds((left, front, bottom), (right, back, top))

    @property
    def used_vertices(self) -> Array:
        """The corners of triangles in m, in the order of `vertices` and each once; shape (corners, 3)."""
        is_used = np.zeros(len(self.vertices), dtype=bool)
        is_used[self.faces.ravel()] = True
        used_vertices: Array = self.vertices[is_used]
        return used_vertices

    @property
    def count(self) -> int:
        """The number of triangles."""
        return len(self.faces)

    @cached_property
    def is_watertight(self) -> bool:
        """Whether the triangles bound a volume, without holes and with consistent orientation."""
        return is_closed(self._merged_surface[1])

    @cached_property
    def solid(self) -> MassProperties:
        """The mass properties of the mesh as a solid with a density of 1 kg/m3.

        If the mesh is not watertight, its convex hull is used. The mass is 0 if all triangles are coplanar.
        """
        vertices, faces = self._merged_surface
        if self.is_watertight:
            properties = polyhedron_properties(vertices, faces)
            if properties.mass > 0:
                return properties
        hull = convex_hull(vertices)
        return MassProperties(0.0) if hull is None else polyhedron_properties(vertices, hull)

    def scaled(self, scale: Vector3) -> TriangleMesh:
        """Return the mesh scaled along its axes, like the ``scale`` of a URDF mesh.

        A negative factor mirrors the mesh.
        """
        if scale == (1.0, 1.0, 1.0):
            return self
        mesh = self._scaled.get(scale)
        if mesh is None:
            mesh = self._scaled[scale] = TriangleMesh(self.vertices * np.asarray(scale), self.faces)
        return mesh

    @cached_property
    def _merged_surface(self) -> tuple[Array, Faces]:
        return merge_corners(self.vertices, self.faces)


def read_mesh(path: Path) -> TriangleMesh:
    """Return the triangles of an STL, COLLADA, OBJ or glTF file.

    STL and OBJ have no unit, and URDF takes their numbers as meters. As in RViz, the unit of COLLADA is applied, and
    its up axis is not. Materials and textures are not read, and the only other files that are read are the buffers of a
    glTF file.

    Raises:
        LinkwrightError: INR101, the file does not exist; INR102, the extension is unknown; INR103, the file cannot be
            read; INR104, trimesh is not installed.
    """
    extension = path.suffix.lower()
    if extension not in MESH_SUFFIXES:
        message = phrase("the mesh '{path}' has an unsupported format", path=display_path(path))
        raise LinkwrightError(
            Diagnostic(
                "INR102",
                message,
                hint=phrase("convert it to one of the formats {mesh_endings}", mesh_endings=joined(MESH_SUFFIXES)),
            )
        )
    try:
        file_status = path.stat()
        if not stat.S_ISREG(file_status.st_mode):
            raise unreadable_mesh_error(path, phrase("it is not a regular file"))
        if file_status.st_size > MAX_FILE_SIZE:
            raise unreadable_mesh_error(
                path, phrase("it is larger than the maximum of {largest_file} MiB", largest_file=MAX_FILE_SIZE >> 20)
            )
        data = path.read_bytes()
        if extension == ".dae":
            data = data.strip(COLLADA_PADDING)
    except FileNotFoundError:
        message = phrase("there is no mesh file '{path}'", path=display_path(path))
        raise LinkwrightError(Diagnostic("INR101", message, hint=missing_file_hint(path))) from None
    except OSError as error:
        raise unreadable_mesh_error(path, error.strerror or str(error)) from None
    try:
        mesh = _parse(data, extension[1:], path)
    except ModuleNotFoundError as error:
        raise missing_extra("INR104", error) from None
    except BadMeshError as error:
        raise unreadable_mesh_error(path, error.reason) from None
    if not np.abs(mesh.vertices).max() <= MAX_COORDINATE:
        raise unreadable_mesh_error(path, phrase("a coordinate is out of range"))
    return mesh


def _parse(data: bytes, kind: str, path: Path) -> TriangleMesh:
    options: dict[str, Any] = {}
    if kind in ("obj", "glb", "gltf"):
        options["skip_materials"] = True
    if kind in ("glb", "gltf"):
        options["resolver"] = create_file_resolver(str(path))
    vertices: list[Array] = [np.zeros((0, 3))]
    faces: list[Faces] = [np.zeros((0, 3), dtype=np.int64)]
    count = 0
    meshes = []
    for placed_mesh in read_placed_meshes(data, kind, is_plain=True, **options):
        corners = np.asarray(placed_mesh.mesh.vertices, dtype=np.float64)
        vertices.append((corners @ placed_mesh.matrix[:3, :3].T + placed_mesh.matrix[:3, 3]) * placed_mesh.unit)
        faces.append(placed_mesh.faces + count)
        count += len(corners)
        meshes.append(placed_mesh.mesh)
    for mesh in meshes:
        mesh.__dict__.clear()  # This breaks reference cycles, which would keep much memory alive.
    return TriangleMesh(np.concatenate(vertices), np.concatenate(faces))


def unreadable_mesh_error(path: Path, reason: str) -> LinkwrightError:
    """Return the error INR103 for a mesh file that cannot be used."""
    hint = phrase("export the mesh again, or leave out the link that uses it")
    return LinkwrightError(
        Diagnostic(
            "INR103",
            phrase("cannot read the mesh '{path}': {reason}", path=display_path(path), reason=reason),
            hint=hint,
        )
    )
