"""Writing inferred elements.

The file describes the completed robot, and other text is unchanged.
"""

from __future__ import annotations

import pytest

from linkwright.descriptions import examine, load
from linkwright.inertia import MeshLibrary
from linkwright.inference import infer
from linkwright.inference.completion import complete_description
from linkwright.inference.writing import write_inference
from linkwright.packages import PackageFinder
from linkwright.urdf import read
from tests.inference.test_robots import CASES

XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.fixture
def write_inferred(tmp_path):
    """Infer and write, and return the result, the completed robot and the new text."""

    def run(text, name="r.urdf"):
        path = tmp_path / name
        path.write_bytes(text.encode())
        description = examine(path)
        inference = infer(description.robot, MeshLibrary(PackageFinder(start=tmp_path), tmp_path))
        result = write_inference(description.robot, inference)
        return result, read(complete_description(description.document, inference)).robot, path.read_bytes().decode()

    return run


@pytest.mark.parametrize("robot", [case[1] for case in CASES], ids=[case[0] for case in CASES])
def test_written_file_describes_completed_robot(write_inferred, tmp_path, robot):
    result, expected, text = write_inferred(robot)
    assert not result.refused
    reloaded = load(tmp_path / "r.urdf")
    assert dict(reloaded.links) == dict(expected.links)
    assert dict(reloaded.joints) == dict(expected.joints)
    assert [extension.tag for extension in reloaded.extensions] == [extension.tag for extension in expected.extensions]
    written_lines = iter(text.splitlines())
    for line in robot.splitlines():
        if "/>" not in line and "axis" not in line:
            assert line in written_lines, "the lines and their order are unchanged"


def test_new_elements_have_indentation_and_line_endings_of_file(write_inferred):
    _, _, text = write_inferred(
        '<robot name="r">\r\n   <link name="base_link">\r\n'
        '      <visual><geometry><sphere radius="0.1"/></geometry></visual>\r\n'
        "   </link>\r\n</robot>\r\n"
    )
    assert "\n" not in text.replace("\r\n", "")
    assert '      <collision>\r\n         <geometry>\r\n            <sphere radius="0.1"/>\r\n' in text
    assert text.endswith("      </collision>\r\n   </link>\r\n</robot>\r\n")


def test_empty_link_element_is_expanded(write_inferred):
    _, _, text = write_inferred('<robot name="r">\n  <link name="a" />\n</robot>\n')
    assert '  <link name="a">\n    <inertial>\n' in text
    assert "    </inertial>\n  </link>\n</robot>\n" in text


def test_link_of_macro_is_refused_and_other_links_are_written(write_inferred):
    visual = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    result, _, text = write_inferred(
        f'{XACRO}\n<xacro:macro name="part" params="name"><link name="${{name}}">{visual}</link></xacro:macro>\n'
        f'<xacro:part name="b"/>\n<link name="a">{visual}</link>\n'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n</robot>\n',
        "r.urdf.xacro",
    )
    assert result.count == 2
    assert text.count("<collision>") == 1
    assert [diagnostic.code for diagnostic in result.refused] == ["DRIVE301", "DRIVE301"]
    assert "the macro 'part' generates it" in result.refused[0].message
    assert result.refused[0].span is not None


def test_drive_with_joint_names_from_expressions_is_refused(write_inferred):
    wheel = (
        '<link name="{side}"><collision><origin rpy="1.5708 0 0"/>'
        '<geometry><cylinder radius="0.1" length="0.05"/></geometry></collision></link>'
        '<joint name="${{prefix}}_{side}" type="continuous"><origin xyz="0 {y} 0"/>'
        '<parent link="base_link"/><child link="{side}"/><axis xyz="0 1 0"/></joint>\n'
    )
    result, _, text = write_inferred(
        f'{XACRO}\n<xacro:property name="prefix" value="p"/>\n<link name="base_link"/>\n'
        + wheel.format(side="l", y="0.2")
        + wheel.format(side="r", y="-0.2")
        + "</robot>\n",
        "r.urdf.xacro",
    )
    assert "<gazebo>" not in text
    assert any(
        "the referenced name 'p_l' comes from an expression" in diagnostic.message for diagnostic in result.refused
    )
    assert text.count("<inertial>") == 3


def test_file_changed_since_reading_is_refused(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"><link name="a"/></robot>')
    description = examine(path)
    inference = infer(description.robot, MeshLibrary(PackageFinder(start=tmp_path), tmp_path))
    path.write_text('<robot name="r"><link name="abc"/></robot>')
    result = write_inference(description.robot, inference)
    assert "has changed since it was read" in result.refused[0].message
    assert path.read_text() == '<robot name="r"><link name="abc"/></robot>'
