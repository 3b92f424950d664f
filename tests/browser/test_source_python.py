"""Editing of Python files in the page with ty and ruff, if these are installed."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.lsp.python.programs import installed_programs
from tests.browser.conftest import until, wait_until_equal
from tests.browser.test_source_editor import (
    EDITOR,
    LEG,
    ROBOT,
    choose_menu_entry,
    move_cursor,
    open_editor,
    wait_for_text,
)

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(len(installed_programs()) < 2, reason="ty or ruff is not installed"),
]

WALKER = """\
import os
from gait import steps
from rclpy.node import Node


class Walker(Node):
    def __init__(self):
        super().__init__("行走😀"); self.count = steps(2.5)
"""
GAIT = "def steps(length: float) -> int:\n    return int(10 / length)\n"
MANIFEST = (
    '<package format="3"><name>leg_description</name><version>1.0.0</version><description>A leg.</description>'
    '<maintainer email="a@b.org">A</maintainer><license>MIT</license></package>\n'
)


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "leg_description"
    folder.mkdir()
    texts = {"package.xml": MANIFEST, "leg.xacro": LEG, "robot.urdf.xacro": ROBOT, "walker.py": WALKER, "gait.py": GAIT}
    texts["ruff.toml"] = '[lint]\nselect = ["F"]\n'
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def open_walker(page):
    """Open the Python file from the file tree."""
    text = open_editor(page)
    page.get_by_role("button", name="Files", exact=True).click()
    page.get_by_role("treeitem", name="walker.py").click()
    until(page, f"{EDITOR}.file.endsWith('walker.py')")
    return text


def hover_text(page, line: int, text: str) -> None:
    """Move the mouse over a text of a line."""
    find = """([line, text]) => {
        const walker = document.createTreeWalker(document.querySelectorAll(".cm-line")[line - 1], NodeFilter.SHOW_TEXT);
        let node = walker.nextNode();
        while (!node.data.includes(text)) node = walker.nextNode();
        const range = document.createRange();
        range.setStart(node, node.data.indexOf(text));
        range.setEnd(node, node.data.indexOf(text) + text.length);
        const box = range.getBoundingClientRect();
        return [box.left + box.width / 2, box.top + box.height / 2];
    }"""
    page.mouse.move(*page.evaluate(find, [line, text]))


def test_findings_hover_and_completion_follow_unsaved_text(start, open_page, package):
    page = open_page(start("view", str(package / "robot.urdf.xacro")))
    text = open_walker(page)
    until(page, f"{EDITOR}.findings.join() === 'F401'")  # no finding about the import of rclpy
    move_cursor(text, 8)
    text.press("End")
    page.keyboard.insert_text("\n        self.get_logger().")
    page.keyboard.type("inf", delay=20)
    option = page.locator(".cm-tooltip-autocomplete li").filter(has_text="info").first
    option.wait_for()
    option.click()
    page.keyboard.insert_text("(self.count.nothing)")
    until(
        page, f"{EDITOR}.findings.includes('unresolved-attribute') || {EDITOR}.findings.includes('missing-attribute')"
    )
    page.locator(".cm-lintRange-error").get_by_text("nothing").wait_for()
    text.press("Control+Home")
    hover_text(page, line=3, text="Node")
    page.locator(".cm-lsp-hover-tooltip").get_by_text("A node in the graph").wait_for()
    assert (package / "walker.py").read_text(encoding="utf-8") == WALKER


def test_finding_is_fixed_and_file_is_formatted(start, open_page, package):
    page = open_page(start("view", str(package / "robot.urdf.xacro")))
    text = open_walker(page)
    until(page, f"{EDITOR}.findings.join() === 'F401'")
    text.press("Control+Home")
    text.press("F8")
    text.press("Control+.")
    choose_menu_entry(page, "Ruff (F401): Remove unused import: `os`")
    until(page, f"{EDITOR}.findings.length === 0")
    text.press("Shift+Alt+F")
    wait_for_text(page, '("行走😀")\n        self.count')
    text.press("Control+s")
    formatted = WALKER.replace("import os\n", "").replace("; ", "\n        ")
    wait_until_equal(lambda: (package / "walker.py").read_text(encoding="utf-8"), formatted)


def test_symbol_is_renamed_in_all_files_and_definition_opens(start, open_page, package):
    page = open_page(start("view", str(package / "robot.urdf.xacro")))
    text = open_walker(page)
    until(page, f"{EDITOR}.findings.join() === 'F401'")
    move_cursor(text, 2, 19)  # in the name `steps`
    text.press("F12")
    until(page, f"{EDITOR}.file.endsWith('gait.py') && {EDITOR}.cursor === 1")
    move_cursor(text, 1, 5)
    text.press("F2")
    name = page.get_by_role("textbox", name="New name")
    wait_until_equal(name.input_value, "steps")
    name.fill("strides")
    name.press("Enter")
    preview = page.get_by_role("dialog", name="Rename steps to strides")
    preview.get_by_text("3 places in 2 files will change.").wait_for()
    preview.get_by_role("button", name="Rename", exact=True).click()
    page.get_by_text("Renamed to strides in 2 files, not saved yet").wait_for()
    page.get_by_role("button", name="Save 2 files").click()
    wait_until_equal((package / "gait.py").read_text, GAIT.replace("steps", "strides"))
    wait_until_equal(lambda: (package / "walker.py").read_text(encoding="utf-8"), WALKER.replace("steps", "strides"))
