"""The lines of a review about launch files that pass arguments which no longer exist."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

MANIFEST = "<package><name>lamp</name><version>1.0.0</version></package>\n"
ROS1 = '<launch><arg name="run" default="false"/><arg name="x" default="1"/><node pkg="a" type="b"/></launch>\n'
ROS2 = '<launch><arg name="run" default="false"/><arg name="x" default="1"/><node pkg="a" exec="b"/></launch>\n'
CALL1 = '<launch><include file="$(find lamp)/launch/{file}"><arg name="{name}" value="1"/></include></launch>\n'
CALL2 = CALL1.replace("find ", "find-pkg-share ")
PYTHON = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare
def generate_launch_description():
    path = PathJoinSubstitution([FindPackageShare("lamp"), "launch", "a.launch.xml"])
    include = IncludeLaunchDescription(AnyLaunchDescriptionSource(path), launch_arguments={"run": "1"}.items())
    return LaunchDescription([include])
"""


@pytest.mark.parametrize(
    ("included", "text", "caller", "call", "is_found"),
    [
        ("a.launch", ROS1, "b.launch", CALL1.format(file="a.launch", name="run"), True),
        ("a.launch", ROS1, "b.launch", CALL1.format(file="a.launch", name="x"), False),
        ("a.launch", ROS1, "b.launch", CALL1.format(file="other.launch", name="run"), False),
        ("a.launch.xml", ROS2, "b.launch.xml", CALL2.format(file="a.launch.xml", name="run"), True),
        ("a.launch.xml", ROS2, "b.launch.py", PYTHON, True),
        ("a.launch.xml", ROS2.replace("exec=", 'name="$(var run)" exec='), "b.launch.py", PYTHON, False),
    ],
)
def test_a_launch_file_that_passes_a_removed_argument_is_named(
    repository, compare, included, text, caller, call, is_found
):
    files = {"lamp/package.xml": MANIFEST, f"lamp/launch/{included}": text, f"lamp/launch/{caller}": call}
    repository.commit(files)
    repository.write({f"lamp/launch/{included}": text.replace('<arg name="run" default="false"/>', "")})
    found = [line for line in breaking(compare(repository)) if line.startswith("passes")]
    line = f"passes 'run' to 'lamp/launch/{included}', which no longer has the argument"
    assert found == ([line] if is_found else [])


WRAPPER = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import FindPackageShare
def generate_launch_description():
    run = LaunchConfiguration("run")
    return LaunchDescription([
        DeclareLaunchArgument("run", default_value="0"),
        IncludeLaunchDescription(
            AnyLaunchDescriptionSource([FindPackageShare("PACKAGE"), "/launch/inner.launch.xml"]),
            launch_arguments={"rate": "1"}.items(),
            condition=IfCondition(run),
        ),
    ])
"""
DECLARED = '        DeclareLaunchArgument("run", default_value="0"),\n'
INNER = '<launch><arg name="{}" default="1"/><node pkg="a" exec="b" name="$(var {})"/></launch>\n'


@pytest.mark.parametrize(
    ("package", "inner", "old", "is_found"),
    [
        ("lamp", "other", {}, True),
        ("lamp", "run", {}, False),  # the included file gets the value of the caller
        ("lamp", "run", {'"rate": "1"': '"run": "1"'}, True),
        ("elsewhere", "other", {}, True),
        ("elsewhere", "other", {'"rate": "1"': '"run": run'}, False),  # a file that may still use the value
        ("elsewhere", "other", {'"rate": "1"': '"run": "1"'}, True),
    ],
)
def test_a_removed_argument_of_a_file_that_includes_others(repository, compare, package, inner, old, is_found):
    """The value of a caller has an effect if an included file may use it."""
    wrapper = WRAPPER.replace("PACKAGE", package)
    for text, replacement in old.items():
        wrapper = wrapper.replace(text, replacement)
    new = wrapper.replace(DECLARED, "").replace("            condition=IfCondition(run),\n", "")
    new = new.replace('    run = LaunchConfiguration("run")\n', "").replace('"run": run', '"rate": "1"')
    files = {
        "lamp/package.xml": MANIFEST,
        "lamp/launch/a.launch.py": wrapper,
        "lamp/launch/inner.launch.xml": INNER.format(inner, inner),
        "lamp/launch/b.launch.py": PYTHON.replace("a.launch.xml", "a.launch.py"),
    }
    repository.commit(files)
    repository.write({"lamp/launch/a.launch.py": new})
    line = "passes 'run' to 'lamp/launch/a.launch.py', which no longer has the argument"
    assert (line in breaking(compare(repository))) is is_found


@pytest.mark.parametrize(
    ("call", "is_found"),
    [
        (CALL1.format(file="a.launch", name="speed"), True),
        (CALL1.format(file="a.launch", name="run"), False),
        (CALL1.format(file="other.launch", name="speed"), False),
        (CALL1.format(file="a.launch", name="run").replace("<include", '<include ns="left"'), False),
        (CALL2.format(file="a.launch", name="speed").replace("<launch>", '<launch><node pkg="a" exec="b"/>'), False),
    ],
)
def test_an_argument_that_an_included_file_of_ros_1_never_had_makes_the_include_fail(
    repository, compare, call, is_found
):
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/launch/a.launch": ROS1, "lamp/launch/b.launch": "<launch/>"})
    repository.write({"lamp/launch/b.launch": call})
    line = "passes 'speed' to 'lamp/launch/a.launch', which has no such argument"
    assert (line in breaking(compare(repository))) is is_found


def test_an_argument_that_an_included_file_never_had_is_told_once(repository, compare):
    call = CALL1.format(file="a.launch", name="speed")
    repository.commit({"lamp/package.xml": MANIFEST, "lamp/launch/a.launch": ROS1, "lamp/launch/b.launch": call})
    repository.write({"lamp/launch/b.launch": call.replace('value="1"', 'value="2"')})
    assert not [line for line in breaking(compare(repository)) if line.startswith("passes")]


CHOSEN = """<launch>
  <arg name="robot" default="arm"/>
  <include file="$(find lamp)/launch/$(arg robot)/{file}">{arguments}</include>
