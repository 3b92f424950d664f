"""Changes of properties in unexpanded descriptions."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

COLORS = "arm_description/urdf/colors.xacro"
TEXT = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="steel" value="0.5 0.5 0.5 1"/>
  <xacro:property name="signal" value="1 0 0 1"/>
  <xacro:property name="height" value="0.3"/>
  <xacro:macro name="tower" params="name model">
    <link name="${name}"><visual><geometry><box size="1 1 ${height}"/></geometry></visual></link>
  </xacro:macro>
</robot>
"""
HEIGHT = '  <xacro:property name="height" value="0.3"/>\n'


@pytest.fixture
def change(package, compare):
    """Review a replacement in the file with properties."""

    def run(old: str, new: str):
        package.commit({COLORS: TEXT})
        package.write({COLORS: TEXT.replace(old, new)})
        return compare(package)

    return run


def test_lost_property_that_only_other_files_use_is_breaking(change):
    result = change('  <xacro:property name="signal" value="1 0 0 1"/>\n', "")
    assert breaking(result) == ["properties removed: signal"]


def test_names_that_are_edited_alike_are_renamed(change):
    text = TEXT.replace('name="steel"', 'name="arm_steel"').replace('name="signal"', 'name="arm_signal"')
    result = change(TEXT, text)
    assert breaking(result) == ["properties renamed: steel -> arm_steel, signal -> arm_signal"]


def test_lost_property_of_the_file_itself_is_not_breaking(change):
    result = change(HEIGHT, "")
    (part,) = [sentence for sentence in sentences(subject(result, COLORS)) if sentence.startswith("properties")]
    assert part == "properties removed: height"
    assert part not in breaking(result)


def test_value_that_moves_into_branches_of_a_macro_is_compared(change):
    branches = (
        '"name model">\n    <xacro:if value="${model == 1}"><xacro:property name="height" value="0.3"/></xacro:if>'
        '\n    <xacro:if value="${model == 2}"><xacro:property name="height" value="0.5"/></xacro:if>'
    )
    result = change(TEXT, TEXT.replace(HEIGHT, "").replace('"name model">', branches))
    assert sentences(subject(result, COLORS)) == [
        "macro 'tower': property height: 0.3 -> 0.5 (if ${model == 2})",
    ]


def test_property_of_an_added_macro_has_no_old_value(change):
    added = '  <xacro:macro name="mast" params="name"><xacro:property name="height" value="9"/></xacro:macro>\n</robot>'
    assert not any("0.3" in sentence for sentence in sentences(subject(change("</robot>", added), COLORS)))


def test_lost_property_of_a_file_with_elements_is_not_breaking(package, compare):
    text = TEXT.replace("</robot>", '  <gazebo reference="base_link"><mu1>1</mu1></gazebo>\n</robot>')
    package.commit({COLORS: text})
    package.write({COLORS: text.replace('  <xacro:property name="signal" value="1 0 0 1"/>\n', "")})
    assert breaking(compare(package)) == []
