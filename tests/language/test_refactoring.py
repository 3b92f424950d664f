"""Refactorings: edits, positions of new definitions, and refusals."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.language.proof import apply_edits_to_texts
from linkwright.language.refactoring import Action, find_offers, refactor
from linkwright.language.workspace import Workspace

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'


class Description:
    """A xacro file in a workspace.

    Args:
        folder: the root of the workspace.
        body: the content of its root.
    """

    def __init__(self, folder: Path, body: str) -> None:
        self.text = f"{HEAD}{body}</robot>\n"
        self.file = folder.resolve() / "r.urdf.xacro"
        self.file.write_text(self.text, encoding="utf-8")
        self.workspace = Workspace([folder])
        self.workspace.index.refresh()

    def refactored(self, action: Action, place: str, before: str = "") -> str:
        """Return the content of the root after a refactoring of a selected text."""
        start = self.text.index(before + place) + len(before)
        names = self.workspace.names(self.file, {})
        offers = [*find_offers(self.text, self.file, start, start + len(place), names)]
        assert action in [offer.action for offer in offers]
        result = refactor(self.workspace, {}, action, self.file, start, start + len(place))
        changed = apply_edits_to_texts(self.workspace, {}, result.edits)[self.file]
        return changed.removeprefix(HEAD).removesuffix("</robot>\n")

    def refused(self, action: Action, place: str) -> str:
        """Return the reason why a refactoring of a selected text is refused."""
        start = self.text.index(place)
        with pytest.raises(LinkwrightError) as raised:
            refactor(self.workspace, {}, action, self.file, start, start + len(place))
        assert raised.value.diagnostics[0].code == "LANG105"
        return raised.value.diagnostics[0].message


MACRO = """  <xacro:macro name="wheel" params="side radius:=0.3">
    <link name="${side}_wheel">
      <visual><geometry><sphere radius="${radius * 0.5 + 0.1}"/></geometry></visual>
    </link>
  </xacro:macro>
  <xacro:wheel side="left"/>
