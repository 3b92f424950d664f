"""The parser of mesh files: the one place that knows trimesh."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from io import BytesIO
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array

MESH_ENDINGS = (".stl", ".dae", ".obj", ".glb", ".gltf")
"""The formats that are read, as RViz and Gazebo read them."""


class PlacedMesh(NamedTuple):
    """One mesh of a file at one of its places.

    Attributes:
        mesh: the `trimesh.Trimesh`; it has triangles.
        matrix: its frame in that of the file, homogeneous, in the file's unit; shape (4, 4).
        unit: metres for each unit of the file.
    """

    mesh: Any
    matrix: Array
    unit: float

    @property
    def faces(self) -> NDArray[np.int64]:
        """Indices of corners, shape (faces, 3); turned round where the matrix mirrors, so that outside stays."""
        faces = np.asarray(self.mesh.faces, dtype=np.int64)
        return faces[:, ::-1] if np.linalg.det(self.matrix[:3, :3]) < 0 else faces


def placed_meshes(data: bytes, kind: str, **options: Any) -> Iterator[PlacedMesh]:
    """The triangle meshes of an STL, COLLADA, OBJ or glTF file; lines and points are left out.

    STL and OBJ say nothing of their unit; URDF takes their numbers as metres. The unit of COLLADA is told, its up axis
    is not applied, as in RViz.

    Args:
        data: the file.
        kind: its ending, without the dot.
        options: for `trimesh.load_scene`.

    Raises:
        Exception: whatever the parser of the format raises for bytes that it cannot read.
    """
    import trimesh  # not above: it costs 0.1 s, and most robots are checked without a look into their meshes

    logging.getLogger("trimesh").addHandler(logging.NullHandler())  # what it warns of is no concern of the user
    scene: Any = trimesh.load_scene(BytesIO(data), file_type=kind, process=False, **options)
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            unit = _collada_unit(mesh) if kind == "dae" else 1.0
            yield PlacedMesh(mesh, np.asarray(matrix, dtype=np.float64), unit)


def beside(path: str) -> Any:
    """What gives the parser the files beside a mesh file."""
    from trimesh.resolvers import FilePathResolver

    return FilePathResolver(path)


def _collada_unit(mesh: Any) -> float:
    """Metres for each unit of a COLLADA file; trimesh notes them with its meshes and leaves the numbers as they are."""
    words = str(mesh.metadata.get("units", "meters")).split(" * ")
    return float(words[0]) if len(words) == 2 else 1.0
