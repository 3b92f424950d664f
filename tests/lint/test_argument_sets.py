"""Checks of a description with the values from its callers; each finding is reported once."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.lint.registry import find_rule

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>A robot.</description>
<maintainer email="a@b.org">A</maintainer><license>MIT</license>{needs}</package>"""
ARM = f"""<robot {XACRO} name="$(arg name)">
  <xacro:arg name="name" default="arm"/>
  <xacro:arg name="type" default="none"/>
  <xacro:include filename="$(arg type).xacro"/>
</robot>
"""
CAN_VISUAL = '<visual><geometry><mesh filename="file://$(find arm)/urdf/can.stl"/></geometry></visual>'
PART = '<robot><link name="base_link"/></robot>\n'
LAUNCH = """
import xacro
from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription

def generate_launch_description():
    path = get_package_share_path('arm') / 'urdf' / 'arm.urdf.xacro'
    for kind in [{kinds}]:
        xacro.process_file(path, mappings={{'name': 'a', 'type': kind}})
    return LaunchDescription([])
"""


@pytest.fixture
def check(tmp_path, monkeypatch, capsys):
    """Write files, check the folder, and return the findings.

    Each has its code, severity, file, message and notes.
    """
    monkeypatch.chdir(tmp_path)

    def run(files, *words):
        for name, text in {"arm/package.xml": MANIFEST.format(name="arm", needs=""), **files}.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text)
        main(["check", *(words or ["."]), "--format", "json", "--ignore", "LW6", "--ignore", "LW8"])
        return json.loads(capsys.readouterr().out)["diagnostics"]

    return run


def finding_codes(findings):
    return [(finding["severity"], finding["code"]) for finding in findings]


def test_failure_without_arguments_is_one_info(check):
    findings = check(
        {
            "arm/urdf/arm.urdf.xacro": ARM,
            "arm/urdf/small.xacro": PART,
            "arm/urdf/big.xacro": PART,
            "arm/launch/view.launch.py": LAUNCH.format(kinds="'small', 'big'"),
        }
    )
    assert finding_codes(findings) == [("info", "LINT303")]
    assert findings[0]["message"] == "'arm.urdf.xacro' needs the arguments 'name' and 'type'"
    assert [note["message"] for note in findings[0]["notes"]] == [
        "for instance, a caller passes name:=a type:=small here",
        "the file is checked with 2 sets of values",
    ]
    assert findings[0]["notes"][0]["file"].endswith("view.launch.py")


def test_a_missing_package_makes_no_argument_a_needed_one(check):
    robot = ARM.replace("$(arg type).xacro", "$(find tool)/tool.xacro")
    launch = LAUNCH.format(kinds="'small'")
    findings = check({"arm/urdf/arm.urdf.xacro": robot, "arm/launch/view.launch.py": launch})
    (message,) = [finding["message"] for finding in findings if finding["code"] == "LINT303"]
    assert message == "'arm.urdf.xacro' needs the argument 'name'"


def test_defaults_that_fail_where_they_are_used_are_told_with_the_error(check):
    robot = f"""<robot {XACRO} name="r"><xacro:arg name="kind" default="old"/>
    <xacro:include filename="$(arg kind).xacro"/></robot>"""
    launch = LAUNCH.format(kinds="'small'").replace("'name': 'a', 'type'", "'kind'")
    files = {"arm/urdf/arm.urdf.xacro": robot, "arm/urdf/small.xacro": PART, "arm/launch/view.launch.py": launch}
    (finding,) = check(files)
    assert (finding["severity"], finding["code"]) == ("info", "LINT303")
    start = "'arm.urdf.xacro' cannot be expanded with the default of the argument 'kind': no such file: "
    assert finding["message"].startswith(start)
    assert finding["message"].endswith("old.xacro'")


PLAIN_ROBOT = f'<robot name="r"><link name="base_link">{CAN_VISUAL}</link></robot>'
EXPANDING_LAUNCH = """
import os
import xacro
from ament_index_python.packages import get_package_share_directory

def generate_launch_description():
    file = os.path.join(get_package_share_directory('arm'), 'urdf', 'arm.urdf')
    document = xacro.parse(open(file))
    xacro.process_doc(document)
"""


