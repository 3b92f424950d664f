"""Fixes.

The tests cover the changed and unchanged parts, and files that are written completely or not at all.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.lint import Edit, Finding, Fix, Settings, examine
from linkwright.lint.apply import fix_file, write_text
from linkwright.lint.fix import (
    add_attribute,
    find_element_range,
    is_literal,
    remove_element,
    rename_attribute,
    rename_element,
    replace_value,
)
from linkwright.xmltree import Element, Overlay, parse

ROBOT = """<?xml version="1.0"?>
<!-- kept -->
<robot name="r">
  <link name="a"/>  <!-- kept too -->
  <link name='b'/>
  <joint name="j"   type="continuous">
    <parent link="a"/>
    <child link="b"/>
    <axis   xyz="1 1 0"
    />
  </joint>
</robot>
"""


def parse_element(text: str, *path: str) -> Element:
    root = parse(text, "robot.urdf").root
    for tag in path:
        child = root.first(tag)
        assert child is not None
        root = child
    return root


def apply_fix(text: str, fix: Fix | None) -> str:
    assert fix is not None
    for edit in sorted(fix.edits, key=lambda edit: -edit.start):
        text = text[: edit.start] + edit.replacement + text[edit.end :]
    return text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<r><a x='1'/></r>", "<a x='1'/>"),
        ("<r><a><a/><b>t</b></a ><c/></r>", "<a><a/><b>t</b></a >"),
        ("<r><a><!-- </a> --><![CDATA[</a>]]><?p </a>?></a></r>", "<a><!-- </a> --><![CDATA[</a>]]><?p </a>?></a>"),
        ("<r><a x='/>'  y=\"/a>\" ></a></r>", "<a x='/>'  y=\"/a>\" ></a>"),
    ],
)
def test_element_range_covers_whole_element(text, expected):
    span = find_element_range(parse_element(text, "a"))
    assert span is not None
    assert text[slice(*span)] == expected


def test_attribute_value_is_replaced_between_quotes():
    text = "<r><a  x = '1'  y=\"2\"/></r>"
    assert (
        apply_fix(text, replace_value(parse_element(text, "a"), "x", '"<&'))
        == "<r><a  x = '&quot;&lt;&amp;'  y=\"2\"/></r>"
    )


def test_attributes_are_added_and_renamed():
    text = '<r><a x="1"\n  y="2" /></r>'
    assert apply_fix(text, add_attribute(parse_element(text, "a"), "z", "3")) == '<r><a x="1"\n  y="2" z="3" /></r>'
    assert apply_fix(text, rename_attribute(parse_element(text, "a"), "y", "z")) == '<r><a x="1"\n  z="2" /></r>'
    assert rename_attribute(parse_element(text, "a"), "y", "x") is None
    assert add_attribute(parse_element("<r><a></a></r>", "a"), "z", "3") is not None


def test_elements_are_renamed_in_start_and_end_tag():
    text = "<r><a><a/></a\n></r>"
    assert apply_fix(text, rename_element(parse_element(text, "a"), "bc")) == "<r><bc><a/></bc\n></r>"
    assert apply_fix("<r><a/></r>", rename_element(parse_element("<r><a/></r>", "a"), "bc")) == "<r><bc/></r>"


def test_element_alone_on_line_is_removed_with_line():
    text = "<r>\n  <a>\n  </a>\n  <b/>\n</r>"
    assert apply_fix(text, remove_element(parse_element(text, "a"))) == "<r>\n  <b/>\n</r>"
    assert apply_fix("<r><a/><b/></r>", remove_element(parse_element("<r><a/><b/></r>", "a"))) == "<r><b/></r>"


def test_expression_is_not_a_literal():
    text = '<r><a x="${1 + 1}" y="2" z="&lt;"/></r>'
    parsed = parse_element(text, "a")
    assert [is_literal(parsed, name) for name in "xyz"] == [False, True, False]
    assert replace_value(parsed, "x", "3") is None


def test_element_without_source_has_no_fix():
    element = Element("a", {"x": "1"})
    assert replace_value(element, "x", "2") is None
    assert remove_element(element) is None
    assert add_attribute(element, "y", "2") is None


def fix_path(path: Path, *, unsafe: bool = False, write: bool = True, select: tuple[str, ...] = ("LW2",)):
    def check(text: str | None):
        overlay = None if text is None else Overlay({path: text})
        return examine(path, settings=Settings(select=select), overlay=overlay).diagnostics

    return fix_file(path, check, unsafe=unsafe, write=write)


def test_fix_keeps_rest_of_file(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT)
    result = fix_path(path)
    assert path.read_text() == ROBOT.replace("1 1 0", "0.707107 0.707107 0")
    assert result.counts == {"LW221": 1}


def test_diff_does_not_write_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = Path("robot.urdf")
    path.write_text(ROBOT)
    assert fix_path(path, write=False).diff().splitlines() == [
        "--- robot.urdf",
        "+++ robot.urdf",
        "@@ -6,7 +6,7 @@",
        '   <joint name="j"   type="continuous">',
        '     <parent link="a"/>',
        '     <child link="b"/>',
        '-    <axis   xyz="1 1 0"',
        '+    <axis   xyz="0.707107 0.707107 0"',
        "     />",
        "   </joint>",
        " </robot>",
    ]
    assert path.read_text() == ROBOT


def test_fix_keeps_line_endings_byte_order_mark_and_permissions(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_bytes(b"\xef\xbb\xbf" + ROBOT.replace("\n", "\r\n").encode())
    path.chmod(0o640)
    fix_path(path)
    expected = ROBOT.replace("1 1 0", "0.707107 0.707107 0").replace("\n", "\r\n")
    assert path.read_bytes() == b"\xef\xbb\xbf" + expected.encode()
    assert path.stat().st_mode & 0o777 == 0o640


def test_fix_keeps_symlink(tmp_path):
    (tmp_path / "real").mkdir()
    real = tmp_path / "real" / "robot.urdf"
    real.write_text(ROBOT)
    link = tmp_path / "robot.urdf"
    link.symlink_to(real)
    write_text(link, "<robot/>")
    assert link.is_symlink()
    assert real.read_text() == "<robot/>"
    assert list((tmp_path / "real").iterdir()) == [real]


def test_included_file_is_fixed_once_for_all_macro_calls(tmp_path):
    (tmp_path / "wheel.xacro").write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:macro name="wheel" params="side tilt:=0">\n'
        '    <link name="${side}"/>\n'
        '    <joint name="${side}_joint" type="continuous">\n'
        '      <parent link="a"/>\n      <child link="${side}"/>\n      <axis xyz="0 2 0"/>\n    </joint>\n'
        '    <link name="${side}2"/>\n'
        '    <joint name="${side}2_joint" type="continuous">\n'
        '      <parent link="a"/>\n      <child link="${side}2"/>\n      <axis xyz="0 ${2} 0"/>\n    </joint>\n'
        "  </xacro:macro>\n</robot>\n"
    )
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n  <xacro:include filename="wheel.xacro"/>\n'
        '  <link name="a"/>\n  <xacro:wheel side="l"/>\n  <xacro:wheel side="r"/>\n</robot>\n'
    )
    result = fix_path(path)
    assert result.counts == {"LW221": 1}
    text = (tmp_path / "wheel.xacro").read_text()
    assert 'xyz="0 1 0"' in text
    assert 'xyz="0 ${2} 0"' in text


def test_files_outside_package_are_not_fixed(tmp_path):
    (tmp_path / "mine").mkdir()
    other = tmp_path / "other.xacro"
    other.write_text(ROBOT)
    path = tmp_path / "mine" / "robot.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="../other.xacro"/></robot>'
    )
    assert fix_path(path).counts == {}
    assert other.read_text() == ROBOT


def test_only_one_of_overlapping_fixes_is_applied(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text("<robot>aaa</robot>")

    def check(_text: str | None):
        text = path.read_text()
        if "aaa" in text:
            start = text.index("aaa")
            for replacement in ("ab", "b"):
                yield Finding("LW999", "m", fix=Fix((Edit(str(path), start, start + 3, replacement),)))

    assert fix_file(path, check).counts == {"LW999": 1}
    assert path.read_text() == "<robot>ab</robot>"


def test_fix_that_breaks_file_is_not_applied(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text("<robot>a</robot>")
    finding = Finding("LW999", "m", fix=Fix((Edit(str(path), 0, 1, ""),)))
    assert fix_file(path, lambda _text: [finding]).counts == {}
    assert path.read_text() == "<robot>a</robot>"


def test_unwritable_file_is_reported(tmp_path):
    with pytest.raises(LinkwrightError) as caught:
        write_text(tmp_path / "none" / "robot.urdf", "x")
    assert caught.value.diagnostics[0].code == "LINT201"


def test_unsafe_fixes_are_applied_only_on_request(tmp_path):
    path = tmp_path / "robot.urdf"
    text = (
        ROBOT.replace("1 1 0", "1 0 0")
        .replace('"continuous"', '"revolute"')
        .replace("</joint>", '<limit lower="2" upper="1" effort="1" velocity="1"/></joint>')
    )
    path.write_text(text)
    fix_path(path)
    assert path.read_text() == text
    fix_path(path, unsafe=True)
    assert 'lower="1" upper="2"' in path.read_text()


def test_source_span_counts_columns_from_one():
    source = SourceText("f", "ab")
    assert source.span(1).column == 2
