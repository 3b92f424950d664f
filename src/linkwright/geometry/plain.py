"""Triangles without colours, and the numbers in text files that make them."""

from __future__ import annotations

import warnings
from types import SimpleNamespace

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.collada_scene import Unusual
from linkwright.geometry.polyhedron import Faces
from linkwright.loading.lean_typing import Any


class PlainMesh:
    """The triangles of a file, with the part of the interface of `trimesh.Trimesh` that is used here.

    Attributes:
        vertices: corners, shape (n, 3), in the file's unit.
        faces: the numbers of three corners each, shape (m, 3).
        name: what the file calls it.
        visual: of no kind, as there are no colours.
    """

    def __init__(self, vertices: Array, faces: Faces, name: str = "") -> None:
        self.vertices = vertices
        self.faces = faces
        self.name = name
        self.visual: Any = SimpleNamespace(kind=None)


def numbers(text: str | None, kind: type[Any]) -> Any:
    """The numbers in a text with blanks between them, as an array of a kind.

    Raises:
        Unusual: there is anything else in it, or a number that is not finite.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # numpy's warning about words that are not numbers
        try:
            found = np.fromstring((text or "").strip(), dtype=kind, sep=" ")
        except (DeprecationWarning, ValueError):
            raise Unusual from None
    if kind is np.float32 and not np.isfinite(found).all():
        raise Unusual
    return found


def fans(corners: Faces, counts: Faces) -> Faces:
    """Triangles of polygons: from the first corner of each to every two neighbours that follow.

    Args:
        corners: those of all polygons, one behind another.
        counts: how many each has, 3 or more.
    """
    ends = np.cumsum(counts)
    firsts = np.repeat(ends - counts, counts - 2)
    seconds = np.arange(len(firsts)) + np.repeat(2 * np.arange(len(counts)), counts - 2) + 1
    return np.stack([corners[firsts], corners[seconds], corners[seconds + 1]], axis=1)
