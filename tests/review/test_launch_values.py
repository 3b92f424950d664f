"""Values of launch files that change what others find, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

FRAME = """<launch>
  <node pkg="arm" type="arm" name="arm"/>
  <param name="base_controller/{}" value="{}"/>
</launch>
"""


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("odometry_frame", "programs that use the name 'odom_combined' do not find it"),
        ("frame_id", "programs that use the name 'odom_combined' do not find it"),
        ("global_frame", None),
    ],
)
def test_a_frame_in_a_parameter_of_no_node(repository, compare, name, reason):
    repository.commit({"arm/launch/arm.launch": FRAME.format(name, "odom_combined")})
    repository.write({"arm/launch/arm.launch": FRAME.format(name, "odom")})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == reason


GAZEBO = """<launch>
  <arg name="world" default="empty.sdf"/>
  <include file="$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py"><arg name="gz_args" value="{}"/></include>
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ("-r $(var world)", "$(var world)", True),
        ("-s -r $(var world)", "-sr $(var world)", False),
        ("-r $(var world)", "$(var options) $(var world)", False),
        ("$(var world)", "-r $(var world)", False),
    ],
)
def test_a_simulation_that_starts_paused_is_breaking(repository, compare, old, new, is_breaking):
    repository.commit({"arm/launch/arm.launch.xml": GAZEBO.format(old)})
    repository.write({"arm/launch/arm.launch.xml": GAZEBO.format(new)})
    reasons = [str(change.reason) for change in subject(compare(repository), "arm/launch/arm.launch.xml").changes]
    assert ("the simulation starts paused" in reasons) is is_breaking


ARGUMENT = '<arg name="nav" default="false"/>'
NODE = '<node pkg="arm" type="arm" name="arm" if="$(arg nav)"/>'


@pytest.mark.parametrize(
    ("added", "is_found"),
    [
        (ARGUMENT, True),
        (ARGUMENT.replace("/>", ' if="true"/>'), False),
        (f"<group>{ARGUMENT}</group>", False),
        (f"<!-- {ARGUMENT} -->", False),
    ],
)
def test_an_argument_that_is_declared_twice(repository, compare, added, is_found):
    repository.commit({"arm/launch/arm.launch": f"<launch>{ARGUMENT}{NODE}</launch>\n"})
    repository.write({"arm/launch/arm.launch": f"<launch>{ARGUMENT}{added}{NODE}</launch>\n"})
    assert ("argument 'nav' is declared twice" in breaking(compare(repository))) is is_found


LOOP = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    ld = LaunchDescription()
    for number in range(2):
        ld.add_action(Node(package="arm", executable="arm", output="screen"))
    return ld
"""


def test_a_namespace_with_the_variable_of_a_loop_is_breaking(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": LOOP})
    repository.write({"arm/launch/arm.launch.py": LOOP.replace('"screen"', '"screen", namespace="arm" + str(number)')})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.py").changes
    assert change.reason is not None


ROS1_FILE = """<launch>
  <node pkg="arm" type="buttons.py" name="{name}" output="screen">
    <param name="is_slow" value="true"/>
    <param name="path" value="$(find arm)/etc/a.txt"/>
  </node>
</launch>
"""
ROS2_FILE = """from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    path = PathJoinSubstitution([FindPackageShare("arm"), "etc/a.txt"])
    return LaunchDescription([
        Node(package="arm", executable="buttons.py", output="screen", parameters=[{{"is_slow": {value}, "path": path}}])
    ])
"""
SCRIPT = """from rclpy.node import Node


class A(Node):
    def __init__(self):
        super().__init__("buttons")
"""


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("buttons", "True", []),
        ("keys", "True", ["node 'arm/buttons.py': name keys removed"]),
        ("buttons", "False", ["node 'arm/buttons.py': parameter is_slow true -> False"]),
    ],
)
def test_values_in_the_notation_of_ros2_and_the_name_that_the_script_gives_are_no_change(
    repository, compare, name, value, expected
):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    files = {"arm/package.xml": manifest, "arm/scripts/buttons.py": SCRIPT}
    repository.commit({**files, "arm/launch/arm.launch": ROS1_FILE.format(name=name)})
    repository.write({"arm/launch/arm.launch": None, "arm/launch/arm.launch.py": ROS2_FILE.format(value=value)})
    found = [line for found in compare(repository).subjects for line in sentences(found)]
    assert [line for line in found if line.startswith("node ")] == expected


NAMES_IN_EVALUATION = """<launch>
  <arg name="robot" default=""/>
  <arg name="name" value="$(arg robot)"/>
  <arg name="is_real" default="false"/>
  <arg if="$(eval {condition})" name="prefix" default=""/>
  <arg unless="$(eval {condition})" name="prefix" default="left_"/>
  <arg name="fixed_frame" default="{prefix}base_link"/>
  <node pkg="arm" type="view" name="view" args="-f $(arg fixed_frame)"/>
