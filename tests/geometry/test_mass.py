"""Mass properties of bodies: sums, equivalent boxes and principal axes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.solids import shape_properties
from linkwright.urdf import Box, Inertial, Pose, Sphere

lengths = st.floats(0.01, 3.0)
places = st.tuples(*[st.floats(-2.0, 2.0)] * 3)
angles = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@given(lengths, lengths, lengths, places, angles)
def test_moved_body_keeps_mass_and_principal_moments(a, b, c, xyz, rpy):
    body = shape_properties(Box((a, b, c)), 700.0)
    moved_body = body.moved(Pose(xyz, rpy))
    assert moved_body.mass == body.mass
    assert np.allclose(moved_body.center, xyz)
    assert np.allclose(moved_body.principal().moments, body.principal().moments, rtol=1e-9, atol=1e-12)


@given(lengths, lengths, lengths, st.floats(0.1, 0.9), places, angles)
def test_box_is_sum_of_its_parts(a, b, c, part, xyz, rpy):
    pose = Pose(xyz, rpy)
    left = shape_properties(Box((a * part, b, c))).moved(Pose((-a * (1 - part) / 2, 0, 0)))
    right = shape_properties(Box((a * (1 - part), b, c))).moved(Pose((a * part / 2, 0, 0)))
    box = shape_properties(Box((a, b, c))).moved(pose)
    combined = combine([left.moved(pose), right.moved(pose)])
    assert combined.mass == pytest.approx(box.mass)
    assert np.allclose(combined.center, box.center)
    assert np.allclose(combined.inertia, box.inertia, rtol=1e-8, atol=1e-10)


@given(lengths, lengths, lengths, places, angles)
def test_equivalent_box_of_box_is_same_box(a, b, c, xyz, rpy):
    edges = shape_properties(Box((a, b, c)), 1000.0).moved(Pose(xyz, rpy)).equivalent_box()
    assert edges is not None
    # The smallest moment belongs to the longest edge.
    assert np.allclose(edges, sorted((a, b, c), reverse=True), rtol=1e-4, atol=1e-5)


def test_impossible_moments_have_no_equivalent_box():
    assert MassProperties(1.0, np.zeros(3), np.diag((0.1, 0.1, 1.0))).equivalent_box() is None
    assert MassProperties(0.0).equivalent_box() is None


@given(lengths, places, places)
def test_parallel_axis_theorem(radius, center, point):
    body = shape_properties(Sphere(radius), 500.0).moved(Pose(center))
    arm = np.array(center) - np.array(point)
    inertia = body.inertia_about(point)
    expected = 2 / 5 * body.mass * radius**2 + body.mass * (arm[1] ** 2 + arm[2] ** 2)
    assert inertia[0, 0] == pytest.approx(expected)
    assert inertia[0, 1] == pytest.approx(-body.mass * arm[0] * arm[1])


def test_principal_axes_diagonalize_inertia_tensor():
    body = shape_properties(Box((0.1, 0.2, 0.4)), 1000.0).moved(Pose((1, 2, 3), (0.3, -0.5, 0.7)))
    principal = body.principal()
    assert np.linalg.det(principal.axes) == pytest.approx(1.0)
    assert np.allclose(principal.axes.T @ body.inertia @ principal.axes, np.diag(principal.moments))
    assert list(principal.moments) == sorted(principal.moments)


def test_rotated_inertial_is_transformed_to_link_frame():
    quarter = np.pi / 2
    body = Inertial(2.0, 1.0, 0.0, 0.0, 2.0, 0.0, 3.0, Pose((0.1, 0, 0), (0, 0, quarter))).properties
    assert np.allclose(body.inertia, np.diag((2.0, 1.0, 3.0)))
    assert np.allclose(body.center, (0.1, 0, 0))


@given(lengths, places, angles)
def test_inertial_round_trip_keeps_mass_properties(edge, xyz, rpy):
    body = shape_properties(Box((edge, 2 * edge, 3 * edge)), 800.0).moved(Pose(xyz, rpy))
    round_trip = Inertial.of(body).properties
    assert round_trip.mass == body.mass
    assert np.allclose(round_trip.center, body.center)
    assert np.allclose(round_trip.inertia, body.inertia)


def test_empty_sum_has_no_mass():
    assert combine([]).mass == 0
    assert combine([MassProperties(0.0)]).mass == 0


def test_with_mass_scales_inertia():
    body = shape_properties(Sphere(0.1)).with_mass(3.0)
    assert body.mass == 3.0
    assert body.inertia[0, 0] == pytest.approx(2 / 5 * 3.0 * 0.01)
    with pytest.raises(ValueError, match="without mass"):
        MassProperties(0.0).with_mass(1.0)
