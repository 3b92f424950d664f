"""Checks of robots: they accept any notation, and report a missing part in one sentence."""

import pytest

from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, Work

URDF = """<robot name="r">
  <link name="base_link">
    <visual><geometry><cylinder radius="0.2" length="0.16"/></geometry>
      <material name="orange"><color rgba="1 0.4 0 1"/></material></visual>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.4 0.2"/></geometry></collision>
    <inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="left_wheel_link">
    <visual><origin rpy="1.57 0 0"/><geometry><cylinder radius="0.06" length="0.025"/></geometry></visual>
  </link>
  <joint name="left_wheel_joint" type="continuous">
    <origin xyz="0 0.19 -0.05"/><parent link="base_link"/><child link="left_wheel_link"/><axis xyz="0 2 0"/>
  </joint>
</robot>
"""


@pytest.fixture
def robot(tmp_path):
    (tmp_path / "r.urdf").write_text(URDF)
    return Work(tmp_path, lesson=tmp_path).robot("r.urdf")


def test_fulfilled_expectations_pass(robot):
    base, wheel = robot.link("base_link"), robot.link("left_wheel_link")
    base.expect_shape(ShapeSpec(Cylinder(0.2, 0.16), along=(0, 0, 1), at=(0, 0, 0)))
    base.expect_shape(ShapeSpec(Box((0.4, 0.4, 0.2)), at=(0, 0, 0.1)), "collision")
    base.expect_color((1, 0.4, 0))
    base.expect_mass(1.5, 2.5)
    wheel.expect_shape(ShapeSpec(Cylinder(0.06, 0.025), along=(0, 1, 0)))
    joint = robot.joint("left_wheel_joint")
    joint.expect_type("continuous", "revolute")
    joint.expect_links("base_link", "left_wheel_link")
    joint.expect_axis((0, 1, 0))
    robot.expect_position("left_wheel_link", (0, 0.19, -0.05))
    robot.expect_position("base_link", (0, -0.19, 0.05), frame="left_wheel_link")


@pytest.mark.parametrize(
    ("expectation", "message"),
    [
        (
            lambda robot: robot.link("left_whell_link"),
            "no link is called 'left_whell_link'; there is 'left_wheel_link'",
        ),
        (lambda robot: robot.joint("x"), "no joint is called 'x'"),
        (
            lambda robot: robot.link("base_link").expect_shape(ShapeSpec(Cylinder(0.2, 0.1))),
            "the visual of 'base_link': its length is 0.16 m, but should be 0.1 m",
        ),
        (
            lambda robot: robot.link("base_link").expect_shape(ShapeSpec(Sphere(0.2))),
            "the visual of 'base_link': it is a cylinder, but should be a sphere",
        ),
        (
            lambda robot: robot.link("left_wheel_link").expect_shape(ShapeSpec(Cylinder(0.06, 0.025), along=(0, 0, 1))),
            "its axis points along 0 -1 0.0008, but should point along 0 0 1",
        ),
        (
            lambda robot: robot.link("left_wheel_link").expect_shape(ShapeSpec(Box((1, 1, 1))), "collision"),
            "the link 'left_wheel_link' has no <collision>",
        ),
        (lambda robot: robot.link("left_wheel_link").expect_mass(1, 2), "has no <inertial>"),
        (lambda robot: robot.link("base_link").expect_mass(3, 4), "is 2 kg, but should be between 3 and 4 kg"),
        (lambda robot: robot.link("base_link").expect_color((0, 0, 1)), "has the color 1 0.4 0"),
        (lambda robot: robot.link("left_wheel_link").expect_color((0, 0, 1)), "has no color"),
        (lambda robot: robot.joint("left_wheel_joint").expect_type("fixed"), "has the type 'continuous'"),
        (
            lambda robot: robot.joint("left_wheel_joint").expect_links("left_wheel_link", "base_link"),
            "are exchanged: the parent must be 'left_wheel_link'",
        ),
        (
            lambda robot: robot.joint("left_wheel_joint").expect_links("base_link", "x"),
            "should connect 'base_link' and 'x'",
        ),
        (lambda robot: robot.joint("left_wheel_joint").expect_axis((0, -1, 0)), "has the wrong sign"),
        (lambda robot: robot.joint("left_wheel_joint").expect_axis((1, 0, 0)), "is 0 2 0, but should be 1 0 0"),
        (
            lambda robot: robot.expect_position("left_wheel_link", (0, 0.2, 0)),
            "the frame of 'left_wheel_link' is at 0 0.19 -0.05 in the frame of 'base_link', but should be at 0 0.2 0",
        ),
    ],
)
def test_failed_expectation_message_is_specific_and_bilingual(robot, expectation, message):
    with pytest.raises(NotYet) as raised:
        expectation(robot)
    assert message in str(raised.value)
    assert set(raised.value.text.texts) == {"en", "zh"}


