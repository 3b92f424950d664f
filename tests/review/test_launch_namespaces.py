"""Namespaces that groups of a launch file push, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, subject

XML = """<launch>
  <arg name="namespace"{default}/>
  <group ns="$(arg namespace)">
    <include file="$(find elsewhere)/launch/impedance.launch" ns="$(arg namespace)"/>
    <node pkg="arm" type="driver" name="driver" ns="$(arg namespace)"/>
  </group>
</launch>
"""
PYTHON = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value="/hero"),
        PushRosNamespace("outer"),
        PushRosNamespace(LaunchConfiguration("namespace")),
        Node(package="arm", executable="driver"),
    ])
"""


def test_namespace_that_begins_with_a_slash_by_default_replaces_the_outer_one(review_changes):
    text = XML.format(default=' default="/hero"')
    assert review_changes("arm.launch", text, '<group ns="$(arg namespace)">', "<group>") == ([], [])


def test_pushed_namespace_that_begins_with_a_slash_by_default_replaces_the_outer_one(review_changes):
    assert review_changes("arm.launch.py", PYTHON, '        PushRosNamespace("outer"),\n', "") == ([], [])


@pytest.mark.parametrize(("default", "is_breaking"), [(' default="hero"', True), ("", False)])
def test_lost_outer_namespace_is_breaking_if_the_inner_one_is_known(review_changes, default, is_breaking):
    changes, found = review_changes(
        "arm.launch", XML.format(default=default), '<group ns="$(arg namespace)">', "<group>"
    )
    assert len(changes) == 2
    assert (found == changes) is is_breaking


@pytest.mark.parametrize(
    ("package", "argument", "values", "count"),
    [
        ("eyes", "eye_namespace1", ("left", ""), 1),
        ("eyes", "ns", ("left", "right"), 1),
        ("eyes", "ns", ("left", "/left"), 0),
        ("eyes", "ns", ("$(env SIDE)", "$(env SIDE)_eye"), 0),
        ("eyes", "use_namespace", ("false", "true"), 0),
        ("eyes", "label", ("left", "right"), 0),
        ("arm_description", "eye_namespace1", ("left", ""), 0),
    ],
)
def test_new_namespace_of_a_file_of_another_repository_is_breaking(
    repository, compare, package, argument, values, count
):
    text = (
        f'<launch><include file="$(find-pkg-share {package})/launch/eyes.launch.xml">'
        f'<arg name="{argument}" value="VALUE"/></include></launch>\n'
    )
    path = "arm_description/launch/arm.launch.xml"
    repository.commit({"arm_description/package.xml": PACKAGE_XML, path: text.replace("VALUE", values[0])})
    repository.write({path: text.replace("VALUE", values[1])})
    assert len(breaking(compare(repository))) == count


INCLUDED = '<launch><node pkg="arm" exec="driver" name="driver"{}/></launch>\n'
INCLUDING = '<launch><group>{}<include file="$(find-pkg-share arm)/launch/driver.launch.xml"/></group></launch>\n'


@pytest.mark.parametrize(("namespace", "is_breaking"), [("left", False), ("right", True)])
def test_namespace_that_moves_to_the_including_file_keeps_the_names_of_the_nodes(
    repository, compare, namespace, is_breaking
):
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    included, including = "arm/launch/driver.launch.xml", "arm/launch/arm.launch.xml"
    repository.commit({**manifest, included: INCLUDED.format(' namespace="left"'), including: INCLUDING.format("")})
    push = f'<push_ros_namespace namespace="{namespace}"/>'
    repository.write({included: INCLUDED.format(""), including: INCLUDING.format(push)})
    (change,) = subject(compare(repository), including).changes
    assert (change.reason is not None) is is_breaking


PREFIXED = """<launch><arg name="side"/><group ns="$(arg side)">
  <param name="tf_prefix" value="$(arg side){end}"/>
  <node pkg="arm" type="driver" name="driver"/>
</group></launch>
"""
CALL = '<include file="$(find arm)/launch/driver.launch">{}</include>'


@pytest.mark.parametrize(("end", "is_breaking"), [("_tf", False), ("", True)])
def test_a_prefix_of_frames_that_moves_into_the_included_file_breaks_nobody(repository, compare, end, is_breaking):
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    included, including = "arm/launch/driver.launch", "arm/launch/arm.launch"
    group = f'<launch><group ns="left"><param name="tf_prefix" value="left_tf"/>{CALL.format("")}</group></launch>'
    repository.commit({**manifest, included: INCLUDED.replace("exec", "type").format(""), including: group})
    call = CALL.format('<arg name="side" value="left"/>')
    repository.write({included: PREFIXED.format(end=end), including: f"<launch>{call}</launch>"})
    changes = subject(compare(repository), including).changes
    assert any(change.reason is not None for change in changes) is is_breaking


OPTIONAL = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node
import os


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("ns", default_value=DEFAULT),
        Node(package="arm", executable="driver"),
    ])
"""


@pytest.mark.parametrize(
    ("default", "is_breaking"),
    [
        ('EnvironmentVariable("ARM", default_value="")', False),
        ('os.environ.get("ARM", "")', False),
        ('os.getenv("ARM", "hero")', True),
        ('EnvironmentVariable("ARM", default_value="hero")', True),
    ],
)
def test_new_namespace_is_breaking_if_the_default_of_the_environment_variable_is_not_empty(
    review_changes, default, is_breaking
):
    text = OPTIONAL.replace("DEFAULT", default)
    new = 'executable="driver", namespace=LaunchConfiguration("ns")'
    changes, found = review_changes("arm.launch.py", text, 'executable="driver"', new)
    assert (found == changes) is is_breaking
    assert len(changes) == 1


FORMATTED = """from launch import LaunchDescription
from launch_ros.actions import Node


def make(robots):
    kind = "arm"
    for robot in robots:
        if robot:
            kind = robot
    return LaunchDescription([Node(package="arm", executable="driver", name="arm_driver", remappings=[("a", "arm_a")])])
"""


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ('"arm_driver"', 'f"{kind}_driver"', False),
        ('"arm_driver"', '"{}_driver".format(kind)', False),
        ('"arm_driver"', 'f"{kind}_motor"', True),
        ('"arm_a"', '"%s_a" % kind', False),
    ],
)
def test_unknown_variable_in_a_formatted_name_may_have_the_old_value(review_changes, old, new, is_breaking):
    changes, found = review_changes("arm.launch.py", FORMATTED, old, new)
    assert "$(eval kind)" in changes[0]
    assert bool(found) is is_breaking
