"""Changes that a review lists once.

These are names that are edited alike, and the values of one inertial.
"""

from __future__ import annotations

import pytest

from linkwright.diagnostics import phrase
from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.reports.sentences import format_cases, format_change
from linkwright.review.texts.merging import merge_changes, name_edit
from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

ROBOT = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"
RANGE = """<xacro:macro name="range" params="side">
    <link name="${side}_range"/>
    <joint name="${side}_joint" type="fixed"><parent link="base_link"/><child link="${side}_range"/></joint>
    {sensor}
  </xacro:macro>
  <xacro:range side="fl"/>
  <xacro:range side="fr"/>
</robot>"""
SENSOR = """<gazebo reference="${side}_range">
      <sensor name="${side}_range" type="gpu_lidar"><topic>/range/${side}</topic></sensor>
    </gazebo>"""


def with_ranges(sensor: str) -> str:
    return ARM.replace("</robot>", RANGE.replace("{sensor}", sensor))


def test_links_and_joints_with_a_new_prefix_are_a_line_each(package, compare):
    text = MACRO.replace('link name="${name}"', 'link name="left_${name}"').replace(
        'child link="${name}"', 'child link="left_${name}"'
    )
    text = text.replace('joint name="${name}', 'joint name="left_${name}').replace(
        'parent link="${parent}"', "parent link=\"${'' if parent == 'base_link' else 'left_'}${parent}\""
    )
    package.write({SEGMENT: text, ROBOT: ARM.replace('parent link="lower"', 'parent link="left_lower"')})
    result = compare(package)
    lines = [format_change(change) for _, change in result.breaking_changes]
    assert [str(line) for line in lines] == [
        "link 'upper' renamed to 'left_upper'; also 'middle -> left_middle', 'lower -> left_lower'",
        (
            "joint 'upper_joint' renamed to 'left_upper_joint'; "
            "also 'middle_joint -> left_middle_joint', 'lower_joint -> left_lower_joint'"
        ),
    ]
    reason = result.breaking_changes[0][1].reason
    assert str(reason) == "programs that look up the frame 'upper' do not find it; likewise for the others"


def test_joints_of_an_uncalled_macro_with_new_names_are_one_line(package, compare):
    joint = '<joint name="${name}_%s" type="revolute"><parent link="%s"/><axis xyz="0 0 1"/></joint>'
    tool = MACRO.replace('"segment"', '"finger"').replace("</link>", f"</link>{joint % (1, 'a')}{joint % (2, 'b')}")
    path = "arm_description/urdf/tool.xacro"
    package.commit({path: tool})
    package.write({path: tool.replace("name}_1", "name}_a1").replace("name}_2", "name}_a2")})
    (found,) = subject(compare(package), path).changes
    assert str(format_change(found)) == (
        "macro 'finger': joint ${name}_a1 name: ${name}_1 -> ${name}_a1; also '${name}_2 -> ${name}_a2'"
    )
    assert str(found.reason).endswith("'${name}_1' do not find it; likewise for the others")


def test_values_of_an_inertial_are_one_line(package, compare):
    package.write({SEGMENT: MACRO.replace('mass value="2"', 'mass value="3"').replace('iyy="0.1"', 'iyy="0.2"')})
    (found,) = subject(compare(package), ROBOT).changes
    expected = "link 'upper': inertial: mass 2 -> 3 kg, iyy 0.1 -> 0.2 kg m2; also 'middle', 'lower'"
    assert str(format_change(found)) == expected


