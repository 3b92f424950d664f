"""The argument sets with which a review compares a description."""

from __future__ import annotations

from tests.repositories import ARM, PACKAGE
from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/arm.urdf.xacro"
LAUNCH = """import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
from xacro import process_file


def description(tool):
    folder = get_package_share_directory("arm_description")
    return process_file(os.path.join(folder, "urdf", "arm.urdf.xacro"), mappings={"tool": tool}).toxml()


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="robot_state_publisher", executable="robot_state_publisher",
                 parameters=[{"robot_description": description("none")}]),
            Node(package="robot_state_publisher", executable="robot_state_publisher",
                 parameters=[{"robot_description": description("probe")}]),
        ]
    )
"""
WITHOUT_DEFAULT = ARM.replace('  <xacro:arg name="tool" default="none"/>\n', "")


def test_mappings_of_process_file_are_tried(package, compare):
    package.commit({"arm_description/launch/arm.launch.py": LAUNCH, PATH: WITHOUT_DEFAULT})
    package.write({PATH: WITHOUT_DEFAULT.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package), PATH)
    assert review_subject.cases == ["tool:=none", "tool:=probe"]
    assert sentences(review_subject) == ["joint 'probe_joint': origin xyz 0 0 0.2 -> 0 0 0.3 m (moved by 0.1 m)"]


def test_argument_without_value_in_a_condition_is_tried_as_false_and_true(package, compare):
    text = (
        WITHOUT_DEFAULT.replace("""'$(arg tool)' == 'probe'""", "$(arg has_probe)")
        .replace("${$", "$")
        .replace(')}">', ')">')
    )
    assert '<xacro:if value="$(arg has_probe)">' in text
    package.commit({PATH: text})
    package.write({PATH: text.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package), PATH)
    assert review_subject.cases == ["has_probe:=false", "has_probe:=true"]
    (change,) = review_subject.changes
    assert change.cases == ("has_probe:=true",)


def test_part_behind_a_switch_is_compared_with_its_opposite(package, compare):
    switch = '<xacro:arg name="sim" default="false"/><xacro:if value="$(arg sim)"><xacro:include filename="sim.xacro"/>'
    part = '<robot><gazebo><plugin name="drive"><topic>cmd_vel</topic></plugin></gazebo></robot>'
    package.commit(
        {PATH: ARM.replace("</robot>", f"{switch}</xacro:if></robot>"), "arm_description/urdf/sim.xacro": part}
    )
    package.write({"arm_description/urdf/sim.xacro": part.replace("cmd_vel", "drive/cmd_vel")})
    result = compare(package)
    ((changed_subject, change),) = result.breaking_changes
    assert str(change.sentence) == "extension 'gazebo': plugin drive topic cmd_vel -> drive/cmd_vel"
    assert (changed_subject.cases, change.cases) == (["", "sim:=true"], ("sim:=true",))


def test_attribute_that_a_call_newly_passes_is_one_change_for_all_values_of_an_argument(package, compare):
    include = '<xacro:include filename="$(find absent)/lidar.xacro"/><xacro:lidar parent="base_link" {}/></robot>'
    files = {PATH: ARM.replace("</robot>", include.format("")), "arm_description/launch/arm.launch.py": LAUNCH}
    package.commit(files)
    package.write({PATH: ARM.replace("</robot>", include.format('namespace="$(arg tool)"'))})
    review_subject = subject(compare(package), PATH)
    assert len(review_subject.cases) == 2
    (change,) = review_subject.changes
    assert "'lidar': @namespace added" in str(change.sentence)
    assert change.cases == ()


def test_started_robot_that_another_one_includes_is_compared(package, compare):
    launch = LAUNCH.replace(', mappings={"tool": tool}', "")
    world = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm_in_gazebo">
  <xacro:include filename="$(find arm_description)/urdf/arm.urdf.xacro"/>
  ${missing}
