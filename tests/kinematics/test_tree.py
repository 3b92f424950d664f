"""Forward kinematics, compared with the definition for each joint."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.descriptions import load
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import matrix_from_pose, quaternion_from_rpy
from linkwright.kinematics import KinematicTree, UnknownNameError
from linkwright.urdf import Robot, parent_joints
from tests.geometry.rotations import quaternion_about
from tests.urdf.robots import chain_of_links, robot_text, robots


def expected_frame(robot: Robot, link: str, values: dict[str, float]) -> np.ndarray:
    """Return the frame of a link in the root, by the definition.

    It is the product of all frames up to the root.
    """
    if link == robot.root:
        return np.eye(4)
    joint = parent_joints(robot)[link]
    origin = matrix_from_pose([*joint.origin.xyz, *quaternion_from_rpy(joint.origin.rpy)])
    motion = np.eye(4)
    length = np.linalg.norm(joint.axis)
    if joint.type in ("revolute", "continuous"):
        turn = quaternion_about(joint.axis, joint_value(robot, joint.name, values))
        motion = matrix_from_pose([0, 0, 0, *turn])
    elif joint.type == "prismatic" and length > 0:
        motion[:3, 3] = np.array(joint.axis) / length * joint_value(robot, joint.name, values)
    return expected_frame(robot, joint.parent, values) @ origin @ motion


def joint_value(robot: Robot, joint: str, values: dict[str, float]) -> float:
    mimic = robot.joints[joint].mimic
    if mimic is None:
        return values.get(joint, 0.0)
    return mimic.multiplier * joint_value(robot, mimic.joint, values) + mimic.offset


def assert_frames(found, robot, tree, values):
    expected = np.array([expected_frame(robot, link, values) for link in tree.link_names])
    # Each mimic joint multiplies by up to 1e6, so angles and lengths may be huge: the tolerance is relative to them.
    size = 1 + np.abs(expected).max() + max([abs(joint_value(robot, name, values)) for name in robot.joints], default=0)
    np.testing.assert_allclose(found, expected, atol=1e-9 * size)


def is_small(robot: Robot) -> bool:
    mimics = [joint.mimic for joint in robot.joints.values() if joint.mimic]
    return all(abs(mimic.multiplier) < 100 and abs(mimic.offset) < 100 for mimic in mimics)


@settings(max_examples=60)
@given(robots().filter(is_small), st.integers(0, 2**31))
def test_frames_are_product_of_parent_joint_transforms(robot, seed):
    tree = KinematicTree(robot)
    assert set(tree.link_names) == set(robot.links)
    positions = np.random.default_rng(seed).uniform(-2, 2, (3, len(tree.joint_names)))
    many = tree.forward(positions)
    assert many.shape == (3, len(robot.links), 4, 4)
    for row, frames in zip(positions, many, strict=True):
        values = dict(zip(tree.joint_names, row, strict=True))
        assert_frames(frames, robot, tree, values)
        assert_frames(tree.forward(row), robot, tree, values)


ARM = load(
    robot_text(
        chain_of_links(
            'revolute:<origin xyz="0 0 1"/><axis xyz="0 0 1"/>',
            'prismatic:<origin xyz="1 0 0"/><axis xyz="0 2 0"/>',
            'fixed:<origin xyz="0 0 0.5" rpy="0 0 1"/>',
            'continuous:<axis xyz="1 1 1"/>',
        )
    )
)


class TestArm:
    tree = KinematicTree(ARM)

    def test_joint_and_link_names(self):
        assert self.tree.joint_names == ("j0", "j1", "j3")
        assert self.tree.link_names == ("a", "b", "c", "d", "e")

    def test_prismatic_joint_moves_along_rotated_axis(self):
        frames = self.tree.forward([pi / 2, 0.25, 0])
        # The joint moves along y of a frame that is rotated by 90 degrees, so along -x. Its axis is normalized.
        np.testing.assert_allclose(frames[self.tree.link_index("c")][:3, 3], [-0.25, 1, 1], atol=1e-12)

    def test_rotation_about_diagonal_axis_permutes_coordinate_axes(self):
        frames = self.tree.forward([0, 0, 2 * pi / 3])
        turn = frames[self.tree.link_index("d")][:3, :3].T @ frames[self.tree.link_index("e")][:3, :3]
        np.testing.assert_allclose(turn, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-12)

    def test_positions_can_be_given_by_joint_name(self):
        by_name = self.tree.forward({"j1": 0.5})
        np.testing.assert_array_equal(by_name, self.tree.forward([0, 0.5, 0]))
        np.testing.assert_array_equal(self.tree.positions({"j3": 1}, default=0.5), [0.5, 0.5, 1])

    def test_forward_broadcasts_leading_axes(self):
        assert self.tree.forward(np.zeros((2, 5, 3))).shape == (2, 5, 5, 4, 4)
        assert self.tree.forward(np.zeros((0, 3))).shape == (0, 5, 4, 4)

    def test_configurations_beyond_block_size(self):
        positions = np.random.default_rng(0).uniform(-1, 1, (1000, 3))
        many = self.tree.forward(positions)
        for place in (0, 383, 384, 999):
            np.testing.assert_allclose(many[place], self.tree.forward(positions[place]), atol=1e-12)

    @pytest.mark.parametrize("shape", [(2,), (4,), (5, 2), (), (3, 0)])
    def test_wrong_array_shape_is_reported(self, shape):
        with pytest.raises(ValueError) as caught:
            self.tree.forward(np.zeros(shape))
        assert str(caught.value) == f"positions must have the shape (3,) or (configurations, 3), not {shape}"

    def test_unknown_joint_is_rejected(self):
        with pytest.raises(UnknownNameError) as caught:
            self.tree.forward({"j_3": 1})
        assert caught.value.name == "j_3"
        assert isinstance(caught.value, LinkwrightError)
        diagnostic = caught.value.diagnostics[0]
        assert (diagnostic.code, diagnostic.message) == ("KIN101", "the robot has no joint 'j_3'")
        assert "'j3'" in diagnostic.hint

    def test_position_of_fixed_joint_is_rejected(self):
        with pytest.raises(UnknownNameError) as caught:
            self.tree.positions({"j2": 1})
        assert caught.value.diagnostics[0].hint == "it is fixed and does not move"

    def test_unknown_link_is_rejected(self):
        with pytest.raises(UnknownNameError, match="the robot has no link 'z'"):
            self.tree.link_index("z")


class TestMimic:
    CHAIN = robot_text(
        chain_of_links(
            "continuous",
            'continuous:<mimic joint="j0" multiplier="2" offset="0.5"/>',
            'prismatic:<mimic joint="j1" multiplier="-1" offset="0.1"/>',
        )
    )

    def test_mimic_chain_is_followed_to_source_joint(self):
        robot = load(self.CHAIN)
        tree = KinematicTree(robot)
        assert tree.joint_names == ("j0",)
        assert_frames(tree.forward([0.3]), robot, tree, {"j0": 0.3})
        assert_frames(tree.forward([[0.3]])[0], robot, tree, {"j0": 0.3})

    def test_position_of_mimic_joint_is_rejected(self):
        with pytest.raises(UnknownNameError) as caught:
            KinematicTree(load(self.CHAIN)).forward({"j2": 1})
        assert caught.value.diagnostics[0].code == "KIN102"
        assert caught.value.diagnostics[0].hint == "it mimics 'j0': give the position of that joint"

    @pytest.mark.parametrize("joint", ["j0", "nowhere"])
    def test_mimic_joint_without_valid_source_moves_independently(self, joint):
        robot = load(robot_text(chain_of_links(f'continuous:<mimic joint="{joint}"/>')))
        assert KinematicTree(robot).joint_names == ("j0",)

    def test_circular_mimic_joints_move_independently(self):
        robot = load(robot_text(chain_of_links('continuous:<mimic joint="j1"/>', 'continuous:<mimic joint="j0"/>')))
        assert KinematicTree(robot).joint_names == ("j0", "j1")

    @pytest.mark.parametrize("other_joints", [(), ("continuous",)])
    def test_mimic_of_fixed_joint_stays_at_offset(self, other_joints):
        follower = 'continuous:<axis xyz="0 0 1"/><mimic joint="j0" multiplier="3" offset="0.5"/>'
        robot = load(robot_text(chain_of_links("fixed", follower, *other_joints)))
        tree = KinematicTree(robot)
        assert len(tree.joint_names) == len(other_joints)
        for frames in (tree.forward([7.0] * len(other_joints)), tree.forward(np.full((2, len(other_joints)), 7.0))[1]):
            np.testing.assert_allclose(np.arccos(frames[2, 0, 0]), 0.5)


class TestJointsWithoutPosition:
    """Joints that do not move."""

    @pytest.mark.parametrize("kind", ["fixed", "floating", "planar"])
    def test_fixed_floating_and_planar_joints_have_no_position(self, kind):
        tree = KinematicTree(load(robot_text(chain_of_links(f'{kind}:<origin xyz="1 2 3"/>'))))
        assert tree.joint_names == ()
        np.testing.assert_array_equal(tree.forward([])[1][:3, 3], [1, 2, 3])
        assert tree.forward(np.empty((4, 0))).shape == (4, 2, 4, 4)

    def test_joint_without_axis_direction_has_no_position(self):
        tree = KinematicTree(load(robot_text(chain_of_links("continuous:<axis/>"))))
        assert tree.joint_names == ()

    def test_forward_of_single_link_robot(self):
        tree = KinematicTree(load(robot_text('<link name="only"/>')))
        np.testing.assert_array_equal(tree.forward([]), [np.eye(4)])
        np.testing.assert_array_equal(tree.forward(np.empty((2, 0))), [[np.eye(4)]] * 2)


def test_links_not_connected_to_root_are_omitted():
    joint = '<joint name="{0}{1}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint>'
    links = '<link name="r"/><link name="a"/><link name="b"/>'
    assert KinematicTree(load(robot_text(links, joint.format("a", "b"), joint.format("b", "a")))).link_names == ("r",)


def test_deep_chain_is_supported():
    count = 400
    links = "".join(f'<link name="l{n}"/>' for n in range(count + 1))
    joints = "".join(
        f'<joint name="j{n}" type="continuous"><origin xyz="1 0 0"/><axis xyz="0 0 1"/>'
        f'<parent link="l{n}"/><child link="l{n + 1}"/></joint>'
        for n in range(count)
    )
    tree = KinematicTree(load(robot_text(links, joints)))
    circle = np.full(count, 2 * pi / count)
    tip_frames = [tree.forward(circle)[-1], tree.forward(circle[None])[0, -1]]
    for tip in tip_frames:
        np.testing.assert_allclose(tip, np.eye(4), atol=1e-9)
