"""Primitive shapes as triangles."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.mesh_parts import Triangles
from linkwright.geometry.polyhedron import is_closed, merge_corners
from linkwright.geometry.surfaces import box, capsule, cone, cylinder, sphere

SHAPES = {
    "box": (box((2.0, 4.0, 6.0)), (1, 2, 3)),
    "cylinder": (cylinder(1.0, 4.0, 40), (1, 1, 2)),
    "cone": (cone(1.0, 4.0, 40), (1, 1, 2)),
    "sphere": (sphere(2.0, 40), (2, 2, 2)),
    "capsule": (capsule(1.0, 4.0, 40), (1, 1, 3)),
}


@pytest.mark.parametrize(("triangles", "extent"), SHAPES.values(), ids=SHAPES)
def test_shape_surface_is_closed_and_has_extent_of_shape(triangles: Triangles, extent: tuple[float, ...]) -> None:
    np.testing.assert_allclose(triangles.positions.max(axis=0), extent, atol=1e-12)
    np.testing.assert_allclose(triangles.positions.min(axis=0), np.negative(extent), atol=1e-12)
    assert is_closed(merge_corners(triangles.positions, triangles.indices.reshape(-1, 3))[1])


@pytest.mark.parametrize("triangles", [shape for shape, _ in SHAPES.values()], ids=SHAPES)
def test_triangles_and_normals_point_outward(triangles: Triangles) -> None:
    assert triangles.normals is not None
    faces = triangles.indices.reshape(-1, 3)
    a, b, c = (triangles.positions[faces[:, corner]] for corner in range(3))
    outward = np.cross(b - a, c - a)
    assert (np.einsum("ij,ij->i", outward, a + b + c) > 0).all()
    assert (np.einsum("ij,ij->i", outward, triangles.normals[faces[:, 0]]) > 0).all()
    np.testing.assert_allclose(np.linalg.norm(triangles.normals, axis=1), 1, atol=1e-12)
