"""Frames of links, compared with the frames from the room kinematics."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.descriptions import load
from linkwright.kinematics import KinematicTree, UnknownNameError
from linkwright.picture.link_frames import compute_link_frames
from tests.picture.test_same_pixels import ARM, MBOT
from tests.places import REPOSITORY

ROBOTS = [ARM, MBOT, REPOSITORY / "robots" / "my_robot_description" / "urdf" / "mbot_with_laser.urdf"]


@pytest.mark.parametrize("source", ROBOTS, ids=["arm", "kinect", "laser"])
def test_link_frames_match_kinematics(source: str) -> None:
    robot = load(source)
    tree = KinematicTree(robot)
    positions = {name: 0.5 + 0.3 * number for number, name in enumerate(tree.joint_names)}
    frames = compute_link_frames(robot, positions)
    assert set(frames) == set(tree.link_names)
    for name, matrix in zip(tree.link_names, tree.forward(positions), strict=True):
        np.testing.assert_allclose(frames[name].rotation, matrix[:3, :3], atol=1e-10)
        np.testing.assert_allclose(frames[name].position, matrix[:3, 3], atol=1e-10)


def test_joint_that_excludes_zero_starts_in_middle_of_limits() -> None:
    robot = load(ARM)
    by_default, with_position = compute_link_frames(robot, {}), compute_link_frames(robot, {"bend": 1.2})
    assert by_default == with_position


def test_unknown_and_mimic_joints_are_rejected() -> None:
    robot = load(ARM)
    with pytest.raises(UnknownNameError, match="no joint 'elbow'"):
        compute_link_frames(robot, {"elbow": 1.0})
    with pytest.raises(UnknownNameError, match="independent joint 'slide'"):
        compute_link_frames(robot, {"slide": 1.0})
