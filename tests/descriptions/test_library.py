"""Loading by path and text, and shared results."""

from __future__ import annotations

import pytest

from linkwright.descriptions import Description, DescriptionLibrary, examine, load
from linkwright.diagnostics import LinkwrightError
from linkwright.urdf import read
from linkwright.xmltree import parse
from tests.places import PACKAGE
from tests.urdf.robots import chain_of_links, robot_text

XACRO_PREFIX = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
VALID_ROBOT = robot_text(chain_of_links("fixed"))
XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="link" default="a"/>'
    '<link name="$(arg link)"/></robot>'
)


class TestLoad:
    def test_load_accepts_text(self):
        assert load(VALID_ROBOT).root == "a"

    def test_load_accepts_path(self):
        assert load(PACKAGE / "urdf" / "mbot_base.urdf").name == "mbot"
        assert load(str(PACKAGE / "urdf" / "mbot_base.urdf")).name == "mbot"

    def test_load_expands_xacro_file(self):
        assert load(PACKAGE / "urdf" / "mbot_base.xacro").name == "mbot"

    def test_load_expands_xacro_text_with_arguments(self):
        assert load(XACRO).root == "a"
        assert load(XACRO, arguments={"link": "b"}).root == "b"

    def test_error_contains_all_findings(self):
        with pytest.raises(LinkwrightError) as caught:
            load(robot_text(chain_of_links("revolut", "hinge")))
        assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["URDF140", "URDF140"]

    def test_robot_accepted_by_urdfdom_is_loaded(self):
        text = robot_text('<link name="a"><visual/></link>')
        assert load(text).links["a"].visuals == ()
        assert [diagnostic.code for diagnostic in examine(text).diagnostics] == ["URDF130"]

    def test_missing_file_is_an_error(self, tmp_path):
        with pytest.raises(LinkwrightError, match="no such file"):
            load(tmp_path / "missing.urdf")

    def test_malformed_xml_is_an_error(self):
        with pytest.raises(LinkwrightError):
            load("<robot>")


class TestTinyxmlTolerance:
    """Differences between tinyxml2 and the XML standard."""

    def test_whitespace_before_xml_declaration_is_accepted(self):
        assert load('\n  <?xml version="1.0"?>\n' + VALID_ROBOT).name == "r"

    def test_locations_account_for_leading_whitespace(self):
        diagnostic = examine('\n<?xml version="1.0"?>\n<robot name="r"/>').diagnostics[0]
        assert (diagnostic.span.line, diagnostic.span.column) == (3, 1)

    @pytest.mark.parametrize("trailing_text", ["<robot/>", "\n<more>\n</more>", "\nwords"])
    def test_text_after_root_is_ignored(self, trailing_text):
        assert load(VALID_ROBOT + trailing_text).name == "r"

    def test_text_after_root_must_be_well_formed(self):
        with pytest.raises(LinkwrightError):
            load(VALID_ROBOT + "<broken")

    @pytest.mark.parametrize("blank", ["\t", "\n", "\r\n"])
    def test_tabs_and_newlines_in_values_are_not_spaces(self, blank):
        text = robot_text(chain_of_links(f'fixed:<origin xyz="0{blank}0 0"/>'))
        assert examine(text).robot is None

    def test_leading_whitespace_in_numbers_is_accepted(self):
        assert load(robot_text(chain_of_links('fixed:<origin xyz="\n1 \t2 3"/>'))).joints["j0"].origin.xyz == (1, 2, 3)

    def test_multi_line_tag_is_accepted(self):
        assert load(robot_text(chain_of_links('fixed:<origin\n\txyz="0 0 0"\n\trpy="0 0 0"\n/>'))).root == "a"

    def test_tabs_and_newlines_are_spaces_in_xacro(self):
        text = XACRO.replace("<link", '<material name="m"><color rgba="0\n0\t0 1"/></material><link')
        assert load(text).materials["m"].rgba == (0, 0, 0, 1)


def test_finding_in_macro_notes_macro_calls():
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:macro name="ball" params="size">\n'
        '    <link name="a"><visual><geometry><sphere radius="${size}"/></geometry></visual></link>\n'
        "  </xacro:macro>\n"
        '  <xacro:ball size="big"/>\n'
        "</robot>"
    )
    diagnostic = examine(text).diagnostics[0]
    assert diagnostic.message == "'radius' in <sphere> of link 'a' is not a number: 'big'"
    assert (diagnostic.span.line, diagnostic.span.column) == (3, 54)
    assert [(note.span.line, note.span.column) for note in diagnostic.notes if note.span] == [(5, 3)]


class TestLibrary:
    def test_library_reads_same_text_once(self):
        library = DescriptionLibrary()
        assert library.read(VALID_ROBOT) is library.read(VALID_ROBOT)

    def test_stored_document_provides_locations(self):
        library = DescriptionLibrary()
        document = parse("\n\n" + VALID_ROBOT.replace("fixed", "fixt"), "robot.xacro")
        library.store(Description("robot.xacro", document, read(document)), VALID_ROBOT)
        diagnostic = library.read(VALID_ROBOT).diagnostics[0]
        assert (diagnostic.span.file, diagnostic.span.line) == ("robot.xacro", 3)

    def test_stored_description_knows_its_files(self, tmp_path):
        library = DescriptionLibrary()
        assert library.files(VALID_ROBOT) == ()
        (tmp_path / "wheel.xacro").write_text('<robot><link name="a"/></robot>')
        (tmp_path / "robot.xacro").write_text(
            f'<robot name="r" {XACRO_PREFIX}><xacro:include filename="wheel.xacro"/></robot>'
        )
        text = library.store(examine(tmp_path / "robot.xacro"))
        assert library.files(text) == (tmp_path / "robot.xacro", tmp_path / "wheel.xacro")

    def test_malformed_text_gives_reading_without_robot(self):
        reading = DescriptionLibrary().read("not XML at all")
        assert reading.robot is None
        assert reading.diagnostics[0].code.startswith("XML")

    def test_library_keeps_limited_number_of_texts(self):
        library = DescriptionLibrary()
        first = library.read(VALID_ROBOT)
        for number in range(40):
            library.read(VALID_ROBOT.replace('name="r"', f'name="r{number}"'))
        assert library.read(VALID_ROBOT) is not first
