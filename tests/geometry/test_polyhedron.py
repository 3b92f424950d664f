"""Volume, mass properties and closedness of triangle surfaces."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.geometry.hull import convex_hull
from linkwright.geometry.polyhedron import is_closed, merge_corners, polyhedron_properties

pytestmark = pytest.mark.extra("mesh")

coordinates = st.floats(-10, 10, width=32)
clouds = st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=4, max_size=60)


@pytest.mark.parametrize(
    "mesh",
    [
        trimesh.creation.torus(1.0, 0.3),
        trimesh.creation.icosphere(2, 0.5),
        trimesh.creation.annulus(0.2, 0.5, 0.1),
        trimesh.creation.cone(0.3, 1.0),
    ],
    ids=["torus", "ball", "ring", "cone"],
)
@pytest.mark.parametrize("shift", [(0, 0, 0), (100, -50, 30)], ids=["near", "far"])
def test_polyhedron_properties_match_trimesh(mesh, shift):
    mesh = mesh.copy()
    mesh.apply_translation(shift)
    body = polyhedron_properties(mesh.vertices, mesh.faces)
    assert body.mass == pytest.approx(mesh.mass)
    assert np.allclose(body.center, mesh.center_mass)
    assert np.allclose(body.inertia, mesh.moment_inertia, rtol=1e-4, atol=1e-6)


def test_triangle_orientation_does_not_change_mass_properties():
    mesh = trimesh.creation.cone(0.3, 1.0)
    outward = polyhedron_properties(mesh.vertices, mesh.faces)
    inward = polyhedron_properties(mesh.vertices, mesh.faces[:, ::-1])
    assert inward.mass == pytest.approx(outward.mass)
    assert np.allclose(inward.inertia, outward.inertia)


def test_flat_surface_has_no_mass():
    square = np.array(((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)), dtype=float)
    assert polyhedron_properties(square, np.array(((0, 1, 2), (0, 2, 3)))).mass == 0
    assert polyhedron_properties(square, np.zeros((0, 3), dtype=np.int64)).mass == 0


def test_coincident_corners_are_merged():
    mesh = trimesh.creation.icosphere(1)
    unmerged = mesh.vertices[mesh.faces].reshape(-1, 3)
    vertices, faces = merge_corners(unmerged, np.arange(len(unmerged)).reshape(-1, 3))
    assert len(vertices) == len(mesh.vertices)
    assert is_closed(faces)


def test_triangles_without_area_are_dropped():
    vertices = np.array(((0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 1, 0)), dtype=float)
    assert len(merge_corners(vertices, np.array(((0, 1, 2), (0, 1, 3))))[1]) == 1
    assert len(merge_corners(np.zeros((3, 3)), np.array(((0, 1, 2),)))[1]) == 0


def test_surface_with_hole_or_flipped_triangle_is_not_closed():
    faces = trimesh.creation.box().faces.astype(np.int64)
    assert is_closed(faces)
    assert not is_closed(faces[1:])
    turned = faces.copy()
    turned[0] = turned[0][::-1]
    assert not is_closed(turned)
    assert not is_closed(faces[:0])


@given(clouds)
@settings(max_examples=150)
def test_hull_is_closed_convex_and_contains_all_points(cloud):
    points = np.array(cloud, dtype=np.float64)
    faces = convex_hull(points)
    size = np.ptp(points, axis=0).max()
    if faces is None:
        assert np.linalg.matrix_rank(points - points[0], tol=1e-6 * max(size, 1e-30)) < 3
        return
    assert is_closed(faces)
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    for normal, area, corner in zip(normals, areas, a, strict=True):
        if area > 1e-6 * size * size:  # rounding determines the normal of a sliver
            assert ((points - corner) @ (normal / area)).max() <= 1e-6 * size
    assert polyhedron_properties(points, faces).mass >= 0


def test_hull_of_grid_is_its_box():
    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3), -1).reshape(-1, 3)
    faces = convex_hull(grid)
    assert faces is not None
    assert polyhedron_properties(grid, faces).mass == pytest.approx(125.0)


@pytest.mark.parametrize(("count", "noise", "seed"), [(128, 1e-8, 5), (256, 1e-7, 13), (512, 3e-9, 13)])
def test_hull_of_nearly_coplanar_points_is_closed(count, noise, seed):
    """Such points occur in meshes from CAD, which are rounded to single precision."""
    random = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(count)])
    rings = np.vstack([circle * radius + (0, 0, z) for z in (0, 1) for radius in (1, 0.99, 0.5)])
    points = rings + random.uniform(-noise, noise, rings.shape)
    faces = convex_hull(points)
    assert faces is not None
    assert is_closed(faces)
    assert polyhedron_properties(points, faces).mass == pytest.approx(count / 2 * np.sin(2 * np.pi / count))


def test_hull_of_sphere_points_uses_all_points():
    ball = trimesh.creation.icosphere(3)
    faces = convex_hull(np.asarray(ball.vertices))
    assert faces is not None
    assert len(np.unique(faces)) == len(ball.vertices)
    assert polyhedron_properties(ball.vertices, faces).mass == pytest.approx(ball.volume)


@pytest.mark.parametrize(
    "points",
    [np.zeros((3, 3)), np.zeros((9, 3)), np.outer(np.arange(9.0), (1, 2, 3)), np.eye(3)[[0, 1, 2, 0, 1]]],
    ids=["few", "one", "line", "plane"],
)
def test_coplanar_points_have_no_hull(points):
    assert convex_hull(points) is None


def make_turned_rings(count: int, rows: int, seed: int):
    """Return rings of points with a common axis, rounded to 32 bits as in a mesh file."""
    angles = np.arange(count) * 2.0 * np.pi / count
    rings = [
        np.stack([np.cos(angles), np.sin(angles), np.full(count, height)], axis=1)
        for height in np.linspace(0.0, 1.0, rows)
    ]
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return (0.03 * np.concatenate(rings) @ rotation.T + 0.1).astype(np.float32).astype(np.float64)


@pytest.mark.parametrize(("count", "rows", "seed"), [(128, 20, 3), (128, 20, 4), (360, 20, 1)])
def test_hull_of_turned_rings_is_closed(count, rows, seed):
    """Rounding makes the edge around the faces that a new point sees touch itself."""
    points = make_turned_rings(count, rows, seed)
    faces = convex_hull(points)
    assert faces is not None
    assert is_closed(faces)
    assert len(faces) == 2 * len(np.unique(faces)) - 4
    area = 0.5 * count * np.sin(2.0 * np.pi / count)
    assert polyhedron_properties(points, faces).mass == pytest.approx(0.03**3 * area, rel=1e-5)
