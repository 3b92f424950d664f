"""Values that a comment explains are reported as information."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine
from linkwright.lint.settings import Settings

_LINK = """
<joint name="j{0}" type="continuous"><parent link="world"/><child link="{0}"/></joint>
<link name="{0}">
  <inertial>
    {1}
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
  </inertial>
  <visual><geometry>{2}</geometry></visual>
</link>
"""
_BOX = '<box size="0.1 0.1 0.1"/>'


def severities(tmp_path, links):
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r"><link name="world"/>{links}</robot>')
    findings = examine(path, settings=Settings(select=("LW315", "LW320"))).diagnostics
    return [(finding.code, finding.severity.value) for finding in findings]


@pytest.mark.parametrize(
    "mass",
    [
        '<mass value="300"/> <!-- ballast, so that it stands still -->',
        '<!-- to stabilise -->\n<mass value="300"/>',
        '<!-- makes the\n  simulation stable -->\n  <mass value="300"/>',
        '<!-- heavier than it is --> <mass value="300"/>',
    ],
)
def test_comment_at_mass_lowers_severity_to_info(tmp_path, mass):
    assert severities(tmp_path, _LINK.format("a", mass, _BOX)) == [("LW320", "info")]


@pytest.mark.parametrize(
    "mass",
    [
        '<mass value="300"/>',
        '<!-- mass -->\n<mass value="300"/>',
        '<!-- <mass value="3"/> -->\n<mass value="300"/>',
        '<!-- to stabilise -->\n\n<mass value="300"/>',
        '<mass value="300"/>\n<!-- to stabilise -->',
    ],
)
def test_unrelated_comments_keep_warning(tmp_path, mass):
    assert severities(tmp_path, _LINK.format("a", mass, _BOX)) == [("LW320", "warning")]


def test_comment_at_repeated_inertia_lowers_severity_to_info(tmp_path):
    shapes = (_BOX, '<sphere radius="0.1"/>', '<cylinder radius="0.1" length="0.1"/>')
    links = "".join(_LINK.format(f"l{number}", '<mass value="1"/>', shape) for number, shape in enumerate(shapes))
    assert severities(tmp_path, links) == [("LW315", "warning")]
    explained = links.replace('izz="1"/>', 'izz="1"/> <!-- to stabilise -->')
    assert severities(tmp_path, explained) == [("LW315", "info")]


def test_comment_above_inertial_applies_to_mass(tmp_path):
    link = _LINK.format("a", '<mass value="300"/>', _BOX).replace("<inertial>", "<!-- ballast -->\n  <inertial>")
    assert severities(tmp_path, link) == [("LW320", "info")]
