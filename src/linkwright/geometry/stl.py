"""Reading the usual STL files, without colours: importing trimesh takes longer than reading most."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array

_HEADER, _COUNT = 80, 4
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_LARGEST_TEXT = 1 << 24
"""Beside reading a longer text the import of trimesh counts for nothing, and a list of all its words would be large."""
_FACET = b"facet normal ? ? ? outer loop vertex ? ? ? vertex ? ? ? vertex ? ? ? endloop endfacet".split()
_WORDS = [place for place, word in enumerate(_FACET) if word != b"?"]
_CORNERS = [8, 9, 10, 12, 13, 14, 16, 17, 18]
"""The positions of a facet's words, and of the numbers of its corners."""


@dataclass
class StlMesh:
    """The triangles of an STL file, with as much of a `trimesh.Trimesh` as is asked for here.

    Attributes:
        vertices: three for each triangle, shape (3 n, 3), in the file's unit.
        name: what the file calls it.
        visual: of no kind, as there are no colours.
    """

    vertices: Array
    name: str
    visual: Any = field(default_factory=lambda: SimpleNamespace(kind=None))

    @property
    def faces(self) -> Any:
        """The numbers of three vertices each, shape (n, 3)."""
        return np.arange(len(self.vertices)).reshape(-1, 3)


def read_stl(data: bytes) -> StlMesh | None:
    """The triangles of an STL file; None for one with colours, several solids or mistakes, which trimesh is to read."""
    return _binary(data) or _text(data)


def _binary(data: bytes) -> StlMesh | None:
    begin = _HEADER + _COUNT
    count = int.from_bytes(data[_HEADER:begin], "little")
    if not count or len(data) != begin + count * _TRIANGLE.itemsize or b"COLOR=" in data[:_HEADER]:
        return None
    triangles = np.frombuffer(data, _TRIANGLE, count, begin)
    if triangles["attribute"].any():
        return None
    return StlMesh(triangles["corners"].reshape(-1, 3).astype(np.float64), "geometry_0")


def _text(data: bytes) -> StlMesh | None:
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
        return StlMesh(facets[:, _CORNERS].astype(np.float64).reshape(-1, 3), name.strip().decode())
    except ValueError:  # what stands for a number is none, or the name no UTF-8
        return None
