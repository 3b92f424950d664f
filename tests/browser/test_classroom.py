"""The classroom in the page.

A learner solves two steps, in both languages, with mouse and keyboard.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from playwright.sync_api import expect

from linkwright.learning.course import find_course
from tests.browser.axe import find_violations
from tests.browser.conftest import until, wait_until_equal

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals"),
]

ROBOT = find_course("example") / "01-one-link/solution/one-link/robot.urdf"
CHECKS = "lw.panels.lesson.checks"
WORDS = {
    "en": {
        "next": "Next step",
        "hint": "Hint 1 of 2",
        "box": "A box",
        "solution": "Solution",
        "right": "The answer is 12.5 kg.",
    },
    "zh": {"next": "下一步", "hint": "提示 1/2", "box": "一个方块", "solution": "答案", "right": "答案是 12.5 kg。"},
}


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SHELL", "/bin/bash")
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path / "ws"


def open_classroom(start, open_page, workspace: Path, **options):
    page = open_page(start("learn", str(workspace), "--course", "example"), wait=False, **options)
    until(page, f"{CHECKS}?.checked_at && !{CHECKS}.is_running")
    return page


def is_passed(step: str) -> str:
    return (
        f"lw.panels.lesson.step === '01-one-link/{step}' && {CHECKS}?.checks.length > 0 && "
        f"{CHECKS}.checks.every(check => check.is_passed)"
    )


def test_ctrl_s_saves_source_from_any_focus(start, open_page, workspace):
    page = open_classroom(start, open_page, workspace)
    page.get_by_role("button", name="robot.urdf").click()
    until(page, "lw.panels.source.editor?.file?.endsWith('robot.urdf')")
    for selector in (".lesson-body", ".canvas-box", ".file-tree-list"):
        page.locator(".cm-content").click()
        page.keyboard.insert_text("<!-- -->")
        until(page, "lw.panels.source.editor.unsaved.length === 1")
        page.locator(selector).click()
        page.keyboard.press("Control+s")
        until(page, "lw.panels.source.editor.unsaved.length === 0")
        page.keyboard.press("Control+s")  # saving again opens no dialog
        assert page.locator("dialog").count() == 0
    page.locator(".dv-tab", has_text="Displays").click()
    page.locator(".displays-panel [role=treeitem]").first.click()
    page.keyboard.press("Control+s")
    page.get_by_role("dialog", name="Save the configuration as").wait_for()


@pytest.mark.parametrize("language", ["en", "zh"])
def test_learner_completes_two_steps(start, open_page, workspace, language):
    texts = WORDS[language]
    page = open_classroom(start, open_page, workspace)
    if language == "zh":
        page.get_by_role("button", name="中文").click()
        page.wait_for_selector("text=一个方块")
    assert page.locator(".lesson-body h2").inner_text() == texts["box"]
    until(page, f"{CHECKS}?.checks.some(check => !check.is_passed)")
    page.get_by_role("button", name=texts["hint"]).click()
    page.wait_for_selector(".lesson-hint")
    page.get_by_role("button", name="robot.urdf").click()
    until(page, "lw.panels.source.editor?.file?.endsWith('robot.urdf')")
    page.locator(".cm-content").click()
    page.keyboard.press("Control+s")
    page.keyboard.insert_text(ROBOT.read_text())
    assert not (workspace / "robot.urdf").exists()
    page.keyboard.press("Control+s")
    until(page, is_passed("one-link"))
    until(page, "lw.ready && lw.robots?.length !== 0")
    page.get_by_role("button", name=texts["next"]).last.click()
    until(page, "lw.panels.lesson.step === '01-one-link/mass'")
    page.locator(".lesson-foot button", has_text=texts["solution"]).click()
    page.locator("dialog button", has_text=texts["solution"]).click()
    page.wait_for_selector(f".lesson-hint:has-text('{texts['right']}')")
    page.locator(".lesson-answer").fill("12.5")
    page.locator(".lesson-answer").press("Enter")
    until(page, is_passed("mass"))
    page.keyboard.press("Alt+PageUp")
    until(page, "lw.panels.lesson.step === '01-one-link/one-link'")
    assert "hints: 1" in (workspace / "learn.yaml").read_text()


def test_solution_is_applied_after_confirmation(start, open_page, workspace):
    page = open_classroom(start, open_page, workspace)
    page.get_by_role("button", name="Solution").click()
    wait_until_equal(page.locator("dialog li").all_inner_texts, ["robot.urdf"])
    page.get_by_role("button", name="Take the solution").click()
    until(page, is_passed("one-link"))
    assert (workspace / "robot.urdf").read_text() == ROBOT.read_text()


def test_catch_up_on_later_step_applies_solution_and_keeps_backup(start, open_page, workspace):
    workspace.mkdir()
    (workspace / "robot.urdf").write_text("mine")
    page = open_classroom(start, open_page, workspace)
    assert page.locator(".checks-offer").is_hidden()
    page.keyboard.press("Alt+PageDown")
    page.get_by_role("button", name="Catch up").click()
    wait_until_equal(page.locator("dialog li").all_inner_texts, ["robot.urdf"])
    page.get_by_role("button", name="Take over").click()
    page.locator(".checks-offer").wait_for(state="hidden")
    wait_until_equal((workspace / "robot.urdf").read_text, ROBOT.read_text())
    (backup,) = (workspace / "replaced").rglob("robot.urdf")
    assert backup.read_text() == "mine"
    page.get_by_role("button", name="Steps").click()
    page.locator(".outline-step[title*='solution copied']").wait_for()


def test_terminal_commands_are_checked(start, open_page, workspace):
    page = open_classroom(start, open_page, workspace)
    until(page, "/[$#] *$/.test(lw.panels.terminal.text ?? '')")
    page.locator(".terminal-screen:visible .xterm-helper-textarea").focus()
    page.keyboard.type(f"cp {ROBOT} .\n")
    until(page, is_passed("one-link"))
    page.keyboard.press("Alt+PageDown")
    until(page, "lw.panels.lesson.step === '01-one-link/mass'")


def test_file_created_by_another_program_is_shown(start, open_page, workspace):
    page = open_classroom(start, open_page, workspace)
    page.get_by_role("button", name="robot.urdf").click()
    page.wait_for_selector(".editor-notice:has-text('does not exist yet')")
    shutil.copy(ROBOT, workspace)
    until(page, "lw.panels.source.editor.text.includes('<robot') && lw.panels.source.editor.unsaved.length === 0")
    page.locator(".editor-notice").wait_for(state="hidden")


def test_exercise_opens_program_of_learner(start, open_page, tmp_path):
    program = tmp_path / "park.py"
    page = open_page(start("learn", "world", "park", str(program)), wait=False)
    until(page, "lw.panels.source.editor?.text?.includes('rclpy') && lw.panels.source.editor.file.endsWith('park.py')")
    page.locator(".editor-notice").wait_for(state="hidden")
    assert page.locator(".editor-pane .cm-editor").count() == 1
    assert page.evaluate("window.linkwright.panels.source.editor.file") == str(program)


def test_lesson_texts_fit_and_only_commands_have_copy_button(start, open_page, workspace):
    page = open_page(start("learn", str(workspace)), wait=False, size=(1024, 700))
    until(page, f"{CHECKS}?.checked_at")
    assert page.locator(".source-heading").first.is_hidden()
    position = page.locator(".lesson-place")
    assert "0 of 86 steps passed" in position.inner_text()
    assert position.evaluate("element => element.scrollWidth <= element.clientWidth")
    page.get_by_role("button", name="Steps").click()
    page.locator(".outline-step", has_text="A package for nodes").click()
    until(page, "lw.panels.lesson.step === '05-nodes/package'")
    output = page.locator(".lesson-code", has=page.locator("code.language-text"))
    expect(output).to_have_count(1)
    assert output.locator("button").count() == 0
    assert page.locator(".lesson-code", has=page.locator("code.language-bash")).first.locator("button").count() == 1
    page.get_by_role("button", name="中文").click()
    page.get_by_role("button", name="步骤").click()
    page.locator(".outline-step", has_text="发布").first.click()
    until(page, "lw.panels.lesson.step === '05-nodes/publish'")
    page.locator(".lesson-body h2", has_text="发布速度").wait_for()
    tops = page.evaluate(
        """() => document.querySelectorAll('.lesson-text').forEach(text => (text.style.width = '288px')) ??
        [...document.querySelectorAll('.lesson-text p > code')].filter(
            code => /^[：，。；、]/.test(code.nextSibling?.textContent ?? '')
        ).map(code => {
            const mark = document.createRange();
            mark.setStart(code.nextSibling, 0);
            mark.setEnd(code.nextSibling, 1);
            return mark.getBoundingClientRect().bottom - [...code.getClientRects()].at(-1).bottom;
        })"""
    )
    assert tops
    assert all(abs(top) < 8 for top in tops), "punctuation is on the same line as the code before it"


DIVIDED_WORDS = r"""() => {
  const box = document.querySelector(".lesson-table");
  const linesOf = (node, start, end) => {
    const range = document.createRange();
    range.setStart(node, start);
    range.setEnd(node, end);
    return new Set([...range.getClientRects()].map(({ bottom }) => Math.round(bottom))).size;
  };
  const divided = [];
  const texts = document.createTreeWalker(box, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode;
    for (const { 0: word, index } of node.textContent.matchAll(/[\w'.:-]+|[\u4e00-\u9fff]{2,3}(?![\u4e00-\u9fff])/g)) {
      const isWhole = /\w/.test(word) || node.textContent === word;
      if (isWhole && linesOf(node, index, index + word.length) > 1) divided.push(word);
    }
  }
  return divided;
}"""
"""Return the words of a table that are broken into two lines, including words of two or three Chinese characters."""


@pytest.mark.parametrize("title", ["Decide without a robot", "Another camera"])
def test_tables_keep_words_whole_and_scroll_in_their_own_box(start, open_page, workspace, title):
    page = open_page(start("learn", str(workspace)), wait=False, size=(1440, 900))
    until(page, f"{CHECKS}?.checked_at")
    page.get_by_role("button", name="Steps").click()
    page.locator(".outline-step", has_text=title).click()
    for width in (1440, 1024):
        page.set_viewport_size({"width": width, "height": 768})
        for button, name in (("中文", "表格"), ("EN", "Table")):
            page.get_by_role("button", name=button).click()
            page.get_by_role("group", name=name).wait_for()
            assert page.evaluate(DIVIDED_WORDS) == [], (width, button)
            assert page.locator(".lesson-body").evaluate("body => body.scrollWidth <= body.clientWidth")
    assert find_violations(page) == []
    table = page.get_by_role("group", name="Table")
    table.evaluate("box => (box.style.width = '200px')")
    table.focus()
    page.keyboard.press("ArrowRight")
    wait_until_equal(lambda: table.evaluate("box => box.scrollLeft > 0"), True)


def test_classroom_fits_small_screen_and_passes_axe(start, open_page, workspace):
    workspace.mkdir()
    shutil.copy(ROBOT, workspace)
    page = open_classroom(start, open_page, workspace, size=(1024, 700))
    for selector in (".lesson-body", ".checks-list", ".terminal-place", ".source-panel", ".canvas-box"):
        box = page.locator(selector).bounding_box()
        assert box is not None, selector
        assert box["width"] >= 200, selector
        assert box["x"] + box["width"] <= 1024, selector
    page.get_by_role("button", name="Steps").click()
    wait_until_equal(lambda: page.locator(".outline-step").count(), 2)
    page.locator(".outline-step").last.click()
    until(page, "lw.panels.lesson.step === '01-one-link/mass'")
    assert find_violations(page) == []