@pytest.mark.parametrize(
    ("launch", "expected"),
    [(EXPANDING_LAUNCH, []), (EXPANDING_LAUNCH.replace("xacro", "document"), [("error", "LW114")])],
)
def test_urdf_file_expanded_by_launch_file_may_contain_xacro(check, launch, expected):
    findings = check({"arm/urdf/arm.urdf": PLAIN_ROBOT, "arm/urdf/can.stl": "", "arm/launch/view.launch.py": launch})
    assert [code for code in finding_codes(findings) if code[1] == "LW114"] == expected


def test_failing_launch_value_is_an_error_with_argument_set(check):
    findings = check(
        {
            "arm/urdf/arm.urdf.xacro": ARM,
            "arm/urdf/small.xacro": PART,
            "arm/launch/view.launch.py": LAUNCH.format(kinds="'small', 'lost'"),
        }
    )
    assert finding_codes(findings) == [("info", "LINT303"), ("error", "XML101")]
    assert "this happens with type:=lost" in [note["message"] for note in findings[1]["notes"]]


def test_finding_of_some_argument_sets_names_them(check):
    flaw = '<link name="{name}"><collision><geometry><box size="0 1 1"/></geometry></collision></link>'
    part = f'<robot><link name="base_link"/>{flaw}</robot>'
    joint = '<joint name="j" type="fixed"><parent link="base_link"/><child link="{name}"/></joint>'
    common = f"<robot>{flaw.format(name='c')}{joint.format(name='c')}</robot>"
    arm = ARM.replace("</robot>", '<xacro:include filename="common.xacro"/></robot>')
    findings = check(
        {
            "arm/urdf/arm.urdf.xacro": arm,
            "arm/urdf/common.xacro": common,
            "arm/urdf/small.xacro": part.format(name="s").replace("</robot>", joint.format(name="s") + "</robot>"),
            "arm/urdf/big.xacro": PART,
            "arm/launch/view.launch.py": LAUNCH.format(kinds="'small', 'big'"),
        },
        ".",
        "--select",
        "LW401",
    )
    boxes = {finding["file"].rpartition("/")[2]: finding for finding in findings if finding["code"] == "LW401"}
    assert list(boxes) == ["common.xacro", "small.xacro"]
    assert not any("this happens" in note["message"] for note in boxes["common.xacro"]["notes"])
    assert "this happens with type:=small" in [note["message"] for note in boxes["small.xacro"]["notes"]]


def test_configured_arguments_override_launch_files(check):
    findings = check(
        {
            "arm/urdf/arm.urdf.xacro": ARM,
            "arm/urdf/small.xacro": PART,
            "arm/launch/view.launch.py": LAUNCH.format(kinds="'lost'"),
            "linkwright.toml": '[arguments]\n"arm/urdf/arm.urdf.xacro" = { name = "a", type = "small" }\n',
        }
    )
    assert findings == []


def test_undeclared_argument_is_info_for_folder_and_error_for_file(check):
    files = {"arm/urdf/arm.urdf.xacro": f'<robot {XACRO} name="r"><link name="$(arg prefix)base_link"/></robot>'}
    findings = check(files)
    assert finding_codes(findings) == [("info", "LINT303")]
    assert findings[0]["hints"] == ['give values in linkwright.toml: [arguments] "arm.urdf.xacro" = { prefix = "..." }']
    assert finding_codes(check(files, "arm/urdf/arm.urdf.xacro")) == [("error", "XAC211")]


def test_include_named_by_argument_used_too_early_is_not_an_error(check):
    text = f"""<robot {XACRO} name="$(arg model)"><xacro:arg name="model" default="r"/>
<xacro:include filename="$(arg model)/arm.xacro"/><xacro:include filename="{{}}.xacro"/></robot>"""
    findings = check({"arm/urdf/arm.urdf.xacro": text.format("hand"), "arm/urdf/hand.xacro": PART})
    assert finding_codes(findings) == [("info", "LINT303")]
    findings = check({"arm/urdf/arm.urdf.xacro": text.format("none")})
    assert finding_codes(findings) == [("info", "LINT303"), ("error", "XML101")]


def test_misspelled_argument_stays_an_error(check):
    robot = f"""<robot {XACRO} name="r"><xacro:arg name="prefix" default=""/>
    <link name="$(arg prefix)base_link"/><link name="$(arg prefx)tool"/></robot>"""
    assert ("error", "XAC211") in finding_codes(check({"arm/urdf/arm.urdf.xacro": robot}))


