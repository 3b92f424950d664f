"""Fixes and hints for unknown names never suggest the name of another thing."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine
from linkwright.lint.finding import Finding
from linkwright.lint.settings import Settings

JOINT = '<joint name="{0}_joint" type="continuous"><parent link="base"/><child link="{0}_link"/></joint>'
HARDWARE = "<hardware><plugin>p/P</plugin></hardware>"
REFERENCES = {
    "LW120 link": '<gazebo reference="{}_link"><mu1>1</mu1></gazebo>',
    "LW120 joint": '<gazebo reference="{}_joint"><preserveFixedJoint>true</preserveFixedJoint></gazebo>',
    "LW120": '<gazebo reference="{}"/>',
    "LW121": '<transmission name="t"><joint name="{}_joint"/></transmission>',
    "LW122": f'<ros2_control name="c" type="system">{HARDWARE}<joint name="{{}}_joint"/></ros2_control>',
}
NUMBERED_PAIRS = [("arm_2", "arm_1"), ("wheel12", "wheel1"), ("leg_3_knee", "leg_4_knee")]
SIBLING_PAIRS = [
    *NUMBERED_PAIRS,
    ("fl_wheel", "fr_wheel"),
    ("lwheel", "rwheel"),
    ("left_arm", "right_arm"),
    ("rear", "front"),
]


def find_only_finding(tmp_path, rule, written, sibling_name):
    body = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    parts = f'<link name="base">{body}</link><link name="{sibling_name}_link"/>{JOINT.format(sibling_name)}'
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{parts}{REFERENCES[rule].format(written)}</robot>')
    (finding,) = examine(path, settings=Settings(select=(rule.split()[0],))).diagnostics
    assert isinstance(finding, Finding)
    return finding


@pytest.mark.parametrize("rule", REFERENCES)
@pytest.mark.parametrize(("written", "sibling_name"), SIBLING_PAIRS)
def test_fix_never_uses_name_of_sibling(tmp_path, rule, written, sibling_name):
    assert find_only_finding(tmp_path, rule, written, sibling_name).fix is None


@pytest.mark.parametrize("rule", REFERENCES)
@pytest.mark.parametrize(("written", "sibling_name"), NUMBERED_PAIRS)
def test_hint_never_suggests_number_of_sibling(tmp_path, rule, written, sibling_name):
    assert f"'{sibling_name}_" not in str(find_only_finding(tmp_path, rule, written, sibling_name).hint)


@pytest.mark.parametrize(
    ("rule", "written", "intended"),
    [
        ("LW120 link", "elbw", "elbow_link"),
        ("LW120 joint", "elbw", "elbow_joint"),
        ("LW122", "elbw", "elbow_joint"),
    ],
)
def test_misspelled_name_is_fixed_with_name_of_same_kind(tmp_path, rule, written, intended):
    sibling_finding = find_only_finding(tmp_path, rule, written, "elbow")
    assert [edit.replacement for edit in sibling_finding.fix.edits] == [intended]