@pytest.mark.extra("sim")
def test_robot_with_visuals_only_is_completed_and_simulated(tmp_path):
    wheel = URDF[URDF.index('  <link name="left') : URDF.index("</robot>")]
    right = wheel.replace("left", "right").replace("0.19", "-0.19")
    ball = """<link name="ball"><visual><geometry><sphere radius="0.02"/></geometry></visual></link>
      <joint name="ball_joint" type="fixed"><origin xyz="-0.15 0 -0.09"/><parent link="base_link"/><child link="ball"/>
      </joint>"""
    (tmp_path / "r.urdf").write_text(URDF.replace("</robot>", right + ball + "</robot>"))
    work = Work(tmp_path, lesson=tmp_path)
    with work.simulate("r.urdf") as test:
        assert test.robot_pose()[2] == pytest.approx(0.11)
        test.drive(0.5)
        test.advance(2.0)
        assert test.robot_pose()[0] > 0.8


@pytest.mark.extra("sim")
def test_robot_without_drive_is_reported(robot, tmp_path):
    with pytest.raises(NotYet, match="DRIVE20"), Work(tmp_path, lesson=tmp_path).simulate("r.urdf"):
        pass


def test_invalid_description_is_reported_with_line(tmp_path):
    (tmp_path / "r.urdf").write_text(URDF.replace(' length="0.16"', ""))
    with pytest.raises(NotYet, match=r"r\.urdf, line 3, column \d+: .*'length'"):
        Work(tmp_path, lesson=tmp_path).robot("r.urdf")
    (tmp_path / "r.urdf").write_text("<robot>")
    with pytest.raises(NotYet, match=r"r\.urdf, line 1"):
        Work(tmp_path, lesson=tmp_path).robot("r.urdf")


def test_missing_and_empty_files_are_reported(tmp_path):
    work = Work(tmp_path, lesson=tmp_path)
    (tmp_path / "robot.urdf").write_text("")
    with pytest.raises(NotYet, match=r"'robot\.urdf' is empty"):
        work.robot("robot.urdf")
    with pytest.raises(NotYet, match=r"has no file 'robto\.urdf'; it has 'robot\.urdf'"):
        work.robot("robto.urdf")


def test_package_is_found_by_manifest(tmp_path):
    work = Work(tmp_path, lesson=tmp_path)
    with pytest.raises(NotYet, match="no package 'mbot' below 'src'"):
        work.package("mbot")
    folder = tmp_path / "src" / "group" / "other"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>mbto</name></package>")
    with pytest.raises(NotYet, match="its packages are 'mbto'"):
        work.package("mbot")
    (folder / "package.xml").write_text("<package><name>mbot</name></package>")
    assert work.package("mbot").folder == folder


MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>p</name>
  <version>0.0.0</version>
  <description>A robot</description>
  <maintainer email="a@b.org">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(p)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch urdf DESTINATION share/${PROJECT_NAME})
ament_package()
"""


def test_missing_dependency_fails_check_and_advice_does_not(tmp_path):
    folder = tmp_path / "src" / "p"
    (folder / "launch").mkdir(parents=True)
    (folder / "urdf").mkdir()
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "CMakeLists.txt").write_text(CMAKE)
    (folder / "urdf" / "r.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <link name="base_link"><weight>3</weight></link>\n</robot>\n'
    )
    package = Work(tmp_path, lesson=tmp_path).package("p")
    package.expect_no_findings()
    (folder / "launch" / "a.launch.py").write_text(
        "from ament_index_python.packages import get_package_share_directory\n\n"
        "def generate_launch_description():\n    get_package_share_directory('rviz2')\n"
    )
    with pytest.raises(NotYet, match=r"package\.xml, line 2, column 1: .*'rviz2' \[LW848\]; add"):
        package.expect_no_findings()


def test_number_is_compared_and_known_slips_have_messages(tmp_path):
    slip = NotYet(en="That is the diameter.")
    work = Work(tmp_path, lesson=tmp_path, answer=" 0,06 ")
    work.expect_number(0.06, tolerance=0.001)
    with pytest.raises(NotYet, match="diameter"):
        work.expect_number(0.03, tolerance=0.001, slips={0.06: slip})
    with pytest.raises(NotYet, match="is not correct"):
        work.expect_number(0.03, tolerance=0.001)
    with pytest.raises(NotYet, match="no answer yet"):
        Work(tmp_path, lesson=tmp_path).number()
    with pytest.raises(NotYet, match="'six' is not a number"):
        Work(tmp_path, lesson=tmp_path, answer="six").number()