def test_caller_without_arguments_uses_defaults(check):
    test = """
import xacro
from ament_index_python.packages import get_package_share_path

def test_expands():
    xacro.process_file(get_package_share_path('arm') / 'urdf/arm.urdf.xacro')
"""
    findings = check({"arm/urdf/arm.urdf.xacro": ARM, "arm/test/test_arm.py": test})
    assert {code for severity, code in finding_codes(findings) if severity == "error"} == {"XAC211", "XML101"}


def test_runtime_values_are_named(check):
    launch = LAUNCH.format(kinds="'small'").replace("'type': kind", "'type': ask()")
    findings = check({"arm/urdf/arm.urdf.xacro": ARM, "arm/launch/view.launch.py": launch})
    assert finding_codes(findings) == [("info", "LINT303")]
    assert findings[0]["arguments"]["names"] == "'type'"


def test_command_line_arguments_replace_all_other_sets(check):
    files = {"arm/urdf/arm.urdf.xacro": ARM, "arm/urdf/small.xacro": PART}
    assert check(files, "arm/urdf/arm.urdf.xacro", "name:=a", "type:=small") == []
    assert ("error", "XML101") in finding_codes(check(files, "arm/urdf/arm.urdf.xacro", "name:=a", "type:=lost"))


DERIVED_ARGUMENT = (
    ", ' config:=', PathJoinSubstitution(['config', LaunchConfiguration('type'), LaunchConfiguration('dof')])"
)


@pytest.mark.parametrize("derived", ["", DERIVED_ARGUMENT], ids=["", "with a path made of both"])
def test_value_that_works_with_another_choice_is_not_an_error(check, derived):
    launch = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    DeclareLaunchArgument('type', default_value='six', choices=['six', 'seven'])
    DeclareLaunchArgument('dof', default_value='6', choices=['6', '7'])
    Command(['xacro ', PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro']), ' name:=a',
             ' type:=', LaunchConfiguration('type'), LaunchConfiguration('dof')])
"""
    files = {"arm/urdf/arm.urdf.xacro": ARM, "arm/launch/view.launch.py": launch}
    arm = ARM.replace("$(arg type).xacro", "$(arg type)_$(arg dof).xacro")
    files["arm/urdf/arm.urdf.xacro"] = arm.replace("</robot>", '<xacro:arg name="dof" default="0"/></robot>')
    files["arm/urdf/arm.urdf.xacro"] = arm
    files["arm/launch/view.launch.py"] = launch.replace(
        "LaunchConfiguration('type'), LaunchConfiguration('dof')",
        "LaunchConfiguration('type'), ' dof:=', LaunchConfiguration('dof')" + derived,
    )
    findings = check({**files, "arm/urdf/six_6.xacro": PART, "arm/urdf/seven_7.xacro": PART})
    assert finding_codes(findings) == [("info", "LINT303")]


@pytest.mark.parametrize(("chosen", "codes_found"), [("large", ["XML101"]), ("small", [])])
def test_failing_value_is_an_error_only_with_default_file(check, chosen, codes_found):
    launch = """
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

DeclareLaunchArgument('robot', default_value='large', choices=['large', 'small'])
DeclareLaunchArgument('type', default_value='six', choices=['six', 'seven'])
path = PathJoinSubstitution([FindPackageShare('arm'), 'urdf', [LaunchConfiguration('robot'), '.urdf.xacro']])
Command(['xacro ', path, ' name:=a', ' type:=', LaunchConfiguration('type')])
"""
    files_with_both_values = {
        f"arm/urdf/{name}.urdf.xacro": ARM.replace("$(arg type)", f"{name}_$(arg type)") for name in ("large", "small")
    }
    parts = ["large_six", "large_seven", "small_six", "small_seven"]
    parts.remove(f"{chosen}_seven")
    files = {
        **files_with_both_values,
        "arm/launch/view.launch.py": launch,
        **{f"arm/urdf/{name}.xacro": PART for name in parts},
    }
    assert [finding["code"] for finding in check(files) if finding["severity"] != "info"] == codes_found


@pytest.mark.parametrize(
    ("declared", "severity"),
    [("default_value='small', choices=['small', 'lost']", "warning"), ("default_value='lost'", "error")],
)
def test_failing_choice_of_launch_argument_is_a_warning(check, declared, severity):
    launch = f"""
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    DeclareLaunchArgument('type', {declared})
    Command(['xacro ', PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro']), ' name:=a',
             ' type:=', LaunchConfiguration('type')])
