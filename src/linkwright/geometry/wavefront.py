"""A fast reader of OBJ files that have only common content.

Importing trimesh takes longer than reading most files.
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.collada_scene import UnsupportedContent
from linkwright.geometry.plain import PlainMesh, parse_numbers, triangulate_fans
from linkwright.geometry.polyhedron import Faces
from linkwright.loading.deferred import lazy_pattern

_TEXTURE_AND_NORMAL_PATTERN = lazy_pattern(rb"/\S*")
"""The indices of texture coordinates and normals that follow the index of a vertex."""


def read_obj(data: bytes) -> PlainMesh | None:
    """Return the triangles of an OBJ file.

    Returns None for a file with unusual features; only trimesh can read such a file.
    """
    if b"\\" in data:
        return None  # A backslash continues a line on the next one.
    lines = data.splitlines()
    vertices = [line[2:] for line in lines if line.startswith(b"v ")]
    polygons = [line[2:] for line in lines if line.startswith(b"f ")]
    try:
        return _create_mesh(vertices, polygons)
    except (UnsupportedContent, ValueError):
        return None


def _create_mesh(vertices: list[bytes], polygons: list[bytes]) -> PlainMesh:
    if not vertices or not polygons:
        raise UnsupportedContent
    width = len(vertices[0].split())
    if width < 3 or any(len(line.split()) != width for line in vertices):
        raise UnsupportedContent
    points = parse_numbers(b" ".join(vertices).decode(), np.float64).reshape(-1, width)[:, :3]
    faces = _parse_faces(polygons)
    if faces.min() < 0 or faces.max() >= len(points):
        raise UnsupportedContent
    return PlainMesh(points, faces)


def _parse_faces(polygons: list[bytes]) -> Faces:
    counts = np.array([len(line.split()) for line in polygons])
    corners = parse_numbers(_TEXTURE_AND_NORMAL_PATTERN.sub(b"", b" ".join(polygons)).decode(), np.int64)
    if counts.min() < 3 or counts.sum() != len(corners):
        raise UnsupportedContent
    return triangulate_fans(corners - 1, counts)
