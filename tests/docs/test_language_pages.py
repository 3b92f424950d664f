"""The generated pages of URDF's and SDF's elements are current."""

from __future__ import annotations

import pytest

from tests.repository_tools import load_tool


def test_element_pages_are_current(monkeypatch) -> None:
    tool = load_tool("language_reference")
    monkeypatch.setattr("sys.argv", ["language_reference.py", "--check"])
    assert tool.main() == 0, "run tools/language_reference.py"


@pytest.mark.parametrize(
    ("page", "tags"),
    [
        ("urdf.md", ("robot", "link", "joint", "origin", "capsule", "color", "safety_controller")),
        ("sdf.md", ("world", "include", "sensor", "camera", "heightmap", "trajectory", "spherical_coordinates")),
    ],
)
def test_elements_have_one_section_each(page: str, tags: tuple[str, ...]) -> None:
    text = (load_tool("language_reference").FOLDER / page).read_text(encoding="utf-8")
    for tag in tags:
        assert text.count(f"## `<{tag}>`") == 1, tag


def test_elements_with_same_name_have_distinct_titles() -> None:
    text = (load_tool("language_reference").FOLDER / "sdf.md").read_text(encoding="utf-8")
    titles = [line for line in text.splitlines() if line.startswith("## ")]
    assert len(titles) == len(set(titles))
    assert "## `<contact>` in `<sensor>` {#sensor-contact}" in titles
