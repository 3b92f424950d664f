"""Read COLLADA files into arrays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.collada_scene import ColladaFile, Limits, UnsupportedContent, read_scene
from linkwright.geometry.plain import PlainMesh, parse_numbers, triangulate_fans
from linkwright.geometry.polyhedron import Faces


def read_collada(data: bytes) -> ColladaFile[PlainMesh, Array] | None:
    """Return the meshes in the scene of a file, or None in the cases described at `read_scene`."""
    return read_scene(data, ArrayBuilder())


class ArrayBuilder:
    """The implementation of `MeshBuilder` with numpy: meshes, and matrices of shape (4, 4)."""

    def identity(self) -> Array:
        """Return the identity matrix."""
        return np.eye(4)

    def apply_transform(self, matrix: Array, tag: str, text: str | None) -> Array:
        """Return the product of a matrix and the matrix of a transform element."""
        transform = _parse_transform(tag, parse_numbers(text, np.float32).astype(np.float64))
        # Unlike a product of matrices, this adds in the same order on every machine.
        columns = [matrix[:, place : place + 1] * transform[place] for place in range(4)]
        product: Array = columns[0] + columns[1] + columns[2] + columns[3]
        return product

    def faces(self, tag: str, texts: list[str], corner_counts: str, width: int, column: int, limits: Limits) -> Faces:
        """Return the triangles of a ``<triangles>``, ``<polylist>`` or ``<polygons>`` element."""
        rows = [parse_numbers(text, np.int64).reshape(-1, width) for text in texts]
        if tag == "triangles":
            counts: NDArray[np.int64] = np.full(len(rows[0]) // 3, 3, np.int64)
        elif tag == "polylist":
            counts = parse_numbers(corner_counts, np.int64)
        else:
            counts = np.array([len(row) for row in rows])
        indices = np.concatenate(rows)
        if counts.sum() != len(indices) or (len(counts) and counts.min() < 3):
            raise UnsupportedContent
        for offset, limit in limits:
            if len(indices) and not 0 <= indices[:, offset].min() <= indices[:, offset].max() < limit:
                raise UnsupportedContent
        return triangulate_fans(indices[:, column], counts)

    def mesh(self, text: str, faces: list[Faces]) -> PlainMesh:
        """Return a mesh from the text of its vertices and the triangles of its elements."""
        points = parse_numbers(text, np.float32).reshape(-1, 3).astype(np.float64)
        return PlainMesh(points, np.concatenate([np.zeros((0, 3), dtype=np.int64), *faces]))


def _parse_transform(tag: str, values: Array) -> Array:
    """Return the matrix of a transform element, given its tag and numbers.

    As in pycollada, the axis of a rotation is not normalized.
    """
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
        raise UnsupportedContent
    if tag == "translate":
        matrix[:3, 3] = values
    else:
        matrix[[0, 1, 2], [0, 1, 2]] = values
    return matrix
