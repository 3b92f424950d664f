"""Findings about a description that can only be expanded in part."""

from __future__ import annotations

import pytest

from linkwright.lint import check
from linkwright.lint.registry import all_rules

VALID_LIMITS = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
INVALID_LIMITS = '<axis xyz="0 0 1"/><limit lower="1" upper="-1" effort="1" velocity="1"/>'


def joint_text(name: str, limit: str = INVALID_LIMITS) -> str:
    return f'<joint name="{name}" type="revolute"><parent link="base"/><child link="{name}_tip"/>{limit}</joint>'


@pytest.fixture
def find_codes(tmp_path):
    def check_body(body: str) -> list[str]:
        path = tmp_path / "robot.xacro"
        path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{body}\n</robot>')
        return [finding.code for finding in check(path)]

    return check_body


def test_rule_findings_are_reported_beside_xacro_error(find_codes):
    assert find_codes(f'{joint_text("a")}\n<xacro:whel/>\n<link name="${{x}}"/>') == ["LW201", "XAC401", "XAC201"]


def test_urdf_errors_are_reported_beside_xacro_error(find_codes):
    assert find_codes('<link name="a"><visual/></link>\n<xacro:whel/>') == ["URDF130", "XAC401"]


def test_consequences_of_missing_part_are_not_reported(find_codes):
    # Without the missing part, there are two root links, a joint of missing links, and an unused property and macro.
    unused = '<xacro:property name="p" value="1"/><xacro:macro name="m"/>'
    assert find_codes(f'{unused}<link name="a"/><link name="b"/>{joint_text("c", VALID_LIMITS)}<xacro:whel/>') == [
        "XAC401"
    ]


def test_element_with_failed_attribute_is_not_checked(find_codes):
    limit = '<axis xyz="0 0 1"/><limit lower="1" upper="-1" effort="${x}" velocity="1"/>'
    assert find_codes(joint_text("a", limit)) == ["XAC201"]


def test_suppression_is_not_reported_as_unused_beside_xacro_error(tmp_path):
    path = tmp_path / "robot.xacro"
    (tmp_path / "linkwright.toml").write_text('extend-select = ["LW001"]')
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        "<!-- linkwright: ignore LW102 -->\n<xacro:whel/></robot>"
    )
    assert [finding.code for finding in check(path)] == ["XAC401"]


def test_element_rules_hold_for_partial_descriptions():
    assert {"LW201", "LW303", "LW424", "LW723"} <= {rule.code for rule in all_rules() if rule.holds_for_parts}


def test_whole_robot_rules_skip_partial_descriptions():
    whole_robot_codes = {"LW102", "LW103", "LW121", "LW302", "LW507", "LW701", "LW849"}
    assert not whole_robot_codes & {rule.code for rule in all_rules() if rule.holds_for_parts}
