"""The page of URDF's elements is generated and current."""

from __future__ import annotations

from tests.repository_tools import load_tool


def test_the_page_is_current() -> None:
    tool = load_tool("urdf_reference")
    assert tool.PAGE.read_text(encoding="utf-8") == tool.generate(), "run tools/urdf_reference.py"


def test_every_element_has_a_section() -> None:
    text = load_tool("urdf_reference").generate()
    for tag in ("robot", "link", "joint", "origin", "capsule", "color", "safety_controller"):
        assert text.count(f"## `<{tag}>`") == 1
