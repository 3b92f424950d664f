"""The properties of mesh files that checks of descriptions need.

Small files are read without numpy, because importing numpy takes longer than the rest of the check of a robot with a
small mesh. Large or unusual files are read by `linkwright.geometry.meshes`, which computes the same results with
arrays.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import cached_property
from itertools import chain, pairwise
from math import isfinite
from struct import iter_unpack

from linkwright.geometry.shapes import MAX_COORDINATE, Bounds
from linkwright.geometry.single import Vector3
from linkwright.loading.lean_typing import Protocol

GRID_STEPS = 1 << 20
"""The number of grid cells along the longest side of a mesh. Corners in the same cell are merged."""
MAX_POINT_SIZE = 1e-30
"""A mesh smaller than this, in m, counts as a point."""
STL_HEADER_BYTES, STL_TRIANGLE_BYTES = 84, 50
"""The bytes of a binary STL before its triangles, and the bytes of each triangle."""
FACET_TOKENS = b"facet normal ? ? ? outer loop vertex ? ? ? vertex ? ? ? vertex ? ? ? endloop endfacet".split()
"""The tokens of a triangle in a text STL."""
COORDINATE_INDICES = (8, 9, 10, 12, 13, 14, 16, 17, 18)
"""The indices of the corner coordinates among these tokens."""

COLLADA_PADDING = b" \t\r\n\0"
"""The bytes that exporters leave around the XML of a COLLADA file. Other readers skip them."""
_MAX_TRIANGLES = 20_000
"""The maximum number of triangles, because a small COLLADA file may place its meshes any number of times."""

_Triangle = tuple[int, int, int]


class Outline(Protocol):
    """The interface of meshes with the properties that checks use."""

    @property
    def bounds(self) -> Bounds:
        """The bounding box of the triangles, in m."""

    @property
    def count(self) -> int:
        """The number of triangles."""

    @property
    def is_watertight(self) -> bool:
        """Whether the triangles bound a volume, without holes and with consistent orientation."""

    def scaled(self, scale: Vector3) -> Outline:
        """Return the outline of the mesh scaled along its axes."""


class SmallMesh:
    """The triangles of a mesh in plain Python.

    Args:
        corners: the corners in m.
        faces: the three indices of corners of each triangle.
    """

    def __init__(self, corners: list[Vector3], faces: list[_Triangle]) -> None:
        self._corners = corners
        self._faces = faces
        self._scaled: dict[Vector3, SmallMesh] = {}

    @property
    def count(self) -> int:
        """The number of triangles."""
        return len(self._faces)

    @cached_property
    def bounds(self) -> Bounds:
        """The bounding box of the triangles, in m."""
        return _compute_bounds([self._corners[index] for index in set(chain.from_iterable(self._faces))])

    @cached_property
    def is_watertight(self) -> bool:
        """Whether the triangles bound a volume: each edge occurs equally often in both directions.

        Corners at the same position are merged first.
        """
        box = _compute_bounds(self._corners)
        size = max(box.size)
        if not size > MAX_POINT_SIZE:
            return False
        (left, front, bottom), factor = box.low, GRID_STEPS / size
        cells: dict[Vector3, int] = {}
        merged_indices = [
            cells.setdefault((round((x - left) * factor), round((y - front) * factor), round((z - bottom) * factor)), i)
            for i, (x, y, z) in enumerate(self._corners)
        ]
        edges: Counter[tuple[int, int]] = Counter()
        for face in self._faces:
            a, b, c = (merged_indices[index] for index in face)
            if a != b != c != a:
                edges.update(((a, b), (b, c), (c, a)))
        return bool(edges) and all(edges[end, start] == count for (start, end), count in edges.items())

    def scaled(self, scale: Vector3) -> SmallMesh:
        """Return the mesh scaled along its axes."""
        if scale == (1.0, 1.0, 1.0):
            return self
        mesh = self._scaled.get(scale)
        if mesh is None:
            a, b, c = scale
            corners = [(a * x, b * y, c * z) for x, y, z in self._corners]
            mesh = self._scaled[scale] = SmallMesh(corners, self._faces)
        return mesh


def read_small_mesh(data: bytes, kind: str) -> SmallMesh | None:
    """Return the triangles of a simple STL, OBJ or COLLADA file, or None for other files.

    Args:
        data: the content of the file.
        kind: the file extension, without the dot.
    """
    try:
        if kind == "stl":
            return _read_binary_stl(data) or _read_text_stl(data)
        return _read_obj(data) if kind == "obj" else _read_collada(data) if kind == "dae" else None
    except ValueError:  # A malformed number, or a name that is not UTF-8.
        return None


def _read_binary_stl(data: bytes) -> SmallMesh | None:
    count = int.from_bytes(data[STL_HEADER_BYTES - 4 : STL_HEADER_BYTES], "little")
    if not count or len(data) != STL_HEADER_BYTES + count * STL_TRIANGLE_BYTES:
        return None
    return _mesh_from_corners(list(chain.from_iterable(iter_unpack("<12x9f2x", data[STL_HEADER_BYTES:]))))


def _read_text_stl(data: bytes) -> SmallMesh | None:
    first_line, _, remainder = data.partition(b"\n")
    solid, _, name = first_line.strip().partition(b" ")
    body, end, trailing = remainder.partition(b"endsolid")
    tokens = body.split()
    if (
        solid != b"solid"
        or not end
        or not tokens
        or len(tokens) % len(FACET_TOKENS)
        or b"solid" in trailing
        or b"_" in body
    ):
        return None
    name.decode()
    if any(
        token != b"?" and set(tokens[index :: len(FACET_TOKENS)]) != {token} for index, token in enumerate(FACET_TOKENS)
    ):
        return None
    columns = [tokens[corner :: len(FACET_TOKENS)] for corner in COORDINATE_INDICES]
    return _mesh_from_corners([float(number) for row in zip(*columns, strict=True) for number in row])


def _mesh_from_corners(numbers: list[float]) -> SmallMesh | None:
    """Return a mesh of separate triangles from their coordinates, or None as `_create_mesh` does."""
    count = len(numbers) // 9
    indices = range(3 * count)
    return _create_mesh(_group_points(numbers), list(zip(indices[::3], indices[1::3], indices[2::3], strict=True)))


def _read_obj(data: bytes) -> SmallMesh | None:
    if b"\\" in data:
        return None  # A backslash may continue a line on the next one.
    lines = data.splitlines()
    rows = [line[2:].split() for line in lines if line.startswith(b"v ")]
    polygons = [line[2:].split() for line in lines if line.startswith(b"f ")]
    tokens = [*chain.from_iterable(rows), *chain.from_iterable(polygons)]
    if not rows or not polygons or len(set(map(len, rows))) > 1 or len(rows[0]) < 3 or b"_" in b"".join(tokens):
        return None
    corners = _group_points([float(number) for row in rows for number in row[:3]])
    faces = []
    for polygon in polygons:
        first_corner, *other_corners = (int(token.partition(b"/")[0]) - 1 for token in polygon)
        if (
            len(other_corners) < 2
            or min(first_corner, *other_corners) < 0
            or max(first_corner, *other_corners) >= len(corners)
        ):
            return None
        faces += [(first_corner, second, third) for second, third in pairwise(other_corners)]
    return _create_mesh(corners, faces)


def _read_collada(data: bytes) -> SmallMesh | None:
    from linkwright.geometry.collada_lists import read_triangles  # Imports an XML parser.

    triangles = read_triangles(data.strip(COLLADA_PADDING), _MAX_TRIANGLES)
    return None if triangles is None else _create_mesh(*triangles)


def _group_points(numbers: list[float]) -> list[Vector3]:
    return list(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))


def _create_mesh(corners: list[Vector3], faces: list[_Triangle]) -> SmallMesh | None:
    numbers = list(chain.from_iterable(corners))
    if not all(map(isfinite, numbers)) or max(map(abs, numbers)) > MAX_COORDINATE:
        return None
    return SmallMesh(corners, faces)


def _compute_bounds(points: Iterable[Vector3]) -> Bounds:
    x, y, z = zip(*points, strict=True)
    return Bounds((min(x), min(y), min(z)), (max(x), max(y), max(z)))