"""
    files = {"arm/urdf/arm.urdf.xacro": ARM, "arm/urdf/small.xacro": PART, "arm/launch/view.launch.py": launch}
    assert [code for code in finding_codes(check(files)) if code[1] == "XML101"] == [(severity, "XML101")]


@pytest.mark.parametrize(
    ("needs", "beside", "severity"),
    [
        ("<exec_depend>far</exec_depend>", "", "warning"),
        ("", "<depend>far</depend>", "warning"),
        ("", "", "error"),
    ],
)
def test_missing_package_is_a_warning_if_declared_nearby(check, needs, beside, severity):
    robot = (
        f"""<robot {XACRO} name="r"><xacro:include filename="$(find far)/far.xacro"/><link name="base_link"/></robot>"""
    )
    manifest, other = MANIFEST.format(name="arm", needs=needs), MANIFEST.format(name="bringup", needs=beside)
    findings = check({"arm/package.xml": manifest, "bringup/package.xml": other, "arm/urdf/arm.urdf.xacro": robot})
    assert (severity, "PKG101") in finding_codes(findings)


ROBOT_WITH_SIDES = f"""<robot {XACRO} name="r">
  <xacro:arg name="side" default=""/>
  <xacro:property name="which" value="$(arg side)"/>
  <xacro:if value="${{which == 'left'}}"><xacro:property name="mount" value="0.1"/></xacro:if>
  <xacro:if value="${{which in ['right']}}"><xacro:property name="mount" value="-0.1"/></xacro:if>
  <link name="base_link"/><link name="arm"/>
  <joint name="j" type="fixed"><parent link="base_link"/><child link="arm"/><origin xyz="0 ${{mount}} 0"/></joint>
</robot>"""


def test_compared_values_are_tried_for_missing_argument(check):
    findings = check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_SIDES}, ".", "--ignore", "LW102")
    assert finding_codes(findings) == [("info", "LINT303")]
    assert findings[0]["message"] == "'arm.urdf.xacro' needs the argument 'side'"
    assert findings[0]["notes"][0]["message"] == "for instance, side:=left expands the file"
    assert finding_codes(check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_SIDES}, "arm/urdf/arm.urdf.xacro")) == [
        ("error", "XAC201")
    ]


def test_error_that_no_compared_value_fixes_remains(check):
    findings = check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_SIDES.replace("0 ${mount} 0", "0 ${lost} 0")})
    assert finding_codes(findings) == [("error", "XAC201")]


ROBOT_WITH_FILE = f"""<robot {XACRO} name="r">
  <xacro:arg name="limits" default="{{default}}"/>
  <xacro:property name="found" value="${{{{xacro.load_yaml('$(arg limits)')}}}}"/>
  <link name="base_link"/><link name="${{{{found['name']}}}}"/>{{more}}
  <joint name="j" type="fixed"><parent link="base_link"/><child link="${{{{found['name']}}}}"/></joint>
</robot>"""


def test_failure_with_empty_default_requires_argument(check):
    findings = check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_FILE.format(default="", more="")})
    assert finding_codes(findings) == [("info", "LINT303")]
    assert findings[0]["arguments"]["names"] == "'limits'"
    findings = check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_FILE.format(default="", more='<link name="${lost}"/>')})
    assert finding_codes(findings) == [("info", "LINT303"), ("error", "XAC201")]
    assert ("error", "XAC506") in finding_codes(
        check({"arm/urdf/arm.urdf.xacro": ROBOT_WITH_FILE.format(default="a.yaml", more="")})
    )


def test_error_of_a_link_whose_name_has_the_argument_needs_no_value(check):
    robot = f"""<robot {XACRO} name="r">
  <xacro:arg name="prefix" default=""/>
  <link name="$(arg prefix)base_link"><inertial><mass value="{{}}"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"""
    findings = check({"arm/urdf/arm.urdf.xacro": robot.format("1 kg")})
    assert finding_codes(findings) == [("error", "URDF121")]
    findings = check({"arm/urdf/arm.urdf.xacro": robot.format("$(arg prefix)")})
    assert finding_codes(findings) == [("info", "LINT303")]


def test_missing_key_in_file_of_runtime_value_is_not_an_error(check):
    launch = LAUNCH.format(kinds="'a'").replace("'name': 'a', 'type': kind", "'limits': kind + ask()")
    files = {
        "arm/urdf/arm.urdf.xacro": ROBOT_WITH_FILE.format(default="$(find arm)/urdf/a.yaml", more=""),
        "arm/urdf/a.yaml": "other: 1\n",
        "arm/launch/view.launch.py": launch,
    }
    assert finding_codes(check(files)) == [("info", "LINT303")]
    assert ("error", "XAC205") in finding_codes(check({**files, "arm/launch/view.launch.py": ""}))


def test_copied_inertia_hides_too_large_inertia_of_other_set(check):
    mass = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    indexed_mass = mass.replace('ixx="1"', 'ixx="0.0010${index}"').replace('iyy="1" izz="1"', 'iyy="0.001" izz="0.001"')
    robot = f"""<robot {XACRO} name="r">
  <xacro:arg name="arm" default="false"/>
  <xacro:macro name="part" params="index"><joint name="j${{index}}" type="fixed"><parent link="base_link"/>
    <child link="l${{index}}"/></joint><link name="l${{index}}"><collision><geometry>
    <box size="0.1 0.1 0.1${{index}}"/></geometry></collision><xacro:if value="${{index &lt; 4}}">{mass}</xacro:if>
    <xacro:unless value="${{index &lt; 4}}">{indexed_mass}</xacro:unless></link></xacro:macro>
  <link name="base_link"/>
  <xacro:part index="1"/><xacro:part index="2"/><xacro:part index="3"/>
  <xacro:if value="$(arg arm)">{"".join(f'<xacro:part index="{index}"/>' for index in range(4, 9))}</xacro:if>
