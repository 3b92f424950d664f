"""Which inertia tensors a body can have."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry import validity
from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.shapes import Bounds
from linkwright.geometry.solids import shape_properties
from linkwright.urdf import Box, Cylinder, Pose, Sphere

places = st.tuples(*[st.floats(-2.0, 2.0)] * 3)
angles = st.tuples(*[st.floats(-3.0, 3.0)] * 3)
shapes = st.one_of(
    st.builds(Box, st.tuples(*[st.floats(0.01, 3.0)] * 3)),
    st.builds(Cylinder, st.floats(0.01, 2.0), st.floats(0.01, 2.0)),
    st.builds(Sphere, st.floats(0.01, 2.0)),
)
bodies = st.lists(st.tuples(shapes, st.builds(Pose, places, angles), st.floats(1, 2e4)), min_size=1, max_size=4)


@given(bodies)
def test_bodies_of_combined_shapes_are_valid(parts):
    body = combine(shape_properties(shape, density).moved(pose) for shape, pose, density in parts)
    assert validity.find_excessive_products(body.inertia) == []
    assert validity.find_problems(body) == []


def test_triangle_excess_is_zero_for_disc_and_positive_beyond():
    assert validity.triangle_excess(np.diag((1.0, 1.0, 2.0))) == pytest.approx(0.0)
    assert validity.triangle_excess(np.diag((1.0, 1.0, 2.1))) > validity.TOLERANCE
    assert validity.triangle_excess(np.diag((1.0, 1.0, 4.0))) == pytest.approx(0.5)
    assert validity.triangle_excess(np.diag((1.0, 1.0, 1.0))) < 0


def test_products_of_inertia_are_bounded_by_moments():
    tensor = np.array(((1.0, 0.6, 0.0), (0.6, 1.0, 0.0), (0.0, 0.0, 1.0)))
    assert validity.find_excessive_products(tensor) == [("ixy", 0.5)]
    tensor[0, 1] = tensor[1, 0] = 0.5
    assert validity.find_excessive_products(tensor) == []
    tensor = np.array(((1.0, 0.0, 0.0), (0.0, 1.0, -3.0), (0.0, -3.0, 9.0)))
    assert validity.find_excessive_products(tensor) == [("iyz", 0.5)]


@given(bodies)
def test_largest_moment_bounds_bodies_in_box(parts):
    moved = [shape_properties(shape, density).moved(pose) for shape, pose, density in parts]
    corners = np.array([pose.xyz for _, pose, _ in parts])
    # Every shape here is within 3 m of its place.
    low, high = corners.min(axis=0) - 3.0, corners.max(axis=0) + 3.0
    body = combine(moved)
    box = Bounds(tuple(low.tolist()), tuple(high.tolist()))
    limit = validity.largest_moment_within(tuple(body.center.tolist()), box, body.mass)
    assert np.diag(body.inertia).max() <= limit


def test_problems_are_described_in_words():
    assert validity.find_problems(MassProperties(0.0)) == [
        "the mass is not positive",
        "the inertia tensor is not positive definite",
    ]
    body = MassProperties(1.0, np.zeros(3), np.diag((1.0, 1.0, 5.0)))
    assert validity.find_problems(body) == ["one principal moment of inertia is larger than the sum of the other two"]


@given(st.tuples(*[st.floats(-5.0, 5.0)] * 6), st.floats(-20, 20))
def test_relative_moments_match_eigenvalues(entries, exponent):
    xx, xy, xz, yy, yz, zz = entries
    tensor = np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))) * 10.0**exponent
    largest = np.abs(tensor).max()
    expected = np.linalg.eigvalsh(tensor / largest) if largest > 0 else np.zeros(3)
    assert np.allclose(validity.relative_moments(tensor), expected, rtol=0, atol=1e-14)
    assert validity.relative_moments(tensor) == validity.relative_moments(tensor.tolist())


def test_relative_moments_of_a_diagonal_tensor_are_exact():
    assert validity.relative_moments(((0.3, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.2))) == (0.1 / 0.3, 0.2 / 0.3, 1.0)
    assert validity.relative_moments(((float("nan"), 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))) == (0.0, 0.0, 0.0)
