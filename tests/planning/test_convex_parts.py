"""The split of meshes into convex hulls, and the collisions of links with such meshes."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.arrays import Array
from linkwright.geometry.hull import convex_hull
from linkwright.geometry.polyhedron import Faces, polyhedron_properties
from linkwright.planning.convex_parts import split_into_hulls
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.shapes import scale_shape

pytestmark = pytest.mark.extra("arm")

_POSE = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))


def box_mesh(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[Array, Faces]:
    """Return the corners and triangles of a box."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    faces = convex_hull(corners)
    assert faces is not None
    return corners, faces


def elbow_mesh(scale: float = 1.0) -> tuple[Array, Faces]:
    """Return an L of two boxes: 0.4 m along x and 0.4 m along z, each 0.1 m thick."""
    (first, first_faces), (second, second_faces) = (
        box_mesh((0.0, 0.0, 0.0), (0.4, 0.1, 0.1)),
        box_mesh((0.0, 0.0, 0.0), (0.1, 0.1, 0.4)),
    )
    return scale * np.concatenate((first, second)), np.concatenate((first_faces, second_faces + len(first)))


def volume(corners: Array) -> float:
    faces = convex_hull(corners)
    assert faces is not None
    return abs(polyhedron_properties(corners, faces).mass)


def contains(parts: list[Array], point: Array, tolerance: float = 1e-6) -> bool:
    """Return whether a point is in one of the hulls."""
    return any(volume(np.concatenate((part, [point]))) <= volume(part) * (1.0 + tolerance) for part in parts)


class TestSplit:
    def test_elbow_leaves_its_corner_free(self) -> None:
        vertices, faces = elbow_mesh()
        parts = split_into_hulls(vertices, faces)
        assert not contains(parts, np.array((0.2, 0.05, 0.2)))
        assert sum(map(volume, parts)) < 1.1 * 0.007
        assert contains([vertices], np.array((0.2, 0.05, 0.2)))

    def test_hulls_contain_the_mesh(self) -> None:
        vertices, faces = elbow_mesh()
        random = np.random.default_rng(1)
        vertices = vertices + random.uniform(-0.02, 0.02, vertices.shape)
        parts = split_into_hulls(vertices, faces)
        assert len(parts) > 1
        weights = random.dirichlet((1.0, 1.0, 1.0), len(faces))
        for point in (*vertices, *np.einsum("nk,nkd->nd", weights, vertices[faces])):
            assert contains(parts, point)

    def test_convex_mesh_stays_whole(self) -> None:
        corners, faces = box_mesh((0.0, 0.0, 0.0), (0.4, 0.2, 0.1))
        (part,) = split_into_hulls(corners, faces)
        assert {tuple(point) for point in part.round(9)} == {tuple(point) for point in corners}

    @pytest.mark.parametrize("scale", [1e-5, 1e3])
    def test_size_does_not_matter(self, scale: float) -> None:
        assert len(split_into_hulls(*elbow_mesh(scale))) == len(split_into_hulls(*elbow_mesh()))

    def test_flat_fin_is_not_lost(self) -> None:
        vertices, faces = box_mesh((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
        fin = np.array(((0.1, 0.05, 0.0), (0.9, 0.05, 0.0), (0.1, 0.05, 0.1)))
        parts = split_into_hulls(np.concatenate((vertices, fin)), np.concatenate((faces, [[8, 9, 10]])))
        assert contains(parts, fin[1])

    def test_flat_mesh_has_no_hull(self) -> None:
        triangle = np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
        assert split_into_hulls(triangle, np.array([[0, 1, 2]])) == []
        assert split_into_hulls(triangle, np.zeros((0, 3), dtype=np.int64)) == []


def test_parts_of_a_mesh_grow_from_the_same_center() -> None:
    center = np.array((1.0, 0.0, 0.0))
    part = np.array(((2.0, 0.0, 0.0), (3.0, 0.0, 0.0), (2.0, 1.0, 0.0), (2.0, 0.0, 1.0)))
    scaled = scale_shape(PlacedShape(part, _POSE, center), 2.0)
    np.testing.assert_allclose(scaled.shape, center + 2.0 * (part - center))