</robot>"""
    launch = LAUNCH.replace("'name': 'a', 'type': kind", "'arm': kind").format(kinds="'false', 'true'")
    files = {"arm/urdf/arm.urdf.xacro": robot, "arm/launch/view.launch.py": launch}
    assert [finding["code"] for finding in check(files) if finding["code"].startswith("LW3")] == ["LW315"]
    file_without_copy = {
        "arm/urdf/arm.urdf.xacro": robot.replace('default="false"', 'default="true"'),
        "arm/launch/view.launch.py": "",
    }
    assert [finding["code"] for finding in check(file_without_copy) if finding["code"].startswith("LW3")] == ["LW324"]


TURNED_LINK = """
  <link name="base_link"/><link name="hand"/>
  <xacro:macro name="turned" params="rate"><joint name="turn" type="revolute">
    <parent link="base_link"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="{velocity}"/>
  </joint></xacro:macro>
  <xacro:turned rate="$(arg kind)"/>
"""


def find_given_kinds(inside, *kinds):
    """Write a description with an argument, and a launch file that sets its value."""
    robot = f'<robot {XACRO} name="a"><xacro:arg name="kind" default="{kinds[0]}"/>{inside}</robot>'
    launch = LAUNCH.format(kinds=", ".join(map(repr, kinds))).replace("'name': 'a', 'type'", "'kind'")
    return {"arm/urdf/arm.urdf.xacro": robot, "arm/launch/view.launch.py": launch}


@pytest.mark.parametrize(
    ("velocity", "of_robot"),
    [("0", 1), ("${0 if float(rate) == 3 else 1}", 2)],
    ids=["the same robot", "robots with the same parts"],
)
def test_rules_run_once_for_sets_with_same_robot(check, monkeypatch, velocity, of_robot):
    ran = []
    for code in ("LW206", "LW701"):
        rule = find_rule(code)
        monkeypatch.setattr(
            type(rule),
            "check",
            lambda self, subject, original_check=rule.check: ran.append(self.code) or list(original_check(subject)),
        )
    files = find_given_kinds(TURNED_LINK.format(velocity=velocity), "1", "2", "3")
    findings = check(files, ".", "--select", "LW206,LW701")
    assert finding_codes(findings) == [("warning", "LW206")]
    notes = [note["message"] for note in findings[0]["notes"]]
    assert ("this happens with kind:=3" in notes) is (of_robot > 1)
    assert (ran.count("LW206"), ran.count("LW701")) == (of_robot, 1)


def test_property_named_by_argument_value_of_one_set_is_used(check):
    """The used properties depend on the values of arguments, even if the files are the same."""
    properties = "".join(f'<xacro:property name="{name}" value="1"/>' for name in ("size", "width", "other"))
    files = find_given_kinds(f'{properties}<link name="l${{$(arg kind)}}"/>', "size", "width")
    findings = check(files, ".", "--select", "LW701")
    assert [finding["message"] for finding in findings] == ["nothing uses the property 'other'"]
