"""Writing blocks to files: new and unchanged text, and refusals."""

from __future__ import annotations

import pytest

from linkwright.descriptions import load
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.solids import shape_properties
from linkwright.inertia.blocks import inertial_block
from linkwright.inertia.writing import write_inertials
from linkwright.urdf import Box, Pose

CUBE = shape_properties(Box((0.2, 0.2, 0.2)), 125.0)
BLOCK = """\
<inertial>
  <origin xyz="0 0 0" rpy="0 0 0"/>
  <mass value="1"/>
  <inertia ixx="0.00666667" ixy="0" ixz="0" iyy="0.00666667" iyz="0" izz="0.00666667"/>
</inertial>"""
XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.fixture
def write_inertia(tmp_path):
    """Write the inertia of the cube to links of a description.

    Return the result and the new text.
    """

    def run(text, *links, name="r.urdf"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        robot = load(path)
        result = write_inertials(robot, dict.fromkeys(links or ("a",), CUBE))
        reloaded = load(path)
        for link in result.links:
            assert reloaded.links[link].inertial is not None
            assert reloaded.links[link].inertial.mass == 1.0
            assert reloaded.links[link].inertial.ixx == pytest.approx(CUBE.inertia[0, 0], rel=1e-5)
        return result, path.read_bytes().decode("utf-8")

    return run


def test_inertial_block_is_formatted():
    assert inertial_block(CUBE) == BLOCK


def test_rounding_errors_are_written_as_zero():
    body = shape_properties(Box((0.1, 0.2, 0.3)), 1000.0).moved(Pose((1e-12, -1e-17, 0.5), (1e-13, 0, 0)))
    assert 'xyz="0 0 0.5"' in inertial_block(body)
    assert 'ixy="0" ixz="0"' in inertial_block(body)
    assert "-0" not in inertial_block(MassProperties(1.0))


def test_new_inertial_has_indentation_of_link(write_inertia):
    _, text = write_inertia(
        '<robot name="r">\n    <link name="a"> <!-- the body -->\n        <visual/>\n    </link>\n</robot>\n'
    )
    assert text == (
        '<robot name="r">\n    <link name="a"> <!-- the body -->\n'
        "        <inertial>\n"
        '            <origin xyz="0 0 0" rpy="0 0 0"/>\n'
        '            <mass value="1"/>\n'
        '            <inertia ixx="0.00666667" ixy="0" ixz="0" iyy="0.00666667" iyz="0" izz="0.00666667"/>\n'
        "        </inertial>\n"
        "        <visual/>\n    </link>\n</robot>\n"
    )


def test_single_line_link_is_expanded(write_inertia):
    _, text = write_inertia('<robot name="r">\n  <link name="a"><visual/></link>\n</robot>\n')
    assert '<link name="a">\n    <inertial>\n      <origin' in text
    assert "    </inertial>\n    <visual/></link>" in text


def test_windows_line_endings_and_byte_order_mark_are_kept(write_inertia):
    _, text = write_inertia(
        b'\xef\xbb\xbf<robot name="r">\r\n  <link name="a">\r\n    <visual/>\r\n  </link>\r\n</robot>\r\n'
    )
    assert text.startswith("\ufeff<robot")
    assert text.count("\n") == text.count("\r\n") == 10


def test_existing_inertial_keeps_format_and_comments(write_inertia):
    _, text = write_inertia(
        '<robot name="r">\n<link name="a">\n'
        "  <inertial> <!-- from CAD -->\n"
        "    <mass   value='3' /><!-- weighed -->\n"
        '    <inertia ixx="1" ixy="2"\n      ixz="3" iyy="4" iyz="5" izz="6"/>\n'
        '    <origin rpy="1 2 3" xyz="1 2 3"></origin>\n'
        "  </inertial>\n</link>\n</robot>\n"
    )
    assert text == (
        '<robot name="r">\n<link name="a">\n'
        "  <inertial> <!-- from CAD -->\n"
        "    <mass   value='1' /><!-- weighed -->\n"
        '    <inertia ixx="0.00666667" ixy="0"\n      ixz="0" iyy="0.00666667" iyz="0" izz="0.00666667"/>\n'
        '    <origin rpy="0 0 0" xyz="0 0 0"></origin>\n'
        "  </inertial>\n</link>\n</robot>\n"
    )


def test_missing_elements_of_inertial_are_added(write_inertia):
    _, text = write_inertia(
        '<robot name="r">\n<link name="a">\n  <inertial>\n    <mass value="3"/>\n    <inertia/>\n  </inertial>\n'
        "</link>\n</robot>\n"
    )
    assert '  <inertial>\n    <origin xyz="0 0 0" rpy="0 0 0"/>\n    <mass value="1"/>\n    <inertia ixx=' in text
    _, text = write_inertia('<robot name="r">\n<link name="a">\n  <inertial/>\n</link>\n</robot>\n')
    assert '  <inertial>\n    <origin xyz="0 0 0" rpy="0 0 0"/>\n' in text


def test_equal_numbers_keep_their_notation(write_inertia):
    _, text = write_inertia(
        '<robot name="r"><link name="a"><inertial><origin xyz="0.0 0.0 0.0"/><mass value="1.000e+00"/>'
        '<inertia ixx="6.666667e-3" ixy="-0.0" ixz="0" iyy="0.5" iyz="0" izz="1"/></inertial></link></robot>'
    )
    assert '<origin xyz="0.0 0.0 0.0"/><mass value="1.000e+00"/>' in text
    assert '<inertia ixx="6.666667e-3" ixy="-0.0" ixz="0" iyy="0.00666667" iyz="0" izz="0.00666667"/>' in text


def test_quaternion_of_inertial_origin_is_removed(write_inertia):
    _, text = write_inertia(
        '<robot name="r" version="1.1"><link name="a"><inertial><origin xyz="1 0 0" quat_xyzw="1 0 0 0"/>'
        '<mass value="3"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>'
    )
    assert '<origin xyz="0 0 0" />' in text


def test_several_links_of_one_file_are_written(write_inertia):
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    links = [f'<link name="{name}">\n  <visual/>\n</link>\n' for name in "ab"]
    text = f'<robot name="r">\n{joint.join(links)}</robot>'
    result, text = write_inertia(text, "b", "a")
    assert text.count("<inertial>") == 2
    assert sorted(result.links) == ["a", "b"]


def test_plain_link_of_xacro_file_is_written(write_inertia):
    result, text = write_inertia(
        f'{XACRO}\n  <xacro:arg name="p" default="/"/>\n  <link name="a">\n'
        '    <visual><geometry><box size="1 1 1"/></geometry></visual>\n  </link>\n</robot>',
        name="r.xacro",
    )
    assert result.links == ("a",)
    assert "<inertial>" in text


UNIT_INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
REFUSED = {
    "the macro 'part' generates it": """
      <xacro:macro name="part" params="n"><link name="${n}"/></xacro:macro>
      <xacro:part n="a"/>""",
    "its shapes are written with expressions, and numbers in the file would not follow them": """
      <xacro:property name="s" value="1"/>
      <link name="a"><visual><geometry><box size="${s} 1 1"/></geometry></visual></link>""",
    "its <inertial> is written with expressions": f"""
      <link name="a"><inertial><mass value="${{1 + 1}}"/>{UNIT_INERTIA}</inertial></link>""",
    "<xacro:heavy> generates a part of it": f"""
      <xacro:macro name="heavy"><inertial><mass value="1"/>{UNIT_INERTIA}</inertial></xacro:macro>
      <link name="a"><xacro:heavy/></link>""",
}


@pytest.mark.parametrize("reason", REFUSED, ids=["macro", "shape", "inertial", "part"])
def test_link_generated_by_xacro_is_refused(write_inertia, reason):
    before = f"{XACRO}{REFUSED[reason]}</robot>"
    result, text = write_inertia(before, name="r.xacro")
    assert result.refusals == {"a": reason}
    assert result.links == ()
    assert text == before


def test_included_file_is_written(write_inertia, tmp_path):
    part = tmp_path / "part.xacro"
    part.write_text(f'{XACRO}\n  <link name="a">\n    <visual/>\n  </link>\n</robot>\n')
    result, text = write_inertia(f'{XACRO}<xacro:include filename="part.xacro"/></robot>', name="r.xacro")
    assert result.files == (part,)
    assert "<inertial>" in part.read_text()
    assert "<inertial>" not in text


def test_element_that_expands_to_two_links_is_refused(write_inertia, tmp_path):
    part = tmp_path / "part.xacro"
    part.write_text(f'{XACRO}<link name="$(eval n)"/></robot>'.replace("$(eval n)", "${n}"))
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    include = '<xacro:property name="n" value="{}"/><xacro:include filename="part.xacro"/>'
    result, _ = write_inertia(f"{XACRO}{include.format('a')}{include.format('b')}{joint}</robot>", name="r.xacro")
    assert result.refusals == {"a": "its text in the file defines several links"}


def test_file_changed_since_reading_is_refused(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"><link name="a"/></robot>')
    robot = load(path)
    path.write_text('<robot name="other"><link name="a"/></robot>')
    assert write_inertials(robot, {"a": CUBE}).refusals == {"a": "its file has changed since it was read"}
    path.write_text('<robot name="s"><link name="a"/></robot>')  # the length of the file is unchanged
    assert write_inertials(robot, {"a": CUBE}).refusals == {"a": "its file has changed since it was read"}
    path.unlink()
    assert write_inertials(robot, {"a": CUBE}).refusals == {"a": "it is not written in a file"}


def test_description_without_file_is_refused():
    robot = load('<robot name="r"><link name="a"/></robot>')
    assert write_inertials(robot, {"a": CUBE}).refusals == {"a": "it is not written in a file"}


def test_file_that_is_not_utf_8_is_refused(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_bytes(
        '<?xml version="1.0" encoding="latin-1"?><robot name="é"><link name="a"/></robot>'.encode("latin-1")
    )
    assert write_inertials(load(path), {"a": CUBE}).refusals == {"a": "its file is not UTF-8"}


def test_unwritable_file_is_an_error(tmp_path, monkeypatch):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r">\n<link name="a">\n</link></robot>')
    robot = load(path)

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("linkwright.inertia.writing.write_whole_file", refuse)
    with pytest.raises(LinkwrightError) as caught:
        write_inertials(robot, {"a": CUBE})
    assert caught.value.diagnostics[0].code == "INR201"