</robot>
"""
    package.commit({"arm_description/launch/arm.launch.py": launch, "arm_description/urdf/gazebo.urdf.xacro": world})
    package.write({PATH: ARM.replace('name="base_link"', 'name="base"').replace('"base_link"', '"base"')})
    assert "link 'base_link' renamed to 'base'" in sentences(subject(compare(package), PATH))


def test_paths_in_values_lead_to_the_files_of_each_version(package, compare):
    text = ARM.replace(
        "</robot>",
        '<xacro:arg name="settings" default=""/><gazebo><plugin name="p"><parameters>$(arg settings)</parameters>'
        "</plugin></gazebo></robot>",
    )
    launch = LAUNCH.replace(
        'mappings={"tool": tool}', 'mappings={"settings": os.path.join(folder, "config", "a.yaml")}'
    )
    files = {
        PATH: text,
        "arm_description/launch/arm.launch.py": launch,
        "arm_description/config/a.yaml": "a: 1",
    }
    package.commit(files)
    package.commit({PATH: text.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    (review_subject,) = compare(package, "HEAD~1..HEAD").subjects
    assert review_subject.cases == ["settings:=./arm_description/config/a.yaml"]
    assert sentences(review_subject) == ["joint probe_joint origin xyz: 0 0 0.2 -> 0 0 0.3"]


def test_call_that_neither_version_can_read_is_named_and_the_changes_with_the_others_are_those_of_all(package, compare):
    text = ARM.replace("</robot>", "<gazebo><topic>$(arg topic)</topic></gazebo></robot>")
    good = LAUNCH.replace('mappings={"tool": tool}', 'mappings={"topic": "a"}')
    bad = LAUNCH.replace('mappings={"tool": tool}', 'mappings={"tool": "probe"}')
    package.commit(
        {PATH: text, "arm_description/launch/arm.launch.py": good, "arm_description/launch/bad.launch.py": bad}
    )
    package.commit({PATH: text.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package, "HEAD~1..HEAD"), PATH)
    assert [change.cases for change in review_subject.changes] == [()]
    (problem,) = review_subject.problems
    assert str(problem.text).startswith(
        "called by 'arm_description/launch/bad.launch.py', neither version can be read: "
    )


def test_paths_in_reports_are_relative(package, compare):
    text = ARM.replace(
        "</robot>", "<gazebo><plugin name='p'><config>$(find arm_description)/a.yaml</config></plugin></gazebo></robot>"
    )
    package.commit({PATH: text})
    package.commit({PATH: text.replace("a.yaml", "b.yaml")})
    review_subject = subject(compare(package, "HEAD~1..HEAD"), PATH)
    assert sentences(review_subject) == [
        "extension 'gazebo': plugin p config arm_description/a.yaml -> arm_description/b.yaml"
    ]


def test_set_that_only_some_combinations_can_read_is_no_problem(package, compare):
    text = ARM.replace(
        "</robot>", '<xacro:include filename="$(find arm_description)/urdf/$(arg tool)_part.xacro"/></robot>'
    )
    part = "<robot/>"
    package.commit(
        {
            PATH: text,
            "arm_description/urdf/probe_part.xacro": part,
            "arm_description/launch/arm.launch.py": LAUNCH,
        }
    )
    package.write({PATH: text.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    result = compare(package)
    review_subject = subject(result, PATH)
    assert review_subject.cases == ["tool:=probe"]
    assert review_subject.problems == []
    assert breaking(result) == []


def test_robot_that_breaks_with_every_set_is_one_breaking_change(package, compare):
    package.commit({"arm_description/launch/arm.launch.py": LAUNCH})
    package.write({PATH: ARM.replace("</robot>", "<<<<<<< ours\n</robot>")})
    (sentence,) = breaking(compare(package))
    assert sentence.startswith(f"can no longer be read: {PATH}:")


ROOT_ROBOT = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:arg name="sizes" default="$(find arm_description)/config/sizes.yaml"/>
  <xacro:property name="sizes" value="${xacro.load_yaml('$(arg sizes)')}"/>
  <link name="base"><visual><geometry><sphere radius="${sizes['radius']}"/></geometry></visual></link>
</robot>
"""
ROOT_LAUNCH = """from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("arm_description")
    model = PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"])
    sizes = PathJoinSubstitution([share, "config", "sizes.yaml"])
    return LaunchDescription(
        [Node(package="robot_state_publisher", executable="robot_state_publisher",
              parameters=[{"robot_description": Command(["xacro ", model, " sizes:=", sizes])}])]
    )
"""


