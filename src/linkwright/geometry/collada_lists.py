"""Read small COLLADA files in plain Python.

Numbers are rounded to 32 bits, as in pycollada.
"""

from __future__ import annotations

import math
from itertools import pairwise
from struct import error, pack, unpack

from linkwright.geometry.collada_scene import ColladaFile, Limits, UnsupportedContent, read_scene
from linkwright.geometry.single import Vector3

_Rows = list[list[float]]
_Triangle = tuple[int, int, int]
_Mesh = tuple[list[Vector3], list[_Triangle]]


def read_triangles(data: bytes, max_triangles: int) -> _Mesh | None:
    """Return the vertices (in m) and triangles of a file's scene.

    Returns None if there are more than `max_triangles` triangles, and in the cases described at `read_scene`.
    """
    file: ColladaFile[_Mesh, _Rows] | None = read_scene(data, ListBuilder())
    if file is None or sum(len(faces) for (_, faces), _ in file.placed_meshes) > max_triangles:
        return None
    corners: list[Vector3] = []
    triangles: list[_Triangle] = []
    for (points, faces), ((a, b, c, u), (d, e, f, v), (g, h, i, w), _) in file.placed_meshes:
        is_mirrored = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0
        first_index, unit = len(corners), file.unit
        corners += [
            ((a * x + b * y + c * z + u) * unit, (d * x + e * y + f * z + v) * unit, (g * x + h * y + i * z + w) * unit)
            for x, y, z in points
        ]
        for face in faces:
            first, second, third = reversed(face) if is_mirrored else face
            triangles.append((first_index + first, first_index + second, first_index + third))
    return corners, triangles


class ListBuilder:
    """The implementation of `MeshBuilder` in plain Python.

    Meshes are lists of vertices and triangles, and matrices are lists of rows.
    """

    def identity(self) -> _Rows:
        """Return the identity matrix."""
        return [[float(row == column) for column in range(4)] for row in range(4)]

    def apply_transform(self, matrix: _Rows, tag: str, text: str | None) -> _Rows:
        """Return the product of a matrix and the matrix of a transform element."""
        columns = list(zip(*_parse_transform(tag, _parse_numbers(text or ""), self.identity()), strict=True))
        return [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in matrix]

    def faces(
        self, tag: str, texts: list[str], corner_counts: str, width: int, column: int, limits: Limits
    ) -> list[_Triangle]:
        """Return the triangles of a ``<triangles>``, ``<polylist>`` or ``<polygons>`` element."""
        rows = [_parse_integers(text) for text in texts]
        indices = [value for row in rows for value in row]
        counts = [len(row) // width for row in rows]
        if tag == "triangles":
            counts = [3] * (counts[0] // 3)
        elif tag == "polylist":
            counts = _parse_integers(corner_counts)
        if any(len(row) % width for row in rows) or sum(counts) * width != len(indices) or min(counts, default=3) < 3:
            raise UnsupportedContent
        for offset, limit in limits:
            if indices and not 0 <= min(indices[offset::width]) <= max(indices[offset::width]) < limit:
                raise UnsupportedContent
        corners = iter(indices[column::width])
        triangles = []
        for count in counts:
            first_corner, *other_corners = (next(corners) for _ in range(count))
            triangles += [(first_corner, second, third) for second, third in pairwise(other_corners)]
        return triangles

    def mesh(self, text: str, faces: list[list[_Triangle]]) -> _Mesh:
        """Return a mesh from the text of its vertices and the triangles of its elements."""
        numbers = _parse_numbers(text)
        points = list(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))
        return points, [item for triangle_group in faces for item in triangle_group]


def _parse_numbers(text: str) -> list[float]:
    """Parse numbers separated by whitespace, rounded to 32 bits."""
    if "_" in text:
        raise UnsupportedContent
    tokens = text.split()
    try:
        numbers = unpack(f"{len(tokens)}f", pack(f"{len(tokens)}f", *map(float, tokens)))
    except (OverflowError, error):
        raise UnsupportedContent from None
    if not all(map(math.isfinite, numbers)):
        raise UnsupportedContent
    return list(numbers)


def _parse_integers(text: str) -> list[int]:
    if "_" in text:
        raise UnsupportedContent
    return list(map(int, text.split()))


def _parse_transform(tag: str, values: list[float], matrix: _Rows) -> _Rows:
    """Return the matrix of a transform element, given its tag and numbers.

    `matrix` is an identity matrix, into which the result is written unless the element contains a matrix.
    """
    if tag == "matrix":
        if len(values) != 16:
            raise UnsupportedContent
        return [values[start : start + 4] for start in range(0, 16, 4)]
    if tag == "rotate":
        x, y, z, degrees = values
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        cross = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))
        for row, row_value in enumerate((x, y, z)):
            for column, column_value in enumerate((x, y, z)):
                diagonal = cosine if row == column else 0.0
                matrix[row][column] = (1 - cosine) * (row_value * column_value) + diagonal + sine * cross[row][column]
        return matrix
    if len(values) != 3:
        raise UnsupportedContent
    for axis, value in enumerate(values):
        matrix[axis][3 if tag == "translate" else axis] = value
    return matrix
