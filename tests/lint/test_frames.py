"""The frames of a robot at rest, compared with the kinematics room."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.shapes import angle_between, placement, product, rotation, transposed
from linkwright.kinematics import KinematicTree
from linkwright.lint.frames import compute_placements
from linkwright.urdf import Joint, Link, Pose, Robot

_COORDINATES = st.floats(-10, 10)
_ANGLES = st.floats(-pi, pi)
_POSES = st.builds(Pose, st.tuples(_COORDINATES, _COORDINATES, _COORDINATES), st.tuples(_ANGLES, _ANGLES, _ANGLES))


@given(_POSES, _POSES)
def test_link_placements_match_kinematics(first, second):
    links = {name: Link(name) for name in "abc"}
    joints = {
        "j": Joint("j", "revolute", "a", "b", first),
        "k": Joint("k", "fixed", "b", "c", second),
    }
    robot = Robot("r", "a", links, joints, {})
    tree = KinematicTree(robot)
    matrices = tree.forward(np.zeros(1))
    for name, link_placement in compute_placements(robot).items():
        matrix = matrices[tree.link_index(name)]
        np.testing.assert_allclose(link_placement.rotation, matrix[:3, :3], atol=1e-9)
        np.testing.assert_allclose(link_placement.position, matrix[:3, 3], atol=1e-9)


@given(_POSES, _POSES)
def test_seen_from_and_inside_are_inverse(first, second):
    first_placement, second_placement = placement(first), placement(second)
    back = first_placement.seen_from(second_placement).inside(second_placement)
    np.testing.assert_allclose(back.position, first_placement.position, atol=1e-9)
    assert angle_between(back.rotation, first_placement.rotation) == pytest.approx(0.0, abs=1e-6)


def test_angle_between_rotations_is_computed():
    first, second = rotation(Pose(rpy=(0.3, 0.0, 0.0))), rotation(Pose(rpy=(0.5, 0.0, 0.0)))
    assert angle_between(first, second) == pytest.approx(0.2)
    assert angle_between(product(first, transposed(first)), rotation(Pose())) == pytest.approx(0.0)
