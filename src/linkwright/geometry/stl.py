"""A fast reader of STL files without unusual content.

Importing trimesh takes longer than reading most files.
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.outlines import CORNERS, FACET, STL_HEADER, STL_TRIANGLE
from linkwright.geometry.plain import PlainMesh

_HEADER = 80
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_LARGEST_TEXT = 1 << 24
"""Beside reading a longer text the import of trimesh counts for nothing, and a list of all its words would be large."""
_WORDS = [place for place, word in enumerate(FACET) if word != b"?"]
"""The places of a facet's words that are the same in all."""


def read_stl(data: bytes, *, is_plain: bool = False) -> PlainMesh | None:
    """Return the triangles of an STL file.

    Returns None for a file with several solids or with mistakes, which must be read by trimesh.

    Args:
        data: the content of the file.
        is_plain: whether to ignore colours; otherwise None is returned for a file with colours, too.
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
    if len(data) > _LARGEST_TEXT:
        return None
    first, _, rest = data.partition(b"\n")
    solid, _, name = first.strip().partition(b" ")
    body, end, after = rest.partition(b"endsolid")
    words = body.split()
    if solid != b"solid" or not end or not words or len(words) % len(FACET) or b"solid" in after:
        return None
    facets = np.array(words).reshape(-1, len(FACET))
    if (facets[:, _WORDS] != [FACET[place] for place in _WORDS]).any():
        return None
    try:
        return _mesh(facets[:, list(CORNERS)].astype(np.float64), name.strip().decode())
    except ValueError:  # A malformed number, or a name that is not UTF-8.
        return None


def _mesh(corners: Array, name: str) -> PlainMesh:
    """Return a mesh of triangles that share no corners."""
    vertices = corners.reshape(-1, 3)
    return PlainMesh(vertices, np.arange(len(vertices)).reshape(-1, 3), name)