def test_same_change_in_files_of_other_argument_sets_is_one_line(repository, compare):
    part = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/><link name="tip"/>{}</robot>'
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="tip"/><origin xyz="{} 0 0"/></joint>'
    robot = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:arg name="size" default="s"/>
      <xacro:include filename="$(find a)/urdf/$(arg size).xacro"/></robot>"""
    launch = """<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">
      <param name="robot_description" value="$(command 'xacro $(find-pkg-share a)/urdf/r.urdf.xacro size:=SIZE')"/>
      </node></launch>"""
    files = {"a/package.xml": "<package format='3'><name>a</name><version>1.0.0</version></package>"}
    files |= {f"a/launch/{size}.launch.xml": launch.replace("SIZE", size) for size in "sml"}
    files |= {f"a/urdf/{size}.xacro": part.format(joint.format(1)) for size in "sml"}
    repository.commit({**files, "a/urdf/r.urdf.xacro": robot})
    repository.write({f"a/urdf/{size}.xacro": part.format(joint.format(2)) for size in "sm"})
    (found,) = subject(compare(repository), "a/urdf/r.urdf.xacro").changes
    assert found.cases == ("size:=m", "size:=s")
    assert len(found.other_locations) == 1


def test_limits_of_a_joint_are_one_line(package, compare):
    package.write({SEGMENT: MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-1" upper="1"')})
    (found,) = (change for change in subject(compare(package), ROBOT).changes if "limit" in str(change.sentence))
    expected = (
        "joint 'upper_joint': limit: lower -1.5 -> -1 rad, upper 1.5 -> 1 rad; also 'middle_joint', 'lower_joint'"
    )
    assert str(format_change(found)) == expected


def test_joint_without_limits_has_no_limits_of_zero(package, compare):
    text = MACRO.replace('type="revolute"', 'type="continuous"').replace('lower="-1.5" upper="1.5" ', "")
    package.write({SEGMENT: text})
    lines = [line for line in sentences(subject(compare(package), ROBOT)) if "limit" in line]
    assert lines == [
        "joint 'upper_joint': limit lower removed: -1.5 rad",
        "joint 'upper_joint': limit upper removed: 1.5 rad",
    ]


def test_added_sensors_have_their_topics(package, compare):
    package.commit({ROBOT: with_ranges("")})
    package.write({ROBOT: with_ranges(SENSOR)})
    expected = "extension 'gazebo fl_range' added: sensor 'fl_range' (type=gpu_lidar, topic /range/fl)"
    assert sentences(subject(compare(package), ROBOT)) == [expected]


def test_topics_that_lose_the_same_part_are_one_line(package, compare):
    package.commit({ROBOT: with_ranges(SENSOR)})
    package.write({ROBOT: with_ranges(SENSOR.replace("/range/", "/"))})
    result = compare(package)
    assert breaking(result) == ["extension 'gazebo fl_range': sensor fl_range topic /range/fl -> /fl"]
    assert result.breaking_changes[0][1].other_names == ("gazebo fr_range",)


def make_change(name: str, old: str, new: str) -> Change:
    sentence = phrase(
        "{subject} '{name}': {property} {old} -> {new}", subject="link", name=name, property="p", old=old, new=new
    )
    return Change(sentence, Effect.CHANGED)


@pytest.mark.parametrize(
    ("first", "second", "count"),
    [
        (("a/x.stl", "b/x.stl"), ("a/y.stl", "b/y.stl"), 1),
        (("a/x.stl", "b/x.stl"), ("c/y.stl", "b/y.stl"), 2),
        (("1.5", "2.5"), ("1.25", "2.25"), 2),
        (("1 0 0", "2 0 0"), ("1 0 0", "2 0 0"), 1),
        (("-", "red"), ("-", "blue"), 2),
    ],
)
def test_names_with_the_same_edit_are_one_line_and_numbers_are_not(first, second, count):
    assert len(merge_changes([make_change("one", *first), make_change("two", *second)])) == count


def test_edit_of_a_name_is_a_prefix_or_words():
    assert name_edit("link_0", "left_link_0") == name_edit("tool", "left_tool")
    assert name_edit("old_link_0", "new_link_0") == name_edit("old_tool", "new_tool")
    assert name_edit("link_0", "left_link_0") != name_edit("link_0", "link_0_left_")


def test_parameters_that_hardware_gains_are_one_line(repository, compare):
    hardware = '<ros2_control name="arm" type="system"><hardware><plugin>a/B</plugin>{}</hardware></ros2_control>'
    robot = '<robot name="r"><link name="base"/>{}</robot>'
    repository.commit({"a/urdf/r.urdf": robot.format(hardware.format(""))})
    added = '<param name="ip">1.2.3.4</param><param name="port">80</param>'
    repository.write({"a/urdf/r.urdf": robot.format(hardware.format(added))})
    (found,) = subject(compare(repository), "a/urdf/r.urdf").changes
    expected = "extension 'ros2_control arm': hardware param ip added: 1.2.3.4; also 'param port 80'"
    assert str(format_change(found)) == expected


ALL_ARGUMENT_SETS = ("sim:=true tool:=a", "sim:=true tool:=b", "sim:=false tool:=a", "")


@pytest.mark.parametrize(
    ("cases", "all_cases", "expected"),
    [
        (ALL_ARGUMENT_SETS[:2], ALL_ARGUMENT_SETS, "with sim:=true"),
        (
            ("", ALL_ARGUMENT_SETS[2]),
            (ALL_ARGUMENT_SETS[0], ALL_ARGUMENT_SETS[1], ALL_ARGUMENT_SETS[2], ""),
            "without sim:=true",
        ),
        (ALL_ARGUMENT_SETS[1:3], ALL_ARGUMENT_SETS, "with 2 of 4 argument sets"),
        (("",), ("", "sim:=true", "tool:=b"), "with the default arguments"),
        (("a:=1 b:=1 c:=1 d:=1 e:=1",), ("a:=1 b:=1 c:=1 d:=1 e:=1", ""), "with a:=1 b:=1 c:=1 d:=1 ..."),
    ],
)
def test_argument_that_causes_a_change_is_named(cases, all_cases, expected):
    subject_of_all = Subject(SubjectKind.DESCRIPTION, "r.urdf", "r.urdf", "r.urdf", cases=all_cases)
    assert str(format_cases(Change(phrase("robot"), cases=cases), subject_of_all)) == expected


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('name="tool" default', 'name="gripper" default', "argument 'tool' renamed to 'gripper'", True),
        (
            'name="tool" default="none"',
            'name="tool" default="probe"',
            "default of argument 'tool' none -> probe",
            False,
        ),
        (
            "<xacro:include",
            '<xacro:arg name="color"/>\n<xacro:include',
            "argument 'color' without a default added",
            True,
        ),
    ],
)
def test_arguments_of_a_robot_are_compared(package, compare, old, new, expected, is_breaking):
    text = ARM.replace(old, new)
    package.write({ROBOT: text.replace("$(arg tool)", "$(arg gripper)") if "gripper" in new else text})
    result = compare(package)
    assert (expected in breaking(result)) == is_breaking
    assert expected in sentences(subject(result, ROBOT))


def test_renamed_parameter_of_a_macro_is_one_line(package, compare):
    package.write({SEGMENT: MACRO.replace("length", "size"), ROBOT: ARM})
    assert breaking(compare(package)) == ["macro 'segment': parameter length renamed to size"]


def test_other_parameter_with_the_same_default_is_not_a_renamed_one(package, compare):
    text = MACRO.replace("name parent length:=0.5", "name parent length:=0.5 color:=''").replace(
        "</visual>", '<material name="${color}"/></visual>'
    )
    package.commit({SEGMENT: text})
    package.write(
        {SEGMENT: MACRO.replace("length:=0.5", "length:=0.5 topic:=''").replace("name}_joint", "name}${topic}_joint")}
    )
    assert "macro 'segment': parameter color removed" in breaking(compare(package))


@pytest.mark.parametrize(
    ("old", "new", "is_renamed"), [("tool_name", "tool_names", True), ("headless", "force_paths", False)]
)
def test_arguments_that_a_call_passes_on_are_renamed_if_their_names_are_alike(package, compare, old, new, is_renamed):
    argument = '<xacro:arg name="{0}" default="false"/><xacro:camera {0}="$(arg {0})"/></robot>'
    package.commit({ROBOT: ARM.replace("</robot>", argument.format(old))})
    package.write({ROBOT: ARM.replace("</robot>", argument.format(new))})
    found = sentences(subject(compare(package), ROBOT))
    assert (f"argument '{old}' renamed to '{new}'" in found) is is_renamed


CONTROL = """<ros2_control name="arm" type="system"><hardware><plugin>a/B</plugin></hardware>
<joint name="upper_joint">INTERFACES<state_interface name="position"/></joint></ros2_control>"""


def test_interfaces_that_a_joint_loses_are_one_line(package, compare):
    names = ("position", "velocity", "effort")
    interfaces = "".join(f'<command_interface name="pass_{name}"/>' for name in names)
    path = "arm_description/urdf/arm.urdf.xacro"
    package.commit({path: ARM.replace("</robot>", CONTROL.replace("INTERFACES", interfaces) + "</robot>")})
    package.commit({path: ARM.replace("</robot>", CONTROL.replace("INTERFACES", "") + "</robot>")})
    (change,) = [change for _, change in compare(package, "HEAD~1..HEAD").breaking_changes]
    assert str(change.sentence) == (
        "extension 'ros2_control arm': joint upper_joint command_interface pass_position, pass_velocity, pass_effort "
        "removed"
    )
    assert str(change.reason) == (
        "controllers that claim 'upper_joint/pass_position' do not start; likewise for the others"
    )


CONTROLLERS = """<robot name="arm">
  <link name="base_link"><visual><geometry><box size="1 1 1"/></geometry>
    <material name="orange"><color rgba="1 0.608 0 1"/></material></visual></link>
  <gazebo>
    <plugin name="sim::JointController" filename="a"><joint_name>hip</joint_name><p_gain>10</p_gain></plugin>
    <plugin name="sim::JointController" filename="a"><joint_name>knee</joint_name><p_gain>10</p_gain></plugin>
    <plugin name="sim::JointController" filename="a"><joint_name>toe</joint_name><p_gain>10</p_gain></plugin>
  </gazebo>
