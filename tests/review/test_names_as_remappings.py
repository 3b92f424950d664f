"""Reviews of launch files whose remappings are names instead of pairs, so that they fail."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node

PAIR = ("out", "drive")


def generate_launch_description():
    return LaunchDescription([Node(package="mux", executable="mux", remappings=REMAPPINGS)])
"""
PATH = "arm/launch/arm.launch.py"
NAMES, PAIRS, CONSTANTS = '["out", "drive"]', '[("out", "drive")]', "[PAIR]"


@pytest.mark.parametrize(
    ("old", "new", "reasons"),
    [
        ("[]", NAMES, ["the launch file fails"]),
        ("[]", '("out", "drive")', ["the launch file fails"]),
        ("[]", PAIRS, ["programs that use the name 'out' do not find it"]),
        ("[]", CONSTANTS, ["programs that use the name 'out' do not find it"]),
        (NAMES, PAIRS, []),
        (NAMES, '["out", "speed"]', []),
        (PAIRS, NAMES, ["programs that use the name 'drive' do not find it", "the launch file fails"]),
    ],
)
def test_names_instead_of_pairs_make_the_launch_file_fail(repository, compare, old, new, reasons):
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": package, PATH: LAUNCH.replace("REMAPPINGS", old)})
    repository.write({PATH: LAUNCH.replace("REMAPPINGS", new)})
    found = [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert sorted(found) == reasons


def test_a_name_of_several_parts_is_compared_as_one_name(review_changes):
    text = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def topic(namespace, name):
    return [namespace, name]


def generate_launch_description():
    namespace = LaunchConfiguration("namespace")
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value="/arm"),
        Node(package="camera", executable="camera", remappings=[("image", topic(namespace, "/camera/image"))]),
    ])
"""
    changes, found_breaking = review_changes("arm.launch.py", text, "/camera/image", "/camera/front/image")
    assert found_breaking == changes
    assert [change.endswith("$(var namespace)/camera/front/image") for change in changes] == [True]
