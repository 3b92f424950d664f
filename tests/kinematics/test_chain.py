"""Chains of joints: poses of links and Jacobians."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import LinkwrightError
from linkwright.kinematics.chain import KinematicChain

ARM = """<robot name='r'>
<link name='world'/><link name='base'/><link name='a'/><link name='b'/><link name='c'/><link name='tool'/>
<link name='side'/>
<joint name='mount' type='fixed'><parent link='world'/><child link='base'/>
<origin xyz='5 1 2' rpy='0.3 0.2 1'/></joint>
<joint name='turn' type='continuous'><parent link='base'/><child link='a'/>
<origin xyz='0 0 1' rpy='0.1 0 0'/><axis xyz='0 0 2'/></joint>
<joint name='lift' type='prismatic'><parent link='a'/><child link='b'/>
<origin xyz='1 0 0' rpy='0 1 0'/><axis xyz='1 0 0'/>
<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>
<joint name='follow' type='revolute'><parent link='b'/><child link='c'/><origin xyz='0 0.5 0'/><axis xyz='0 1 0'/>
<limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='turn' multiplier='-0.5' offset='0.1'/></joint>
<joint name='tip' type='fixed'><parent link='c'/><child link='tool'/><origin xyz='0.2 0 0.3' rpy='0 0 1'/></joint>
<joint name='other' type='continuous'><parent link='a'/><child link='side'/><axis xyz='1 0 0'/></joint>
</robot>"""


def make_chain(base: str = "base", tip: str = "tool") -> KinematicChain:
    """Return a chain of the arm."""
    robot = DescriptionLibrary().read(ARM).robot
    assert robot is not None
    return KinematicChain(robot, base, tip)


def test_chain_has_joints_and_links_between_base_and_tip():
    chain = make_chain()
    assert chain.joint_names == ("turn", "lift")
    assert chain.links == ("base", "a", "b", "c", "tool")


def test_poses_are_relative_to_base():
    configuration = make_chain().configure({"turn": 0.0, "lift": 0.0})
    assert configuration.link_frame("base") == pytest.approx(np.eye(4))
    assert configuration.link_frame("a")[:3, 3] == pytest.approx([0.0, 0.0, 1.0])


@pytest.mark.parametrize("link", ["a", "b", "tool"])
def test_jacobian_equals_differences_of_poses(link):
    chain, step = make_chain(), 1e-6
    positions = np.array([0.7, -0.3])
    jacobian = chain.configure(positions).jacobian(link)
    for column in range(2):
        change = np.zeros(2)
        change[column] = step
        first = chain.configure(positions - change).link_frame(link)
        second = chain.configure(positions + change).link_frame(link)
        turn = (second[:3, :3] - first[:3, :3]) / (2 * step) @ chain.configure(positions).link_frame(link)[:3, :3].T
        linear = (second[:3, 3] - first[:3, 3]) / (2 * step)
        assert jacobian[:3, column] == pytest.approx(linear, abs=1e-6)
        assert jacobian[3:, column] == pytest.approx([turn[2, 1], turn[0, 2], turn[1, 0]], abs=1e-6)


@pytest.mark.parametrize(
    ("base", "tip", "code"), [("side", "tool", "KIN104"), ("tool", "base", "KIN104"), ("base", "hand", "KIN103")]
)
def test_chain_that_does_not_exist_is_an_error(base, tip, code):
    with pytest.raises(LinkwrightError) as error:
        make_chain(base, tip)
    assert error.value.diagnostics[0].code == code