</robot>"""
PLAIN = "arm_description/urdf/legs.urdf"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("<p_gain>10<", "<p_gain>20<",
         "extension 'gazebo': plugin sim::JointController (hip) p_gain 10 -> 20; also 'knee', 'toe'"),
        ("toe</joint_name><p_gain>10<", "toe</joint_name><p_gain>20<",
         "extension 'gazebo': plugin sim::JointController (toe) p_gain 10 -> 20"),
    ],
)  # fmt: skip
def test_plugins_of_the_same_name_are_told_apart_by_their_joints(repository, compare, old, new, expected):
    repository.commit({PLAIN: CONTROLLERS})
    repository.write({PLAIN: CONTROLLERS.replace(old, new)})
    changes = subject(compare(repository), PLAIN).changes
    assert [str(format_change(change)) for change in changes] == [expected]


def test_plugin_inserted_before_others_of_its_name_does_not_shift_them(repository, compare):
    first = '    <plugin name="sim::JointController" filename="a"><joint_name>hip</joint_name>'
    other = first.replace("hip", "neck") + "<p_gain>1</p_gain></plugin>\n"
    repository.commit({PLAIN: CONTROLLERS})
    repository.write({PLAIN: CONTROLLERS.replace(first, other + first).replace("gain>10<", "gain>20<", 1)})
    lines = sentences(subject(compare(repository), PLAIN))
    assert [line.split(":", 1)[1].split("(")[1].split(")")[0] for line in lines] == ["neck", "hip"]


@pytest.mark.parametrize(("color", "is_change"), [("1 0.607843137 0 1", False), ("1 0.604 0 1", True)])
def test_colors_that_are_equal_in_8_bits_are_no_change(repository, compare, color, is_change):
    repository.commit({PLAIN: CONTROLLERS})
    repository.write({PLAIN: CONTROLLERS.replace("1 0.608 0 1", color)})
    assert bool(compare(repository).subjects) == is_change


ARRAYS = """<xacro:arg name="prefix" default=""/>
  <ros2_control name="arm" type="system">
    <hardware><plugin>drivers/Arm</plugin></hardware>
    <gpio name="$(arg prefix)io">INTERFACES</gpio>
  </ros2_control>
