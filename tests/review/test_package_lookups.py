"""Changes in a review of launch files that look up packages, and of templates of parameter files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/arm.launch.py"
LAUNCH = """from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    {}
    return LaunchDescription([
        DeclareLaunchArgument("dock", default_value="false"),
        {}
    ])
"""
INCLUDE = """IncludeLaunchDescription(
            PythonLaunchDescriptionSource([{}, '/dock.launch.py']), condition=IfCondition(LaunchConfiguration('dock'))
        )"""


@pytest.mark.parametrize(
    ("folder", "statement", "is_breaking"),
    [
        ("get_package_share_directory('docking')", "", True),
        ("folder", "folder = get_package_share_directory('docking')", True),
        ("folder", "folder = '' if __name__ else get_package_share_directory('docking')", False),
        ("FindPackageShare('docking')", "", False),
    ],
)
def test_a_package_that_is_looked_up_in_any_case_must_be_named(repository, compare, folder, statement, is_breaking):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: LAUNCH.format("", "")})
    repository.write({PATH: LAUNCH.format(statement, INCLUDE.format(folder))})
    result = compare(repository)
    reasons = [str(change.reason) for change in subject(result, PATH).changes if change.reason is not None]
    expected = ["package.xml does not name 'docking', without which the launch file fails"]
    assert reasons == (expected if is_breaking else [])


@pytest.mark.parametrize(
    ("statement", "files", "is_breaking"),
    [
        ("from arm_tools.launch import load\n", {}, True),
        ("import arm_tools\n", {}, True),
        ("try:\n    import arm_tools\nexcept ImportError:\n    arm_tools = None\n", {}, False),
        ("import arm_tools\n", {"arm/launch/arm_tools.py": ""}, False),
        ("import arm_tools\n", {"tools/package.xml": PACKAGE_XML.replace("arm_description", "arm_tools")}, False),
        ("import arm_tools\n", {"tool.repos": "repositories:\n  arm_tools: {type: git}\n"}, False),
        ("import launch_testing_ros\nimport typing_extensions\nimport yaml\n", {}, False),
    ],
)
def test_a_package_that_a_launch_file_imports_must_be_named(repository, compare, statement, files, is_breaking):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: LAUNCH.format("", ""), **files})
    repository.write({PATH: statement + LAUNCH.format("", "")})
    changes = [
        change for change in subject(compare(repository), PATH).changes if "imports added" in str(change.sentence)
    ]
    reasons = [str(change.reason) for change in changes if change.reason is not None]
    expected = ["package.xml does not name 'arm_tools', without which the launch file fails"]
    assert reasons == (expected if is_breaking else [])


def test_a_call_of_another_package_that_is_returned_is_an_action(review_changes):
    text = """from other_package import make_launch


def generate_launch_description():
    return make_launch(name="arm", rate=10)
"""
    found, found_breaking = review_changes("arm.launch.py", text, "rate=10", "rate=20")
    assert (found, found_breaking) == (["action 'make_launch': rate 10 -> 20"], [])


TEMPLATE = """${SIDE}_controller:
  ros__parameters:
    joints: ['${SIDE}_joint']
    constraints:
      ${SIDE}_joint: {goal: 0.02}
      time: 1.0
"""


@pytest.mark.parametrize(
    ("program", "is_renamed"), [("fill('ARM', 'left')\n", True), ("fill('SIDE', 'left')\n", False)]
)
def test_a_placeholder_with_another_name_changes_no_parameter(repository, compare, program, is_renamed):
    path = "arm/config/controllers.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: TEMPLATE, "arm/launch/fill.py": "fill('SIDE', 'left')\n"})
    repository.write({path: TEMPLATE.replace("SIDE", "ARM").replace("1.0", "2.0"), "arm/launch/fill.py": program})
    result = compare(repository)
    found = sentences(subject(result, path))
    renamed = ["placeholder 'SIDE' renamed to 'ARM'", "${ARM}_controller.ros__parameters.constraints.time 1.0 -> 2.0"]
    assert (found == renamed) is is_renamed
    assert bool(breaking(result)) is not is_renamed


def test_a_launch_file_that_only_the_new_version_can_read_is_shown(repository, compare):
    text = LAUNCH.format("", "")
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: text.replace("])", "]")})
    repository.write({PATH: text})
    (sentence,) = sentences(subject(compare(repository), PATH))
    assert sentence.startswith("can be read now; in the old version: line ")
    assert sentence.endswith("; contents: argument 'dock' (default false, unused)")


def test_a_package_that_an_added_include_lacks_is_told_once(repository, compare):
    old, new = (
        LAUNCH.format("", INCLUDE.format(f"get_package_share_directory('{name}')")) for name in ("rails", "docking")
    )
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: new.replace("/dock.launch", "/other.launch")})
    reasons = [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert len([reason for reason in reasons if "'docking'" in reason]) == 1


def test_a_package_for_which_another_file_of_the_package_looked_is_not_new(repository, compare):
    path, robot = "arm/urdf/arm.urdf.xacro", "<robot name='arm'><property name='a' value='$(find {})'/></robot>\n"
    for other, is_new in (
        ("<launch/>\n", True),
        ("<launch><arg name='a' default='$(find docking)'/></launch>\n", False),
    ):
        files = {"arm/package.xml": PACKAGE_XML, "arm/launch/other.launch": other}
        repository.commit({path: robot.format("rails"), **files})
        repository.write({path: robot.format("docking")})
        told = "looks for files of 'docking' instead of 'rails', but package.xml does not name 'docking'"
        assert (told in breaking(compare(repository))) is is_new
