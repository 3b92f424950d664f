"""Generated tables on pages are current."""

from __future__ import annotations

import re

import pytest

from linkwright.cli import main
from linkwright.cli.command import collect_help_texts
from tests.docs.pages import DOCS
from tests.repository_tools import load_tool
from tests.toml_files import EXTRAS, TOGETHER


@pytest.fixture(scope="module")
def tool():
    return load_tool("page_tables")


def test_tables_are_current(tool) -> None:
    assert tool.main(["--check"]) == 0, "run tools/page_tables.py"


def test_stale_table_is_found_and_fixed(tool, tmp_path, monkeypatch) -> None:
    page = tmp_path / "index.md"
    page.write_text("before\n<!-- table: extras -->\nold\n<!-- end of table -->\nafter\n", encoding="utf-8")
    monkeypatch.setattr(tool, "PAGES", (page,))
    assert tool.main(["--check"]) == 1
    assert tool.main([]) == 0
    assert tool.main(["--check"]) == 0
    text = page.read_text(encoding="utf-8")
    assert "old" not in text
    assert text.startswith("before\n")
    assert text.endswith("\nafter\n")


@pytest.mark.parametrize("folder", ["", "zh"])
def test_index_lists_all_commands(folder) -> None:
    page = (DOCS / folder / "index.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| \[`linkwright (\w+)`\]", page, re.MULTILINE) == list(collect_help_texts())


def test_extras_have_purpose_and_packages(tool) -> None:
    assert set(tool.EXTRAS) == set(EXTRAS)
    table = tool.extras(chinese=False)
    assert {
        name for name in EXTRAS if re.search(rf"`{name}` \| .*; not in `all` \|", table)
    } == EXTRAS.keys() - TOGETHER
    for name, extra in tool.EXTRAS.items():
        assert any(required.name == extra.main for required in tool._iterate_requirements(name)), name


def test_systems_table_marks_missing_dds_wheels(tool) -> None:
    rows = dict(line.strip("| ").split(" | ", 1) for line in tool.systems(chinese=False).splitlines())
    assert rows["`dds`"] == "3.10–3.13 | – | 3.10–3.13 | – | 3.10–3.13"
    assert "`zenoh`" not in rows


def test_gallery_robots_have_title_and_image(tool) -> None:
    folder = DOCS / "gallery"
    assert {path.stem for path in folder.glob("*.xacro")} == {*tool.ROBOTS, "parts"}
    assert {path.stem for path in folder.glob("*.webp")} == set(tool.ROBOTS)


def test_gallery_robots_have_no_findings(capsys) -> None:
    assert main(["check", "--strict", str(DOCS / "gallery")]) == 0
    assert "0 errors, 0 warnings" in "".join(capsys.readouterr())