</robot>"""


def prefixed_launch(prefix: str) -> str:
    command = f"'xacro $(find-pkg-share arm_description)/urdf/arm.urdf.xacro prefix:={prefix}'"
    node = f"""<node pkg="robot_state_publisher" exec="robot_state_publisher">
      <param name="robot_description" value="$(command {command})"/></node>"""
    return f"<launch>{node}</launch>"


def test_change_with_other_values_of_a_prefix_is_one_line(package, compare):
    old = '<command_interface name="out"><param name="max">1</param></command_interface>'
    text = ARM.replace("</robot>", ARRAYS)
    files = {f"arm_description/launch/{name}.launch.xml": prefixed_launch(name) for name in ("left_", "right_")}
    package.commit({**files, ROBOT: text.replace("INTERFACES", old)})
    package.write({ROBOT: text.replace("INTERFACES", old.replace(">1<", ">2<"))})
    (change,) = subject(compare(package), ROBOT).changes
    assert str(change.sentence) == "extension 'ros2_control arm': gpio left_io command_interface out param max 1 -> 2"
    assert (change.cases, change.other_names) == ((), ())


def test_change_with_only_one_of_the_prefixes_names_it(package, compare):
    text = ARM.replace("</robot>", ARRAYS).replace("INTERFACES", '<command_interface name="out"/>')
    joint = """<xacro:if value="${'$(arg prefix)' == 'left_'}"><link name="$(arg prefix)tip"/>
    <joint name="$(arg prefix)tip_joint" type="fixed"><parent link="lower"/><child link="$(arg prefix)tip"/>
      <origin xyz="0 0 LENGTH"/></joint></xacro:if>
  <ros2_control"""
    text = text.replace("<ros2_control", joint, 1)
    files = {f"arm_description/launch/{name}.launch.xml": prefixed_launch(name) for name in ("left_", "right_")}
    package.commit({**files, ROBOT: text.replace("LENGTH", "1")})
    package.write({ROBOT: text.replace("LENGTH", "2")})
    (change,) = subject(compare(package), ROBOT).changes
    assert str(change.sentence) == "joint 'left_tip_joint': origin xyz 0 0 1 -> 0 0 2 m (moved by 1 m)"
    assert change.cases == ("prefix:=left_",)


def test_interface_with_a_size_and_the_names_of_its_items_are_one_line(package, compare):
    old = '<command_interface name="out" size="4"/>'
    new = "".join(f'<command_interface name="out_{number}"/>' for number in range(4))
    text = ARM.replace("</robot>", ARRAYS)
    package.commit({ROBOT: text.replace("INTERFACES", old)})
    package.write({ROBOT: text.replace("INTERFACES", new)})
    result = compare(package)
    assert sentences(subject(result, ROBOT)) == [
        "extension 'ros2_control arm': gpio io command_interface out size=4 -> out_0 to out_3"
    ]
    assert breaking(result) == []


def test_equal_plugins_that_differ_in_the_joint_are_one_line(package, compare):
    plugin = """<plugin filename="position.so" name="controller"><joint_name>{joint}</joint_name>
      <topic>{joint}</topic><p_gain>{gain}</p_gain></plugin>"""
    path = "arm_description/urdf/arm.urdf.xacro"
    package.commit({path: ARM.replace("</robot>", "<gazebo><a>1</a></gazebo></robot>")})
    plugins = "".join(plugin.format(joint=f"J{number}", gain=9 if number == 4 else 5) for number in range(1, 5))
    package.write({path: ARM.replace("</robot>", f"<gazebo><a>1</a>{plugins}</gazebo></robot>")})
    assert sentences(subject(compare(package), path)) == [
        f"extension 'gazebo': plugin controller ({joint}) added: filename=position.so, "
        f"joint_name {joint}, topic {joint}, p_gain {gain}"
        for joint, gain in (("J1", 5), ("J4", 9))
    ]
    assert list(subject(compare(package), path).changes[0].other_names) == ["J2", "J3"]


def test_parameters_of_one_interface_are_one_line(package, compare):
    control = """<ros2_control name="arm" type="system"><joint name="upper_joint"><command_interface name="position">
      <param name="min">{}</param><param name="max">{}</param></command_interface></joint></ros2_control></robot>"""
    path = "arm_description/urdf/arm.urdf.xacro"
    package.commit({path: ARM.replace("</robot>", control.format(-1, 1))})
    package.write({path: ARM.replace("</robot>", control.format(-2, 3))})
    (line,) = sentences(subject(compare(package), path))
    assert line == (
        "extension 'ros2_control arm': joint upper_joint command_interface position: "
        "param min -1 -> -2, param max 1 -> 3"
    )


def test_files_of_merged_changes_are_no_other_files(repository, compare):
    part = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="NAME"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="NAME_joint" type="fixed"><parent link="base"/><child link="NAME"/></joint>
</robot>
"""
    includes = "".join(f'<xacro:include filename="{name}.xacro"/>' for name in ("left", "right"))
    robot = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><link name="base"/>{includes}</robot>'
    parts = {f"arm/urdf/{name}.xacro": part.replace("NAME", name) for name in ("left", "right")}
    repository.commit({"arm/urdf/r.urdf.xacro": robot, **parts})
    repository.write({path: text.replace('mass value="1"', 'mass value="2"') for path, text in parts.items()})
    result = compare(repository)
    (found,) = subject(result, "arm/urdf/r.urdf.xacro").changes
    assert str(format_change(found)) == "link 'left': inertial mass 1 -> 2 kg; also 'right'"
    assert result.other_files == []