</launch>
"""


@pytest.mark.parametrize(
    ("condition", "is_breaking"),
    [
        ("name == ''", False),
        ("arg('name') == ''", False),
        ("name == '' and not is_real", False),
        ("name == 'arm'", True),
        ("is_real", True),
    ],
)
def test_names_in_an_evaluation_of_ros_1_have_the_values_of_the_arguments(repository, compare, condition, is_breaking):
    path = "arm/launch/view.launch"
    repository.commit({path: NAMES_IN_EVALUATION.format(condition=condition, prefix="")})
    repository.write({path: NAMES_IN_EVALUATION.format(condition=condition, prefix="$(arg prefix)")})
    (change,) = subject(compare(repository), path).changes
    assert (change.reason is not None) is is_breaking


SWITCHED = """<launch>
  <arg name="raw" default="{default}"/>
  <node pkg="arm" exec="camera" name="camera" {condition}/>
  {more}
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "more", "is_reversed"),
    [
        ('if="$(var raw)"', 'unless="$(var raw)"', "", True),
        ('unless="$(var raw)"', 'if="$(var raw)"', "", True),
        ('if="$(var raw)"', 'unless="$(var sim)"', "", False),
        ('if="$(var raw)"', 'unless="$(var raw)"', '<node pkg="arm" exec="camera" name="b" if="$(var raw)"/>', False),
    ],
)
def test_a_condition_that_tests_an_argument_the_other_way_round(repository, compare, old, new, more, is_reversed):
    path = "arm/launch/arm.launch.xml"
    default = "true" if "if" in old else "false"
    repository.commit({path: SWITCHED.format(default=default, condition=old, more=more)})
    default = "true" if "if" in new else "false"
    repository.write({path: SWITCHED.format(default=default, condition=new, more=more)})
    reasons = [str(change.reason) for change in subject(compare(repository), path).changes]
    assert ("the argument 'raw' has the opposite meaning now" in reasons) is is_reversed


@pytest.mark.parametrize(
    ("choices", "is_breaking"), [("['a', 'b']", True), ("['true', 'false']", False), ("['True', 'false']", False)]
)
def test_choices_that_an_argument_newly_has(repository, compare, choices, is_breaking):
    text = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('controller', default_value='a')])
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({path: text})
    repository.write({path: text.replace("='a'", f"='a', choices={choices}")})
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == (
        "callers that pass another value fail" if is_breaking else None
    )


@pytest.mark.parametrize(("model", "is_breaking"), [('<arg name="model" default="arm"/>', True), ("", False)])
def test_name_that_was_unknown_by_default_is_not_lost(repository, compare, model, is_breaking):
    text = '<launch>{}<arg name="robot_name" default="{}"/><node pkg="arm" exec="arm"/></launch>\n'
    path = "arm/launch/arm.launch.xml"
    repository.commit({path: text.format(model, "$(var model)")})
    repository.write({path: text.format(model, "hand")})
    reasons = [str(change.reason) for change in subject(compare(repository), path).changes if change.reason]
    assert ("programs that use the name 'arm' do not find it" in reasons) is is_breaking
    assert bool(reasons) is is_breaking


@pytest.mark.parametrize(("new", "is_breaking"), [("arm", False), ("hand", True)])
def test_argument_whose_default_is_that_of_its_own_value(repository, compare, new, is_breaking):
    text = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration("namespace", default="{}")
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value=namespace),
        Node(package="arm", executable="arm", namespace=namespace),
    ])
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({path: text.format("arm")})
    repository.write({path: text.format(new), "notes.md": "\n"})
    line = "argument 'namespace': default arm -> hand"
    assert breaking(compare(repository)) == ([line] if is_breaking else [])


def test_name_that_is_assigned_twice_has_its_first_value_in_the_second_one(review_changes):
    text = """from launch import LaunchDescription
from launch_ros.actions import Node


def start(context):
    rate = 600 if fast(context) else 150
    rate = 650 if test(context) else rate
    return [Node(package="arm", executable="driver", parameters=[{"rate": rate}])]
"""
    found, _ = review_changes("arm.launch.py", text, text, text.replace('parameters=[{"rate": rate}]', ""))
    (change,) = [sentence for sentence in found if sentence.startswith("node")]
    assert change == (
        "node 'arm/driver': parameter rate 650 if test(context) else 600 if fast(context) else 150 removed"
    )


def test_method_of_the_text_of_an_argument_is_an_expression_of_xml(review_changes):
    text = """from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def start(context):
    prefix = LaunchConfiguration("prefix").perform(context).strip("/")
    return [Node(package="arm", executable="driver", parameters=[{"prefix": prefix}])]
"""
    found, _ = review_changes("arm.launch.py", text, text, text.replace('.strip("/")', '.rstrip("/")'))
    assert found == [
        "node 'arm/driver': parameter prefix $(eval '$(var prefix)'.strip('/')) -> $(eval '$(var prefix)'.rstrip('/'))"
    ]


@pytest.mark.parametrize(
    ("imported", "reasons"),
    [("('left', 'right')", []), ("('left',)", ["callers that pass 'right' fail"]), ("find_sides()", [])],
)
def test_choices_that_another_module_lists(repository, compare, imported, reasons):
    text = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('side', default_value='left', choices=['left', 'right'])])
"""
    path, module = "arm/launch/arm.launch.py", "arm/arm/sides.py"
    repository.commit({path: text, "arm/arm/__init__.py": ""})
    new = "from arm.sides import SIDES\n" + text.replace("['left', 'right']", "list(SIDES)")
    repository.write({path: new, module: f"SIDES = {imported}\n"})
    changes = subject(compare(repository), path).changes
    assert [str(change.reason) for change in changes if change.reason is not None] == reasons
