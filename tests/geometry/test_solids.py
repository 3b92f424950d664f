"""The formulas for solids, compared with numeric integration and meshes."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.geometry.polyhedron import polyhedron_properties
from linkwright.geometry.shapes import shape_volume
from linkwright.geometry.solids import shape_properties
from linkwright.urdf import Box, Capsule, Cylinder, Sphere

pytestmark = pytest.mark.extra("mesh")

sizes = st.floats(0.01, 2.0)


def integrate_discs(radius_at, half_height, steps=20_000):
    """Return the volume and moments of a body of revolution about z, integrated as thin discs."""
    dz = 2 * half_height / steps
    z = -half_height + dz * (np.arange(steps) + 0.5)
    r2 = radius_at(z) ** 2
    mass = np.pi * r2 * dz
    axial_inertia = (mass * r2 / 2).sum()
    transverse_inertia = (mass * (r2 / 4 + z**2)).sum()
    return mass.sum(), transverse_inertia, axial_inertia


@given(sizes, sizes)
@settings(max_examples=30)
def test_capsule_matches_numeric_integration(radius, length):
    def radius_at(z):
        distance_beyond_cylinder = np.maximum(np.abs(z) - length / 2, 0.0)
        return np.sqrt(np.maximum(radius**2 - distance_beyond_cylinder**2, 0.0))

    volume, transverse_inertia, axial_inertia = integrate_discs(radius_at, length / 2 + radius)
    body = shape_properties(Capsule(radius, length))
    assert body.mass == pytest.approx(volume, rel=1e-4)
    assert np.allclose(np.diag(body.inertia), (transverse_inertia, transverse_inertia, axial_inertia), rtol=1e-4)


@given(sizes)
@settings(max_examples=30)
def test_sphere_matches_numeric_integration(radius):
    volume, transverse_inertia, axial_inertia = integrate_discs(
        lambda z: np.sqrt(np.maximum(radius**2 - z**2, 0.0)), radius
    )
    body = shape_properties(Sphere(radius))
    assert body.mass == pytest.approx(volume, rel=1e-4)
    assert np.allclose(np.diag(body.inertia), (transverse_inertia, transverse_inertia, axial_inertia), rtol=1e-4)


@given(sizes, sizes)
@settings(max_examples=30)
def test_cylinder_matches_numeric_integration(radius, length):
    volume, transverse_inertia, axial_inertia = integrate_discs(lambda z: np.full_like(z, radius), length / 2)
    body = shape_properties(Cylinder(radius, length))
    assert body.mass == pytest.approx(volume, rel=1e-6)
    assert np.allclose(np.diag(body.inertia), (transverse_inertia, transverse_inertia, axial_inertia), rtol=1e-4)


@given(sizes, sizes, sizes)
def test_box_matches_its_mesh(a, b, c):
    mesh = trimesh.creation.box((a, b, c))
    body, solid = shape_properties(Box((a, b, c))), polyhedron_properties(mesh.vertices, mesh.faces)
    assert solid.mass == pytest.approx(body.mass)
    assert np.allclose(solid.center, 0, atol=1e-12)
    assert np.allclose(solid.inertia, body.inertia, rtol=1e-9, atol=1e-15)


def test_capsule_of_length_zero_is_sphere():
    capsule, sphere = shape_properties(Capsule(0.3, 0.0)), shape_properties(Sphere(0.3))
    assert capsule.mass == pytest.approx(sphere.mass)
    assert np.allclose(capsule.inertia, sphere.inertia)


@pytest.mark.parametrize("shape", [Box((1, 0, 1)), Box((1, -1, 1)), Sphere(0), Cylinder(-1, 1), Capsule(1, -1)])
def test_shape_without_positive_size_has_no_mass(shape):
    assert shape_properties(shape, 1000.0).mass == 0
    assert shape_volume(shape) == 0


@given(sizes, sizes, sizes)
def test_volume_is_mass_at_unit_density(a, b, c):
    for shape in (Box((a, b, c)), Cylinder(a, b), Capsule(a, b), Sphere(a)):
        assert shape_volume(shape) == pytest.approx(shape_properties(shape).mass)


@pytest.mark.parametrize("shape", [Sphere(1e308), Cylinder(1e308, 1.0), Capsule(1e308, 1.0), Box((1e308,) * 3)])
def test_overflowing_volume_is_infinite(shape):
    assert shape_volume(shape) == float("inf")
