"""The numbers of COLLADA files by arrays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.collada_scene import ColladaFile, Limits, Unusual, read_scene
from linkwright.geometry.plain import PlainMesh, fans, numbers
from linkwright.geometry.polyhedron import Faces


def read_collada(data: bytes) -> ColladaFile[PlainMesh, Array] | None:
    """The meshes that the scene of a file places; None as `read_scene` gives it."""
    return read_scene(data, Arrays())


class Arrays:
    """Meshes and matrices of numpy; shape (4, 4)."""

    def identity(self) -> Array:
        """No transform."""
        return np.eye(4)

    def moved(self, matrix: Array, tag: str, text: str | None) -> Array:
        """A matrix times that of a transform."""
        moved: Array = matrix @ _transform(tag, numbers(text, np.float32).astype(np.float64))
        return moved

    def faces(self, tag: str, texts: list[str], counted: str, width: int, column: int, limits: Limits) -> Faces:
        """The triangles of an element."""
        rows = [numbers(text, np.int64).reshape(-1, width) for text in texts]
        if tag == "triangles":
            counts: NDArray[np.int64] = np.full(len(rows[0]) // 3, 3, np.int64)
        elif tag == "polylist":
            counts = numbers(counted, np.int64)
        else:
            counts = np.array([len(row) for row in rows])
        indices = np.concatenate(rows)
        if counts.sum() != len(indices) or (len(counts) and counts.min() < 3):
            raise Unusual
        for offset, limit in limits:
            if len(indices) and not 0 <= indices[:, offset].min() <= indices[:, offset].max() < limit:
                raise Unusual
        return fans(indices[:, column], counts)

    def mesh(self, text: str, faces: list[Faces]) -> PlainMesh:
        """The mesh of the numbers of its corners and the triangles of its elements."""
        points = numbers(text, np.float32).reshape(-1, 3).astype(np.float64)
        return PlainMesh(points, np.concatenate([np.zeros((0, 3), dtype=np.int64), *faces]))


def _transform(tag: str, values: Array) -> Array:
    """The matrix of a transform; the axis of a rotation is taken as it is written, as pycollada does."""
    matrix = np.eye(4)
    if tag == "matrix":
        return values.reshape(4, 4)
    if tag == "rotate":
        x, y, z, degrees = values
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        axis = np.array([x, y, z])
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        matrix[:3, :3] = (1 - cosine) * np.outer(axis, axis) + cosine * np.eye(3) + sine * cross
        return matrix
    if len(values) != 3:
        raise Unusual
    if tag == "translate":
        matrix[:3, 3] = values
    else:
        matrix[[0, 1, 2], [0, 1, 2]] = values
    return matrix
