"""Images from Graphviz."""

from __future__ import annotations

import sys

import pytest

from linkwright.descriptions import load
from linkwright.diagnostics import LinkwrightError
from linkwright.urdf import to_gv
from linkwright.urdf.diagram import render
from tests.urdf.robots import chain_of_links, robot_text

GV = to_gv(load(robot_text(chain_of_links("fixed", "continuous"))))


FORMATS = [("pdf", b"%PDF-"), ("svg", b"<?xml"), ("png", b"\x89PNG"), ("SVG", b"<?xml")]


@pytest.mark.extra("diagram")
@pytest.mark.parametrize(("ending", "start"), FORMATS)
def test_file_suffix_selects_format(tmp_path, ending, start):
    diagram = tmp_path / f"robot.{ending}"
    render(GV, diagram)
    assert diagram.read_bytes().startswith(start)


@pytest.mark.extra("diagram")
def test_links_are_boxes_and_joints_are_ellipses(tmp_path):
    diagram = tmp_path / "robot.svg"
    render(GV, diagram)
    text = diagram.read_text()
    assert text.count('stroke="black" points') == 3 + 4  # three boxes and four arrow heads
    assert text.count("<ellipse") == 2
    assert [label for label in ("a", "b", "c", "j0", "j1") if f">{label}</text>" not in text] == []


@pytest.mark.extra("diagram")
def test_non_ascii_names_are_rendered(tmp_path):
    diagram = tmp_path / "robot.svg"
    render(to_gv(load(robot_text('<link name="底盘"/>'))), diagram)
    assert "底盘" in diagram.read_text(encoding="utf-8")


@pytest.mark.parametrize(("name", "hint"), [("robot.pfd", ".pdf"), ("robot", "choose from")])
def test_unknown_suffix_is_rejected_with_hint(tmp_path, name, hint):
    with pytest.raises(LinkwrightError) as caught:
        render(GV, tmp_path / name)
    assert caught.value.diagnostics[0].code == "URDF201"
    assert hint in caught.value.diagnostics[0].hint


def test_missing_pygraphviz_is_reported(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pygraphviz", None)
    with pytest.raises(LinkwrightError) as caught:
        render(GV, tmp_path / "robot.pdf")
    assert caught.value.diagnostics[0].code == "URDF202"


@pytest.mark.extra("diagram")
def test_missing_folder_is_reported(tmp_path):
    with pytest.raises(LinkwrightError, match="cannot write"):
        render(GV, tmp_path / "missing" / "robot.pdf")


@pytest.mark.extra("diagram")
def test_invalid_dot_text_is_reported(tmp_path):
    with pytest.raises(LinkwrightError, match="could not draw"):
        render("digraph {", tmp_path / "robot.svg")
