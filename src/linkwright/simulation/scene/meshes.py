"""Meshes, and shapes that become meshes, as assets of MuJoCo."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import Array
from linkwright.geometry.meshes import TriangleMesh, read_mesh
from linkwright.geometry.single import Transform
from linkwright.geometry.vectors import Vector3
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.shapes import Cone, Mesh, Shape
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.shapes import cone_corners, set_pose


class MeshLibrary:
    """Reads the meshes that worlds name, each once.

    Args:
        finder: where they are.

    Attributes:
        spec: the specification that gets them.
    """

    def __init__(self, finder: ResourceFinder) -> None:
        self.spec: Any = None
        self._finder = finder
        self._read: dict[Path, TriangleMesh | None] = {}
        self._assets: dict[tuple[object, ...], str] = {}

    def add(
        self, body: Any, shape: Shape, pose: Transform, beside: Path, *, fixed: bool, collision: bool
    ) -> Iterator[Any]:
        """Add a shape to a body that MuJoCo has as meshes only; nothing for a mesh that cannot be had.

        Args:
            body: the body of the specification.
            shape: the shape.
            pose: where it stands in the frame of the body.
            beside: the folder of the file that names it.
            fixed: whether the body never moves.
            collision: whether it touches or is seen.
        """
        del fixed, collision
        name = None
        if isinstance(shape, Cone):
            name = self._asset((shape,), cone_corners(shape), None)
        elif isinstance(shape, Mesh):
            name = self._file(shape, beside)
        if name is not None:
            geom = body.add_geom(type=load_mujoco().mjtGeom.mjGEOM_MESH, meshname=name)
            set_pose(geom, pose)
            yield geom

    def _file(self, shape: Mesh, beside: Path) -> str | None:
        path = self._finder.file(shape.uri, beside)
        if isinstance(path, Missing):
            return None
        if path not in self._read:
            try:
                self._read[path] = read_mesh(path)
            except LinkwrightError:
                self._read[path] = None
        mesh = self._read[path]
        return None if mesh is None else self._asset((path, shape.scale), mesh.vertices, mesh.faces, shape.scale)

    def _asset(
        self, key: tuple[object, ...], vertices: Array, faces: Any | None, scale: Vector3 = (1.0, 1.0, 1.0)
    ) -> str:
        if key not in self._assets:
            name = self._assets[key] = f"mesh{len(self._assets)}"
            mesh = self.spec.add_mesh(name=name)
            mesh.uservert = np.asarray(vertices * np.asarray(scale), dtype=np.float32).ravel().tolist()
            if faces is not None:
                mesh.userface = np.asarray(faces, dtype=np.int32).ravel().tolist()
        return self._assets[key]
