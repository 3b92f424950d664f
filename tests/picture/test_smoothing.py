"""Normals of meshes: smooth where surfaces are curved, sharp at creases."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.surfaces import box, cylinder, sphere
from linkwright.picture.smoothing import smooth_mesh


def separate_triangles(positions: np.ndarray, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return triangles that share no corners, as in STL."""
    return positions[indices], np.arange(len(indices)).reshape(-1, 3)


def test_sphere_of_separate_triangles_has_exact_smooth_normals() -> None:
    shape = sphere(2.0, 48)
    points, faces = separate_triangles(shape.positions, shape.indices)
    mesh = smooth_mesh(points, faces)
    assert len(mesh.sources) < len(points) / 4
    np.testing.assert_allclose(mesh.normals, points[mesh.sources] / 2.0, atol=2e-3)


def test_box_edges_are_sharp() -> None:
    shape = box((1.0, 2.0, 3.0))
    mesh = smooth_mesh(*separate_triangles(shape.positions, shape.indices))
    assert set(np.abs(mesh.normals).max(axis=1)) == {1.0}


def test_cylinder_is_smooth_around_and_sharp_at_caps() -> None:
    shape = cylinder(1.0, 1.0, 24)
    points, faces = separate_triangles(shape.positions, shape.indices)
    mesh = smooth_mesh(points, faces)
    placed = points[mesh.sources]
    is_side = np.abs(mesh.normals[:, 2]) < 0.5
    np.testing.assert_allclose(mesh.normals[is_side, :2], placed[is_side, :2], atol=1e-3)
    assert set(mesh.normals[~is_side, 2]) == {-1.0, 1.0}


def test_triangles_keep_their_corners() -> None:
    shape = cylinder(1.0, 1.0, 12)
    faces = shape.indices.reshape(-1, 3)
    for merged in (True, False):
        mesh = smooth_mesh(shape.positions, faces, merged=merged)
        np.testing.assert_allclose(shape.positions[mesh.sources[mesh.faces]], shape.positions[faces], atol=1e-6)


def test_corners_with_different_texture_coordinates_are_not_merged() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0), (0, 1, 0), (-1, 0, 0)], float)
    faces = np.array([(0, 1, 2), (3, 4, 5)])
    assert len(smooth_mesh(points, faces).sources) == 4
    assert sorted(smooth_mesh(points, faces, merged=False).sources) == list(range(6))


def test_degenerate_triangles_have_finite_normals() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0)], float)
    mesh = smooth_mesh(points, np.array([(0, 1, 2), (0, 1, 3), (0, 0, 0)]))
    assert np.isfinite(mesh.normals).all()
