"""Meshes without colors, and the parsing of numbers in text files."""

from __future__ import annotations

import warnings
from types import SimpleNamespace

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.collada_scene import UnsupportedContent
from linkwright.geometry.polyhedron import Faces
from linkwright.loading.lean_typing import Any


class PlainMesh:
    """The triangles of a file, with a part of the interface of `trimesh.Trimesh`.

    Attributes:
        vertices: the corners, shape (n, 3), in the file's unit.
        faces: the three indices of corners of each triangle, shape (m, 3).
        name: the name in the file.
        visual: an object whose ``kind`` is None, because there are no colors.
    """

    def __init__(self, vertices: Array, faces: Faces, name: str = "") -> None:
        self.vertices = vertices
        self.faces = faces
        self.name = name
        self.visual: Any = SimpleNamespace(kind=None)


def parse_numbers(text: str | None, kind: type[Any]) -> Any:
    """Parse numbers separated by whitespace, and return them as an array.

    `kind` is the type of the array's elements.

    Raises:
        UnsupportedContent: the text contains anything else, or a float32 number that is not finite.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # numpy warns about tokens that are not numbers.
        try:
            numbers = np.fromstring((text or "").strip(), dtype=kind, sep=" ")
        except (DeprecationWarning, ValueError):
            raise UnsupportedContent from None
    if kind is np.float32 and not np.isfinite(numbers).all():
        raise UnsupportedContent
    return numbers


def triangulate_fans(corners: Faces, counts: Faces) -> Faces:
    """Split polygons into triangles of shape (n, 3).

    Each triangle joins the first corner of its polygon and two neighboring other corners.

    Args:
        corners: the corners of all polygons, one polygon after another.
        counts: the number of corners of each polygon, 3 or more.
    """
    ends = np.cumsum(counts)
    first_corners = np.repeat(ends - counts, counts - 2)
    seconds = np.arange(len(first_corners)) + np.repeat(2 * np.arange(len(counts)), counts - 2) + 1
    return np.stack([corners[first_corners], corners[seconds], corners[seconds + 1]], axis=1)
