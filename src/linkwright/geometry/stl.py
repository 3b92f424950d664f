"""A fast reader of STL files that have only common content.

Importing trimesh takes longer than reading most files.
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.outlines import COORDINATE_INDICES, FACET_TOKENS, STL_HEADER_BYTES, STL_TRIANGLE_BYTES
from linkwright.geometry.plain import PlainMesh

_HEADER_BYTES = 80
_TRIANGLE_TYPE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_MAX_TEXT_SIZE = 1 << 24
"""The maximum size, in bytes, of a text STL that is read here.

Reading a larger file takes much longer than the import of trimesh, and a list of all its tokens would be large.
"""
_FIXED_TOKENS = [index for index, token in enumerate(FACET_TOKENS) if token != b"?"]
"""The indices of a facet's tokens that are the same in all facets."""


def read_stl(data: bytes, *, is_plain: bool = False) -> PlainMesh | None:
    """Return the triangles of an STL file.

    Returns None for a file with several solids or with mistakes; only trimesh can read such a file.

    Args:
        data: the content of the file.
        is_plain: whether to ignore colors; otherwise None is also returned for a file with colors.
    """
    return _read_binary(data, is_plain=is_plain) or _read_text(data)


def _read_binary(data: bytes, *, is_plain: bool) -> PlainMesh | None:
    count = int.from_bytes(data[_HEADER_BYTES:STL_HEADER_BYTES], "little")
    if not count or len(data) != STL_HEADER_BYTES + count * STL_TRIANGLE_BYTES:
        return None
    triangles = np.frombuffer(data, _TRIANGLE_TYPE, count, STL_HEADER_BYTES)
    if not is_plain and (b"COLOR=" in data[:_HEADER_BYTES] or triangles["attribute"].any()):
        return None
    return _create_mesh(triangles["corners"].astype(np.float64), "geometry_0")


def _read_text(data: bytes) -> PlainMesh | None:
    if len(data) > _MAX_TEXT_SIZE:
        return None
    first_line, _, remainder = data.partition(b"\n")
    solid, _, name = first_line.strip().partition(b" ")
    body, end, trailing = remainder.partition(b"endsolid")
    tokens = body.split()
    if solid != b"solid" or not end or not tokens or len(tokens) % len(FACET_TOKENS) or b"solid" in trailing:
        return None
    facets = np.array(tokens).reshape(-1, len(FACET_TOKENS))
    if (facets[:, _FIXED_TOKENS] != [FACET_TOKENS[index] for index in _FIXED_TOKENS]).any():
        return None
    try:
        return _create_mesh(facets[:, list(COORDINATE_INDICES)].astype(np.float64), name.strip().decode())
    except ValueError:  # A malformed number, or a name that is not UTF-8.
        return None


def _create_mesh(corners: Array, name: str) -> PlainMesh:
    """Return a mesh of triangles that share no corners."""
    vertices = corners.reshape(-1, 3)
    return PlainMesh(vertices, np.arange(len(vertices)).reshape(-1, 3), name)
