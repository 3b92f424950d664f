"""The page of a program in a terminal of the classroom.

It opens beside the lesson, takes keys, and closes.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Frame, Page

from linkwright.learning.course import find_course
from tests.browser.axe import find_violations
from tests.browser.conftest import until, wait_until_equal
from tests.waiting import TIMEOUT_S

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals"),
]

ROBOT = find_course("example") / "01-one-link/solution/one-link/robot.urdf"
FRAMES = ".program-place iframe"
KEYS = ".terminal-screen:visible .xterm-helper-textarea"


@pytest.fixture
def page(start, open_page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Page:
    monkeypatch.setenv("SHELL", "/bin/bash")
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "ws").mkdir()
    shutil.copy(ROBOT, tmp_path / "ws")
    page = open_page(start("learn", str(tmp_path / "ws"), "--course", "example"), wait=False)
    until(page, "/[$#] *$/.test(lw.panels.terminal.text ?? '')")
    page.locator(KEYS).focus()
    return page


def wait_for_program_pages(page: Page) -> list[Frame]:
    """Wait for the pages of programs, and return their contents."""
    page.wait_for_selector(f"{FRAMES}:visible")
    frames = [frame for handle in page.locator(FRAMES).element_handles() if (frame := handle.content_frame())]
    for frame in frames:
        frame.wait_for_function("window.linkwright?.ready === true", timeout=1000 * TIMEOUT_S)
    return frames


def test_program_page_is_shown_until_program_ends(page):
    page.keyboard.type("linkwright view robot.urdf\n")
    (frame,) = wait_for_program_pages(page)
    assert page.locator(FRAMES).is_visible()
    assert page.evaluate("document.activeElement.className") == "xterm-helper-textarea"
    assert frame.evaluate("location.search") == ""  # the page has removed the token and the language from its address
    assert find_violations(page) == []
    frame.locator("canvas").first.click()
    page.keyboard.press("?")
    frame.wait_for_selector("dialog[open]")
    page.keyboard.press("Escape")
    frame.evaluate("window.isFirst = true")
    page.locator(".panel-tab", has_text="3D View").click()
    page.wait_for_selector(FRAMES, state="hidden")
    page.locator(".panel-tab", has_text="Program").click()
    page.wait_for_selector(FRAMES)
    assert frame.evaluate("window.isFirst"), "the page was not reloaded"
    page.locator(".title-bar .theme-button").click()
    page.get_by_role("menuitemcheckbox", name="Dark").click()
    (frame,) = wait_for_program_pages(page)
    frame.wait_for_selector("html[data-theme=dark]", state="attached")
    page.get_by_role("button", name="中文").click()  # reloads both pages
    page.wait_for_selector("text=程序")
    (frame,) = wait_for_program_pages(page)
    assert frame.get_by_role("button", name="在标签页中打开").is_visible()
    with page.expect_popup() as popup:
        frame.get_by_role("button", name="在标签页中打开").click()
    popup.value.wait_for_function("window.linkwright?.ready === true")
    popup.value.close()
    page.locator(KEYS).focus()
    page.keyboard.press("Control+c")
    page.wait_for_selector(FRAMES, state="detached")
    wait_until_equal(lambda: page.locator(".program-panel").count(), 0)
    until(page, "lw.ready && /[$#] *$/.test(lw.panels.terminal.text)")


def test_second_program_has_button_and_killed_one_is_removed(page):
    page.keyboard.type("linkwright view robot.urdf & linkwright view robot.urdf --no-open --port 0 & sleep 1\n")
    wait_for_program_pages(page)
    page.keyboard.type("linkwright view robot.urdf\n")
    buttons = page.locator(".program-tabs button")
    wait_until_equal(buttons.count, 2)
    wait_for_program_pages(page)
    assert [page.locator(FRAMES).nth(number).is_visible() for number in range(2)] == [False, True]
    buttons.first.click()
    assert [page.locator(FRAMES).nth(number).is_visible() for number in range(2)] == [True, False]
    page.locator(KEYS).focus()
    page.keyboard.press("Control+c")
    wait_until_equal(page.locator(FRAMES).count, 1)
    page.keyboard.type("kill -9 %1 %2\n")
    page.wait_for_selector(FRAMES, state="detached")
