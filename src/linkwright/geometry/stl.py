"""A fast reader of STL files that have only common content.

Importing trimesh takes longer than reading most files.
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.outlines import CORNERS, FACET, STL_HEADER, STL_TRIANGLE
from linkwright.geometry.plain import PlainMesh

_HEADER = 80
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_MAX_TEXT_SIZE = 1 << 24
"""The maximum size, in bytes, of a text STL that is read here.

Reading a larger file takes much longer than the import of trimesh, and a list of all its tokens would be large.
"""
_FIXED_TOKENS = [index for index, token in enumerate(FACET) if token != b"?"]
"""The indices of a facet's tokens that are the same in all facets."""


def read_stl(data: bytes, *, is_plain: bool = False) -> PlainMesh | None:
    """Return the triangles of an STL file.

    Returns None for a file with several solids or with mistakes; only trimesh can read such a file.

    Args:
        data: the content of the file.
        is_plain: whether to ignore colors; otherwise None is also returned for a file with colors.
    """
    return _binary(data, is_plain=is_plain) or _text(data)


def _binary(data: bytes, *, is_plain: bool) -> PlainMesh | None:
    count = int.from_bytes(data[_HEADER:STL_HEADER], "little")
    if not count or len(data) != STL_HEADER + count * STL_TRIANGLE:
        return None
    triangles = np.frombuffer(data, _TRIANGLE, count, STL_HEADER)
    if not is_plain and (b"COLOR=" in data[:_HEADER] or triangles["attribute"].any()):
        return None
    return _mesh(triangles["corners"].astype(np.float64), "geometry_0")


def _text(data: bytes) -> PlainMesh | None:
    if len(data) > _MAX_TEXT_SIZE:
        return None
    first_line, _, remainder = data.partition(b"\n")
    solid, _, name = first_line.strip().partition(b" ")
    body, end, trailing = remainder.partition(b"endsolid")
    tokens = body.split()
    if solid != b"solid" or not end or not tokens or len(tokens) % len(FACET) or b"solid" in trailing:
        return None
    facets = np.array(tokens).reshape(-1, len(FACET))
    if (facets[:, _FIXED_TOKENS] != [FACET[index] for index in _FIXED_TOKENS]).any():
        return None
    try:
        return _mesh(facets[:, list(CORNERS)].astype(np.float64), name.strip().decode())
    except ValueError:  # A malformed number, or a name that is not UTF-8.
        return None


def _mesh(corners: Array, name: str) -> PlainMesh:
    """Return a mesh of triangles that share no corners."""
    vertices = corners.reshape(-1, 3)
    return PlainMesh(vertices, np.arange(len(vertices)).reshape(-1, 3), name)