def test_package_at_the_root_is_that_of_each_version_and_not_that_of_the_working_tree(repository, compare, monkeypatch):
    sizes = "config/sizes.yaml"
    repository.commit(
        {
            "package.xml": PACKAGE["arm_description/package.xml"],
            "urdf/arm.urdf.xacro": ROOT_ROBOT,
            "launch/arm.launch.py": ROOT_LAUNCH,
            sizes: "radius: 1.0\n",
        }
    )
    repository.commit({sizes: "radius: 2.0\n"})
    repository.commit({sizes: "diameter: 4.0\n"})
    monkeypatch.chdir(repository.root)
    found = subject(compare(repository, "HEAD~2..HEAD~1"), "urdf/arm.urdf.xacro")
    assert sentences(found) == ["link 'base': visual geometry sphere radius 1 -> sphere radius 2 m"]


def test_only_the_callers_that_fail_are_named(package, compare):
    """One launch file passes the new argument; it is in a package that declares no dependency on the description."""
    plain = LAUNCH.replace(', mappings={"tool": tool}', "")
    manifest = "<package format='3'><name>arm_bringup</name><version>0.0.0</version></package>"
    package.commit({"arm_description/launch/plain.launch.py": plain, "arm_bringup/package.xml": manifest})
    package.write({PATH: WITHOUT_DEFAULT, "arm_bringup/launch/tools.launch.py": LAUNCH})
    changes = subject(compare(package), PATH).changes
    (change,) = [item for item in changes if str(item.sentence).startswith("can no longer be read: ")]
    assert str(change.reason) == "these files fail: 'arm_description/launch/plain.launch.py'"


def test_callers_that_pass_a_renamed_argument_are_compared_with_the_new_one(repository, compare):
    robot = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
      <xacro:arg name="{name}" default="1"/><link name="base"/><link name="tip"/>
      <joint name="j" type="fixed"><parent link="base"/><child link="tip"/><origin xyz="0 0 $(arg {name})"/></joint>
    </robot>
    """
    launch = (
        '<launch><let name="d" value="$(command \'xacro $(find-pkg-share arm)/arm.urdf.xacro {name}:=2\')"/></launch>'
    )
    texts = [
        {"arm/arm.urdf.xacro": robot.format(name=name), "arm/launch/arm.launch.xml": launch.format(name=name)}
        for name in ("height", "arm_height")
    ]
    repository.commit(
        {"arm/package.xml": PACKAGE["arm_description/package.xml"].replace("arm_description", "arm"), **texts[0]}
    )
    repository.write(texts[1])
    review_subject = subject(compare(repository), "arm/arm.urdf.xacro")
    assert review_subject.cases == ["arm_height:=2"]
    assert not any("origin" in sentence for sentence in sentences(review_subject))


def test_a_robot_whose_callers_newly_pass_a_file_that_does_not_exist_can_no_longer_be_read(repository, compare):
    launch, robot = "arm_description/launch/arm.launch.py", "arm_description/urdf/sized.urdf.xacro"
    text = """<robot name="sized" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:arg name="file" default="$(find arm_description)/config/sizes.yaml"/>
      <xacro:property name="sizes" value="${xacro.load_yaml('$(arg file)')}"/>
      <link name="base"><visual><geometry><sphere radius="${sizes['arm']['radius']}"/></geometry></visual></link>
    </robot>
    """
    call = """import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
from xacro import process_file

def generate_launch_description():
    folder = get_package_share_directory("arm_description")
    file = os.path.join(folder, "urdf", "sized.urdf.xacro")
    robot = process_file(file, mappings={"file": os.path.join(folder, "config", "NAME")}).toxml()
    parameters = [{"robot_description": robot}]
    node = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=parameters)
    return LaunchDescription([node])
"""
    path = "arm_description/config/sizes.yaml"
    repository.commit(
        {**PACKAGE, robot: text, launch: call.replace("NAME", "sizes.yaml"), path: "arm:\n  radius: 0.1\n"}
    )
    repository.write({launch: call.replace("NAME", "made/sizes.yaml"), path: "leg:\n  radius: 0.1\n"})
    found = subject(compare(repository), robot)
    (change,) = found.changes
    assert str(change.sentence).startswith("can no longer be read: ")
    assert str(change.sentence).endswith("no such file: 'arm_description/config/made/sizes.yaml'")
    assert str(change.reason) == f"these files fail: '{launch}'"
    assert found.problems == []
