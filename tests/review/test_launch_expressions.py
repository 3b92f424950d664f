"""Substitutions in Python launch files that by default give the same text, in a review."""

from __future__ import annotations

import pytest

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot = LaunchConfiguration("robot")
    return LaunchDescription([
        DeclareLaunchArgument("robot", default_value="arm"),
        Node(package="controller_manager", executable="spawner", arguments=["arm_controller"]),
        Node(package="arm", executable="driver", parameters=[
            PathJoinSubstitution([FindPackageShare("arm"), "config/arm.yaml"]),
        ]),
    ])
"""


@pytest.mark.parametrize(
    ("expression", "text", "is_breaking"),
    [
        ("""PythonExpression(["'", robot, "_controller'"])""", "$(var robot)_controller", False),
        ("""PythonExpression(["'", robot, "_hand'"])""", "$(var robot)_hand", True),
        ("""PythonExpression(["'", robot, "' + '_controller'"])""", "$(eval '$(var robot)' + '_controller')", False),
    ],
)
def test_expression_of_a_text_in_quotes_is_the_text(review_changes, expression, text, is_breaking):
    _, found = review_changes("arm.launch.py", FILE, '"arm_controller"', expression)
    title = f"node 'controller_manager/spawner' of '{text}'"
    assert found == ([f"{title}: arguments [arm_controller] -> [{text}]"] if is_breaking else [])


@pytest.mark.parametrize("start", ['"config/"', '"config"'])
def test_joined_path_has_one_slash(review_changes, start):
    changes, _ = review_changes("arm.launch.py", FILE, '"config/arm.yaml"', f'{start}, [robot, ".yaml"]')
    file = "$(find-pkg-share arm)/config/$(var robot).yaml"
    assert any(file in change for change in changes), changes
    assert not any("//" in change for change in changes)


def test_later_absolute_path_replaces_those_before_it(review_changes):
    changes, _ = review_changes("arm.launch.py", FILE, '"config/arm.yaml"', '"/etc/arm.yaml"')
    assert changes == ["node 'arm/driver': parameters [$(find-pkg-share arm)/config/arm.yaml] -> [/etc/arm.yaml]"]


@pytest.mark.parametrize(
    ("expression", "is_same"),
    [
        ("$(eval ((1 if arg('a') else 2)))", True),
        ("$(eval 1 if  arg('a')\n else 2)", True),
        ("$(eval 1 if arg('a') else 3)", False),
        ("$(eval 1 if arg(' a') else 2)", False),
    ],
)
def test_layout_of_an_expression_is_no_change(review_changes, expression, is_same):
    old = "$(eval ( (1 if arg('a') else 2)))"
    arguments = f'<arg name="a" default="x"/><arg name="b" value="{old}"/>'
    text = f'<launch>{arguments}<param name="q" value="$(arg b)"/></launch>'
    changes, _ = review_changes("arm.launch", text, old, expression)
    assert (changes == []) == is_same


@pytest.mark.parametrize("performed", ["robot.perform(context)", "context.perform_substitution(robot)"])
def test_performed_substitution_is_the_substitution(review_changes, performed):
    changes, _ = review_changes("arm.launch.py", FILE, '"config/arm.yaml"', f'{performed}, "arm.yaml"')
    assert any("-> [$(find-pkg-share arm)/$(var robot)/arm.yaml]" in change for change in changes), changes
