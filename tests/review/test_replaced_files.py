"""Launch and parameter files that take the place of removed ones, with few equal lines."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

OLD_LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='arm', executable='driver', name='driver', parameters=[{'rate': 10}])])
"""
NEW_LAUNCH = """import launch
import launch_ros


def make_driver():
    driver = launch_ros.actions.Node(
        package='arm',
        executable='driver',
        name='left_driver',
    )
    return driver


def generate_launch_description():
    ld = launch.LaunchDescription()
    ld.add_action(make_driver())
    return ld
"""
VALUES = "".join(f"    value_{number}: text {number}\n" for number in range(8))
OLD_VALUES = f"driver:\n  ros__parameters:\n{VALUES}" + "".join(f"other{i}: {{a: {i}}}\n" for i in range(20))
NEW_VALUES = f"driver:\n  ros__parameters:\n{VALUES.replace('text 0', 'other')}"


def test_launch_file_that_starts_the_same_programs_is_renamed(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/node_driver.launch.py": OLD_LAUNCH})
    path = "arm/launch/driver.launch.py"
    repository.write({"arm/launch/node_driver.launch.py": None, path: NEW_LAUNCH})
    result = compare(repository)
    assert sentences(subject(result, path))[:2] == [
        "renamed from arm/launch/node_driver.launch.py",
        "node 'arm/driver': name driver -> left_driver",
    ]
    assert [found.path for found in result.subjects] == [path]


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("arm/launch/calibrate.launch.py", NEW_LAUNCH),
        ("arm/start/my_driver.launch.py", NEW_LAUNCH),
        ("arm/launch/my_driver.launch.py", NEW_LAUNCH.replace("'driver'", "'camera'")),
    ],
)
def test_launch_file_with_another_name_folder_or_program_is_another_file(repository, compare, path, code):
    old = "arm/launch/driver.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, old: OLD_LAUNCH})
    repository.write({old: None, path: code})
    assert {found.path for found in compare(repository).subjects} == {old, path}


def test_parameter_file_with_most_values_of_a_removed_one_is_renamed(repository, compare):
    path = "arm/config/driver.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/driver_b.yaml": OLD_VALUES})
    repository.write({"arm/launch/driver_b.yaml": None, path: NEW_VALUES})
    result = compare(repository)
    assert sentences(subject(result, path))[:2] == [
        "renamed from arm/launch/driver_b.yaml",
        "driver.ros__parameters.value_0 text 0 -> other",
    ]
    assert [found.path for found in result.subjects] == [path]


def test_parameter_file_with_few_of_the_values_is_another_file(repository, compare):
    old, path = "arm/config/driver_b.yaml", "arm/config/driver.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, old: OLD_VALUES})
    repository.write({old: None, path: NEW_VALUES.replace("text", "another")})
    assert {found.path for found in compare(repository).subjects} == {old, path}
