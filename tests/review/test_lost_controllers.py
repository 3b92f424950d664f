"""Launch files and scripts that name controllers that a commit removes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANAGER = """controller_manager:
  ros__parameters:
    arm_controller: {type: a/Arm}
    hand_controller: {type: a/Hand}
"""
WITHOUT_HAND = MANAGER.replace("    hand_controller: {type: a/Hand}\n", "")
START = """# The start of the arm.
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("hand", default_value="hand_controller")])
"""
LOST = "names the controller 'hand_controller', which 'arm/config/c.yaml' no longer has"


@pytest.fixture
def find_breaking_lines(repository, compare):
    """Return the breaking lines about a removed controller beside files that stay as they are."""

    def run(files: dict[str, str]):
        repository.commit({"arm/package.xml": PACKAGE_XML, "arm/config/c.yaml": MANAGER, **files})
        repository.write({"arm/config/c.yaml": WITHOUT_HAND})
        return [line for line in breaking(compare(repository)) if line.startswith("names")]

    return run


@pytest.mark.parametrize(
    ("path", "text", "is_lost"),
    [
        ("arm/launch/arm.launch.py", START, True),
        ("arm/launch/arm.launch.py", START.replace("hand_controller", "arm_controller"), False),
        ("arm/launch/arm.launch.py", START.replace("    return", '    # "hand_controller" \n    return')
         .replace('"hand_controller")', '"arm")'), False),
        ("arm/launch/arm.launch",
         '<launch><node pkg="controller_manager" type="spawner" name="s" args="hand_controller"/></launch>', True),
        ("arm/scripts/grip.py", 'node.create_publisher(Float64, "/hand_controller/commands", 10)\n', True),
        ("arm/src/grip.cpp", 'auto p = node->create_publisher<Float64>("hand_controller/commands", 10);\n', True),
        ("arm/src/grip.cpp", 'std::string hand_controller = "hand_controller/commands";\n', False),
        ("arm/config/moveit_controllers.yaml",
         ("moveit_simple_controller_manager:\n  controller_names: [arm_controller, hand_controller]\n"
         "  hand_controller: {type: FollowJointTrajectory}\n"), True),
        ("arm/config/controllers.yaml", "controller_list:\n  - name: hand_controller\n    joints: [hand]\n", True),
        ("arm/config/controllers.yaml", "hand: {note: hand_controller}\n", False),
        ("arm/test/grip.py", 'node.create_publisher(Float64, "/hand_controller/commands", 10)\n', False),
    ],
)  # fmt: skip
def test_file_that_names_a_removed_controller_is_breaking(find_breaking_lines, path, text, is_lost):
    assert find_breaking_lines({path: text}) == [LOST] * is_lost


def test_controller_that_another_file_still_has_is_not_lost(find_breaking_lines):
    assert find_breaking_lines({"arm/launch/arm.launch.py": START, "arm/config/other.yaml": MANAGER}) == []


@pytest.mark.parametrize(
    ("name", "settings", "is_breaking"),
    [
        ("arm_controller", "arm_controller:\n  type: a/B\n  joint: a\n", True),
        ("arm_controller", "pid_gains:\n  joint: {p: 1}\n", True),
        ("pid_gains", "arm_controller:\n  type: a/B\npid_gains:\n  joint: {p: 1}\n", False),
    ],
)
def test_spawner_of_a_group_that_is_not_a_controller_started_nothing(repository, compare, name, settings, is_breaking):
    node = f'<node name="s" pkg="controller_manager" type="spawner" args="{name}"/>'
    repository.commit({"arm/launch/arm.launch": f"<launch>{node}</launch>\n", "arm/config/arm.yaml": settings})
    repository.write({"arm/launch/arm.launch": "<launch/>\n"})
    assert bool(breaking(compare(repository))) == is_breaking


SPAWNING = """<launch>
  <node pkg="controller_manager" exec="ros2_control_node"><param from="$(find-pkg-share arm)/{file}"/></node>
  {spawner}
</launch>
"""


@pytest.mark.parametrize(
    ("name", "file", "is_breaking"),
    [
        ("hand_controller", "arm.yaml", False),
        ("hand_controller -p hand.yaml", "arm.yaml", True),
        ("hand_controller", "of_another_package.yaml", True),
        ("arm_controller", "arm.yaml", True),
    ],
)
def test_spawner_of_a_controller_that_no_parameter_file_configures_started_nothing(
    repository, compare, name, file, is_breaking
):
    settings = "controller_manager:\n  ros__parameters:\n    arm_controller:\n      type: a/B\n"
    node = f"<node pkg='controller_manager' exec='spawner' args='{name}'><remap from='/a/b' to='/c'/></node>"
    path = "arm/launch/arm.launch.xml"
    repository.commit({path: SPAWNING.format(spawner=node, file=file), "arm/arm.yaml": settings})
    repository.write({path: SPAWNING.format(spawner="", file=file)})
    assert bool(breaking(compare(repository))) == is_breaking
    repository.write({path: SPAWNING.format(spawner=node.replace("<remap from='/a/b' to='/c'/>", ""), file=file)})
    assert breaking(compare(repository)) == []