"""


def test_extract_property_inserts_number_before_top_level_element(tmp_path):
    edited_text = Description(tmp_path, MACRO).refactored(Action.EXTRACT_PROPERTY, "0.5")
    assert edited_text.startswith('  <xacro:property name="sphere_radius" value="0.5"/>\n  <xacro:macro')
    assert "${radius * sphere_radius + 0.1}" in edited_text


def test_extract_property_with_parameters_stays_in_macro(tmp_path):
    edited_text = Description(tmp_path, MACRO).refactored(Action.EXTRACT_PROPERTY, "radius * 0.5", "${")
    assert '\n    <xacro:property name="sphere_radius" value="${radius * 0.5}"/>\n    <link' in edited_text
    assert "${sphere_radius + 0.1}" in edited_text


def test_extract_property_is_not_offered_across_operator_precedence(tmp_path):
    description = Description(tmp_path, MACRO)
    start = description.text.index("0.5 + 0.1")
    assert not [*find_offers(description.text, description.file, start, start + len("0.5 + 0.1"))]


def test_extracted_number_is_named_after_its_axis(tmp_path):
    body = '  <link name="a"><visual><origin xyz="0 0.2 0"/></visual></link>\n'
    edited_text = Description(tmp_path, body).refactored(Action.EXTRACT_PROPERTY, "0.2")
    assert '<xacro:property name="origin_y" value="0.2"/>' in edited_text
    assert 'xyz="0 ${origin_y} 0"' in edited_text


def test_duplicate_property_name_gets_a_number(tmp_path):
    body = '  <xacro:property name="mass_value" value="2"/>\n  <a><mass value="3"/></a>\n'
    edited_text = Description(tmp_path, body).refactored(Action.EXTRACT_PROPERTY, "3")
    assert '<mass value="${mass_value_2}"/>' in edited_text


def test_comment_stays_above_its_element(tmp_path):
    body = '  <!-- the arm\n       of the robot -->\n  <!-- b -->\n  <a v="3"/>\n'
    edited_text = Description(tmp_path, body).refactored(Action.EXTRACT_PROPERTY, "3")
    assert edited_text.startswith('  <xacro:property name="a_v" value="3"/>\n  <!-- the arm')


def test_inline_property_is_rejected_if_xacro_would_keep_its_comment(tmp_path):
    body = '  <!-- sizes -->\n  <xacro:property name="r" value="1"/>\n  <b v="${r}"/>\n'
    assert "comments" in Description(tmp_path, body).refused(Action.INLINE_PROPERTY, "r}")


def test_extract_property_is_rejected_if_number_format_would_change(tmp_path):
    description = Description(tmp_path, '  <a v="0.10"/>\n')
    assert "would change" in description.refused(Action.EXTRACT_PROPERTY, "0.10")


def test_extract_macro_passes_used_names_as_parameters(tmp_path):
    visual = '<visual><geometry><sphere radius="${radius * 0.5 + 0.1}"/></geometry></visual>'
    edited_text = Description(tmp_path, MACRO).refactored(Action.EXTRACT_MACRO, visual)
    assert edited_text.startswith(
        f'  <xacro:macro name="wheel_visual" params="radius">\n    {visual}\n  </xacro:macro>\n'
    )
    assert '\n      <xacro:wheel_visual radius="${radius}"/>\n' in edited_text


def test_extract_macro_moves_comment_with_element(tmp_path):
    body = '  <!-- the arm -->\n  <a v="3"/>\n'
    edited_text = Description(tmp_path, body).refactored(Action.EXTRACT_MACRO, '<a v="3"/>')
    macro = '  <xacro:macro name="a_macro" params="">\n    <!-- the arm -->\n    <a v="3"/>\n  </xacro:macro>\n'
    assert edited_text == f"{macro}  <xacro:a_macro/>\n"


def test_extract_macro_keeps_relative_indentation(tmp_path):
    link = MACRO[MACRO.index("<link") : MACRO.index("</link>") + len("</link>")]
    edited_text = Description(tmp_path, f"  <gazebo>\n{MACRO}  </gazebo>\n").refactored(Action.EXTRACT_MACRO, link)
    assert '\n    <link name="${side}_wheel">\n      <visual>' in edited_text
    assert "</visual>\n    </link>\n  </xacro:macro>\n" in edited_text


START = '  <xacro:arg name="x" default="1"/>\n  <xacro:property name="a" value="1"/>\n'


@pytest.mark.parametrize(
    ("value", "use", "expected"),
    [
        ("0.5", "${r}", "0.5"),
        ("0.50", "${r}", "${0.50}"),
        ("${a + 1}", "${2 * r}", "${2 * (a + 1)}"),
        ("${a * 1}", "${2 + r}", "${2 + a * 1}"),
        ("${a + 1}", "${max(r, 1)}", "${max(a + 1, 1)}"),
        ("-2", "${r**2}", "${(-2)**2}"),
        ("${a}_b", "x_${r}", "x_${a}_b"),
        ("left", "${r == 'left'}", "${'left' == 'left'}"),
        ("007", "${r + 1}", "${7 + 1}"),
        ("${a + $(arg x)}", "${2 * r}", "${2 * (a + $(arg x))}"),
    ],
)
def test_inline_property_adds_parentheses_where_needed(tmp_path, value, use, expected):
    body = f'{START}  <xacro:property name="r" value="{value}"/>\n  <b v="{use}"/>\n'
    edited_text = Description(tmp_path, body).refactored(
        Action.INLINE_PROPERTY, "r", 'name="a" value="1"/>\n  <xacro:property name="'
    )
    assert edited_text == f'{START}  <b v="{expected}"/>\n'


def test_inline_property_with_two_definitions_is_rejected(tmp_path):
    property_ = '  <xacro:property name="r" value="1"/>\n'
    description = Description(tmp_path, f'{property_}{property_}  <b v="${{r}}"/>\n')
    assert "2 definitions" in description.refused(Action.INLINE_PROPERTY, "r}")


def test_inline_property_of_computed_text_in_expression_is_rejected(tmp_path):
    body = '  <xacro:property name="r" value="${1}_b"/>\n  <b v="${r + \'c\'}"/>\n'
    description = Description(tmp_path, body)
    assert "cannot contain the value" in description.refused(Action.INLINE_PROPERTY, "r +")


def test_fill_in_inertia_computes_from_shapes(tmp_path):
    body = '  <link name="a">\n    <visual><geometry><box size="1 1 1"/></geometry></visual>\n  </link>\n'
    description = Description(tmp_path, body)
    edited_text = description.refactored(Action.FILL_IN_INERTIA, "link")
    assert '    <inertial>\n      <origin xyz="0 0 0" rpy="0 0 0"/>\n      <mass value="1000"/>\n' in edited_text


def test_fill_in_inertia_with_expressions_is_rejected(tmp_path):
    body = '  <link name="a"><visual><geometry><box size="${1} 1 1"/></geometry></visual></link>\n'
    assert "is not available for the selection" in Description(tmp_path, body).refused(Action.FILL_IN_INERTIA, "link")


def test_convert_to_xacro_escapes_dollar_signs(tmp_path):
    file = tmp_path.resolve() / "r.urdf"
    file.write_text('<robot name="r"><!-- ${x} --><link name="a"/><gazebo><v>$(find x) ${y} $z</v></gazebo></robot>')
    workspace = Workspace([tmp_path])
    new = refactor(workspace, {}, Action.CONVERT_TO_XACRO, file, 0, 0).new_file
    assert new is not None
    assert new.file.name == "r.urdf.xacro"
    assert "<!-- ${x} -->" in new.text
    assert "<v>$$(find x) $${y} $z</v>" in new.text
