"""The findings about the files of an editor when files and unsaved texts change."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.definitions import definitions_in
from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace

PARTS = (
    '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m"><link name="b"/></xacro:macro></robot>'
)
MAIN = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="parts.xacro"/>
  <xacro:m/>
</robot>"""
LONG_AXIS = """<robot name="r">
  <link name="a"/><link name="b"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 2"/></joint>
</robot>"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "linkwright.toml").write_text('select = ["LW221"]\n')
    return real_path(tmp_path)


@pytest.fixture
def workspace(folder: Path) -> Workspace:
    workspace = Workspace([folder])
    workspace.index.refresh()
    return workspace


def codes(workspace: Workspace, file: Path, texts=None) -> dict[str, list[str]]:
    """Check the files that a change affects, and return the codes of the findings by file."""
    texts = texts or {}
    found = {}
    for subject in workspace.subjects(file, texts):
        found |= workspace.check(subject, texts, [file])
    return {path.name: [finding.code for finding in findings] for path, findings in found.items()}


def test_fix_is_offered_only_for_checked_text(workspace, folder):
    file = folder / "r.urdf"
    texts = {file: LONG_AXIS}
    assert codes(workspace, file, texts) == {"r.urdf": ["LW221"]}
    (finding,) = workspace.fixable_findings(file, texts)
    (edit,) = finding.fix.edits
    assert LONG_AXIS[edit.start : edit.end] == "0 0 2"
    assert workspace.fixable_findings(file, {file: "<!-- typed -->\n" + LONG_AXIS}) == []
    assert workspace.fixable_findings(file, {}) == []


def test_empty_manifest_findings_are_cleared_once_filled(workspace, folder):
    file = folder / "arm" / "package.xml"
    file.parent.mkdir()
    file.write_text("")
    texts = {file: ""}
    assert workspace.subjects(file, texts) == []
    assert [finding.code for finding in workspace.check(file, texts, [file])[file]] == ["XML105"]
    file.write_text("<package><name>arm</name></package>")
    assert codes(workspace, file, {file: file.read_text()}) == {"package.xml": []}


def test_findings_are_cleared_when_file_is_deleted(workspace, folder):
    file = folder / "r.urdf"
    file.write_text(LONG_AXIS)
    assert codes(workspace, file) == {"r.urdf": ["LW221"]}
    file.unlink()
    workspace.file_saved(file)
    assert codes(workspace, file) == {"r.urdf": []}


def test_file_created_later_is_checked_with_its_includer(workspace, folder):
    main, parts = folder / "r.urdf.xacro", folder / "parts.xacro"
    main.write_text(MAIN)
    assert "XAC506" in codes(workspace, main)["r.urdf.xacro"] or "XML101" in codes(workspace, main)["r.urdf.xacro"]
    parts.write_text(PARTS)
    assert workspace.subjects(parts, {}) == [main]
    assert codes(workspace, parts) == {"r.urdf.xacro": [], "parts.xacro": []}


def test_material_has_only_its_own_color():
    text = (
        '<material name="plain"><texture filename="a.png"/></material><material name="open">'
        '<material name="orange"><color rgba="1 0.5 0 1"/></material>'
    )
    details = {name.name: name.detail for name in definitions_in(text, Path("a.urdf"))}
    assert details == {"plain": "", "open": "", "orange": "1 0.5 0 1"}