</launch>
"""
GRIP = '<launch><arg name="grip" default="left"/></launch>'


@pytest.mark.parametrize(
    ("file", "other", "is_found"),
    [
        ("$(arg robot).gazebo.launch", "<launch/>", True),
        ("start.launch", "<launch/>", True),
        ("start.launch", GRIP, False),
        ("$(arg robot)_$(arg side).launch", "<launch/>", False),
    ],
)
def test_argument_that_a_file_of_another_value_does_not_declare_makes_the_include_fail_with_that_value(
    repository, compare, file, other, is_found
):
    files = {"lamp/package.xml": MANIFEST, "lamp/launch/b.launch": CHOSEN.format(file=file, arguments="")}
    for robot, text in (("arm", GRIP), ("leg", other)):
        names = (f"{robot}.gazebo.launch", "start.launch", f"{robot}_left.launch")
        files |= {f"lamp/launch/{robot}/{name}": text for name in names}
    repository.commit(files)
    argument = '<arg name="grip" value="right"/>'
    repository.write({"lamp/launch/b.launch": CHOSEN.format(file=file, arguments=argument)})
    changes = [change for _, change in compare(repository).breaking_changes]
    lines = [(str(change.sentence), str(change.reason)) for change in changes]
    line = ("passes 'grip' to files that do not declare it", "the include fails with robot:=leg")
    assert (line in lines) is is_found


CHAIN = """<launch>
  <arg name="speed" default="2"/>
  <include file="$(find-pkg-share lamp)/launch/{file}">{argument}</include>
{rest}</launch>
"""
SPEED = '<arg name="speed" value="$(var speed)"/>'
PYTHON_NODE = """from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([Node(package="a", executable="b")])
"""


@pytest.mark.parametrize(
    ("included", "argument", "rest", "is_found"),
    [
        (ROS2, SPEED, "", True),
        (ROS2, SPEED, '  <node pkg="a" exec="c" name="$(var speed)"/>\n', True),
        (ROS2, SPEED.replace("$(var speed)", "3").replace("speed", "pace"), "", True),
        (ROS2, SPEED.replace("$(var speed)", "3"), '  <node pkg="a" exec="c" name="$(var speed)"/>\n', False),
        (ROS2.replace("exec=", 'name="$(var speed)" exec='), SPEED, "", False),
        (ROS2.replace("</launch>", '<include file="$(find-pkg-share x)/y.launch.xml"/></launch>'), SPEED, "", False),
        (ROS2.replace('<arg name="run" default="false"/>', '<arg name="speed"/>'), SPEED, "", False),
    ],
)
def test_an_argument_that_an_included_file_of_ros_2_does_not_use_is_told(
    repository, compare, included, argument, rest, is_found
):
    caller = CHAIN.format(file="a.launch.xml", argument="", rest=rest)
    files = {"lamp/package.xml": MANIFEST, "lamp/launch/a.launch.xml": included, "lamp/launch/b.launch.xml": caller}
    repository.commit(files)
    new = CHAIN.format(file="a.launch.xml", argument=argument, rest=rest)
    repository.write({"lamp/launch/b.launch.xml": new})
    result = compare(repository)
    name = "pace" if "pace" in argument else "speed"
    line = f"passes '{name}' to 'lamp/launch/a.launch.xml', which does not use this argument"
    assert (line in sentences(subject(result, "lamp/launch/b.launch.xml"))) is is_found
    assert line not in breaking(result)


@pytest.mark.parametrize(
    ("included", "is_found"),
    [
        (PYTHON_NODE, True),
        (PYTHON_NODE.replace('"b"', "LaunchConfiguration(f\"s{'peed'}\")"), False),
        (PYTHON_NODE.replace("from launch import", "from lamp.helpers import nodes\nfrom launch import"), False),
    ],
)
def test_arguments_that_python_may_compute_count_as_used(repository, compare, included, is_found):
    caller = CHAIN.format(file="a.launch.py", argument="", rest="")
    files = {"lamp/package.xml": MANIFEST, "lamp/launch/a.launch.py": included, "lamp/launch/b.launch.xml": caller}
    repository.commit(files)
    arguments = SPEED + '<arg name="pace" value="3"/>'
    repository.write({"lamp/launch/b.launch.xml": CHAIN.format(file="a.launch.py", argument=arguments, rest="")})
    line = "passes 'pace', 'speed' to 'lamp/launch/a.launch.py', which uses none of these arguments"
    found = [text for text in sentences(subject(compare(repository), "lamp/launch/b.launch.xml")) if line in text]
    assert bool(found) is is_found
