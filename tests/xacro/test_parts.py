"""The expanded parts of a description with errors, and the reported errors."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.xacro import Expansion, expand
from linkwright.xacro.parts import expand_parts
from linkwright.xacro.session import Inputs
from linkwright.xmltree import write_element


def parts(folder, body: str, **files: str) -> Expansion:
    for name, text in files.items():
        (folder / f"{name}.xacro").write_text(f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{text}</robot>')
    path = folder / "robot.xacro"
    path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>')
    return file_of(path)


def file_of(path: Path) -> Expansion:
    try:
        return expand(path)
    except LinkwrightError as error:
        return expand_parts(Inputs(str(path), {}), error)


def link_names(expansion: Expansion) -> list[str]:
    return [link.attributes["name"] for link in expansion.document.root.elements("link")]


def problem_texts(expansion: Expansion) -> list[str]:
    return [problem.code for problem in expansion.problems]


def test_parts_of_valid_description_are_complete(tmp_path):
    body = '<xacro:property name="a" value="1"/><link name="l${a}"><inertial><mass value="${a}"/></inertial></link>'
    complete_parts = parts(tmp_path, body)
    expansion = expand_parts(Inputs(str(tmp_path / "robot.xacro"), {}), LinkwrightError(Diagnostic("XAC201", "")))
    assert expansion.problems == ()
    assert write_element(expansion.document.root) == write_element(complete_parts.document.root)


def test_element_with_failed_attribute_omits_its_ancestors(tmp_path):
    expansion = parts(tmp_path, '<link name="a"><visual><origin xyz="${nowhere} 0 0"/></visual></link><link name="b"/>')
    assert link_names(expansion) == ["b"]
    assert problem_texts(expansion) == ["XAC201"]


def test_all_mistakes_are_reported(tmp_path):
    expansion = parts(
        tmp_path,
        '<link name="${1/0}"/><xacro:wheel/><link name="a"/><xacro:insert_block name="b"/><link name="${x}"/>',
    )
    assert link_names(expansion) == ["a"]
    assert problem_texts(expansion) == ["XAC202", "XAC401", "XAC406", "XAC201"]


def test_failed_text_omits_its_element(tmp_path):
    expansion = parts(tmp_path, '<gazebo><a>${nowhere}</a></gazebo><link name="a"/>')
    assert [element.tag for element in expansion.document.root.elements()] == ["link"]


def test_failed_call_omits_element_around_it(tmp_path):
    expansion = parts(tmp_path, '<link name="a"><xacro:shape/></link><link name="b"/>')
    assert link_names(expansion) == ["b"]


def test_failure_in_macro_body_omits_element_around_call(tmp_path):
    macro = '<xacro:macro name="m"><xacro:none/><visual/></xacro:macro>'
    expansion = parts(tmp_path, f'{macro}<link name="a"><xacro:m/></link><link name="b"/>')
    assert link_names(expansion) == ["b"]


def test_failure_in_block_omits_element_that_inserts_it(tmp_path):
    macro = (
        '<xacro:macro name="m" params="*block"><link name="a"><xacro:insert_block name="block"/></link></xacro:macro>'
    )
    body = f'{macro}<xacro:m><origin xyz="${{nowhere}} 0 0"/></xacro:m><link name="b"/>'
    assert link_names(parts(tmp_path, body)) == ["b"]


def test_call_without_its_failed_block_is_omitted_without_report(tmp_path):
    macro = '<xacro:macro name="m" params="*block"><link name="a"/></xacro:macro>'
    expansion = parts(tmp_path, f'{macro}<xacro:m><xacro:none/></xacro:m><link name="b"/>')
    assert link_names(expansion) == ["b"]
    assert problem_texts(expansion) == ["XAC401"]


class TestConsequences:
    def test_names_of_missing_include_are_not_reported(self, tmp_path):
        expansion = parts(
            tmp_path,
            '<xacro:include filename="none.xacro"/><link name="${prefix}a"/><xacro:wheel/><link name="b"/>',
        )
        assert link_names(expansion) == ["b"]
        assert problem_texts(expansion) == ["XML101"]

    def test_all_missing_files_are_reported(self, tmp_path):
        includes = '<xacro:include filename="none.xacro"/><xacro:include filename="$(cwd)/nor_this.xacro"/>'
        assert problem_texts(parts(tmp_path, includes)) == ["XML101", "XML101"]

    def test_malformed_expressions_are_reported(self, tmp_path):
        expansion = parts(tmp_path, '<xacro:include filename="none.xacro"/><link name="${1 +}"/>')
        assert problem_texts(expansion) == ["XML101", "XAC102"]

    def test_elements_with_uncertain_values_are_omitted(self, tmp_path):
        mass = '<link name="a"><inertial><mass value="${m}"/></inertial></link>'
        expansion = parts(
            tmp_path,
            f'<xacro:property name="m" value="0"/><xacro:if value="${{x}}"><xacro:property name="m" value="1"/>'
            f'</xacro:if>{mass}<link name="b"/>',
        )
        assert link_names(expansion) == ["b"]
        assert problem_texts(expansion) == ["XAC201"]

    def test_conditions_on_uncertain_values_are_omitted(self, tmp_path):
        body = '<xacro:include filename="none.xacro"/><xacro:unless value="${m}"><link name="a"/></xacro:unless>'
        assert link_names(parts(tmp_path, f'<xacro:property name="m" value="0"/>{body}<link name="b"/>')) == ["b"]

    def test_missing_macro_leaves_outer_properties_certain(self, tmp_path):
        expansion = parts(tmp_path, '<xacro:property name="m" value="1"/><xacro:wheeel/><link name="a${m}"/>')
        assert link_names(expansion) == ["a1"]

    def test_missing_macro_may_set_properties_of_parent_scope(self, tmp_path):
        macro = '<xacro:macro name="m"><xacro:property name="x" value="2" scope="parent"/></xacro:macro>'
        expansion = parts(tmp_path, f'{macro}<xacro:property name="x" value="1"/><xacro:n/><link name="a${{x}}"/>')
        assert link_names(expansion) == []
        assert problem_texts(expansion) == ["XAC401"]

    def test_warnings_that_may_be_consequences_are_omitted(self, tmp_path):
        warning = '<xacro:property name="none" remove="true"/>'
        assert [diagnostic.code for diagnostic in parts(tmp_path, warning).diagnostics] == ["XAC310"]
        assert parts(tmp_path, f'<xacro:include filename="none.xacro"/>{warning}').diagnostics == ()


class TestUnreadableParts:
    def test_malformed_xml_is_an_error(self, tmp_path):
        with pytest.raises(LinkwrightError, match="does not close"):
            parts(tmp_path, "<link>")

    def test_exceeded_limit_is_an_error(self, tmp_path):
        macro = '<xacro:macro name="m"><xacro:m/></xacro:macro>'
        with pytest.raises(LinkwrightError, match="nested"):
            parts(tmp_path, f"{macro}<xacro:m/>")

    def test_too_many_mistakes_are_an_error(self, tmp_path):
        with pytest.raises(LinkwrightError) as caught:
            parts(tmp_path, "".join(f'<link name="${{a{number}}}"/>' for number in range(30)))
        assert len(caught.value.diagnostics) == 20


def test_included_file_with_mistake_keeps_other_parts(tmp_path):
    expansion = parts(
        tmp_path,
        '<xacro:include filename="part.xacro"/><link name="c"/>',
        part='<link name="a"/><link name="${x}"/><link name="b"/>',
    )
    assert link_names(expansion) == ["a", "b", "c"]
