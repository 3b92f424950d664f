"""Reading the usual STL files, without colours: importing trimesh takes longer than reading most."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.plain import PlainMesh

_HEADER, _COUNT = 80, 4
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_LARGEST_TEXT = 1 << 24
"""Beside reading a longer text the import of trimesh counts for nothing, and a list of all its words would be large."""
_FACET = b"facet normal ? ? ? outer loop vertex ? ? ? vertex ? ? ? vertex ? ? ? endloop endfacet".split()
_WORDS = [place for place, word in enumerate(_FACET) if word != b"?"]
_CORNERS = [8, 9, 10, 12, 13, 14, 16, 17, 18]
"""The positions of a facet's words, and of the numbers of its corners."""


def read_stl(data: bytes, *, is_plain: bool = False) -> PlainMesh | None:
    """The triangles of an STL file; None for one with several solids or mistakes, which trimesh is to read.

    Args:
        data: the file.
        is_plain: whether its colours do not matter. Where they do, a file with colours gives None, too.
    """
    return _binary(data, is_plain=is_plain) or _text(data)


def _binary(data: bytes, *, is_plain: bool) -> PlainMesh | None:
    begin = _HEADER + _COUNT
    count = int.from_bytes(data[_HEADER:begin], "little")
    if not count or len(data) != begin + count * _TRIANGLE.itemsize:
        return None
    triangles = np.frombuffer(data, _TRIANGLE, count, begin)
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
    if solid != b"solid" or not end or not words or len(words) % len(_FACET) or b"solid" in after:
        return None
    facets = np.array(words).reshape(-1, len(_FACET))
    if (facets[:, _WORDS] != [_FACET[place] for place in _WORDS]).any():
        return None
    try:
        return _mesh(facets[:, _CORNERS].astype(np.float64), name.strip().decode())
    except ValueError:  # what stands for a number is none, or the name no UTF-8
        return None


def _mesh(corners: Array, name: str) -> PlainMesh:
    """The mesh of triangles, each with three corners of its own."""
    vertices = corners.reshape(-1, 3)
    return PlainMesh(vertices, np.arange(len(vertices)).reshape(-1, 3), name)
