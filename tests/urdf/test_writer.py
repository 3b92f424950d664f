"""The conversion of robots to URDF and back."""

from __future__ import annotations

from hypothesis import given

from linkwright.descriptions import load
from linkwright.urdf import read, save
from linkwright.xmltree import parse
from tests.places import PACKAGE
from tests.urdf.robots import chain_of_links, robot_text, robots


@given(robots())
def test_round_trip_keeps_robot_and_order(robot):
    reread = read(parse(save(robot), "saved.urdf")).robot
    assert reread == robot
    assert list(reread.links) == list(robot.links)
    assert list(reread.joints) == list(robot.joints)


def test_saving_twice_returns_same_text():
    robot = load(PACKAGE / "urdf" / "mbot_base.urdf")
    assert save(load(save(robot))) == save(robot)


def test_saved_text_is_formatted():
    text = robot_text(
        '<material name="m"><color rgba="1 0.5 0 1"/></material>',
        chain_of_links('revolute:<limit lower="-1.50" upper="1" effort="10" velocity="1e-3"/><origin xyz="0 0 .1"/>'),
        '<gazebo reference="a"><mu1>0.2</mu1></gazebo>',
    )
    assert save(load(text)) == (
        '<?xml version="1.0" ?>\n'
        '<robot name="r">\n'
        '  <material name="m">\n'
        '    <color rgba="1 0.5 0 1"/>\n'
        "  </material>\n"
        '  <link name="a"/>\n'
        '  <link name="b"/>\n'
        '  <joint name="j0" type="revolute">\n'
        '    <origin xyz="0 0 0.1"/>\n'
        '    <parent link="a"/>\n'
        '    <child link="b"/>\n'
        '    <axis xyz="1 0 0"/>\n'
        '    <limit effort="10" lower="-1.5" upper="1" velocity="0.001"/>\n'
        "  </joint>\n"
        '  <gazebo reference="a">\n'
        "    <mu1>0.2</mu1>\n"
        "  </gazebo>\n"
        "</robot>\n"
    )


def test_prefixed_elements_keep_namespace_declaration():
    text = '<robot name="r" xmlns:gz="urn:gz"><link name="a"/><gz:thing gz:size="1"/></robot>'
    saved = save(load(text))
    assert 'xmlns:gz="urn:gz"' in saved
    assert [element.tag for element in load(saved).extensions] == ["gz:thing"]


def test_limits_of_urdf_1_2_round_trip():
    text = robot_text(
        chain_of_links(
            'continuous:<limit effort="3"/>', 'revolute:<limit lower="0" upper="1" acceleration="2" jerk="4"/>'
        ),
        version="1.2",
    )
    robot = load(text)
    assert load(save(robot)) == robot
    assert '<limit effort="3"/>' in save(robot)


def test_quaternions_of_urdf_1_1_round_trip():
    robot = load(robot_text(chain_of_links('fixed:<origin quat_xyzw="0.5 0.5 0.5 0.5"/>'), version="1.1"))
    assert 'quat_xyzw="0.5 0.5 0.5 0.5"' in save(robot)
    assert load(save(robot)) == robot
