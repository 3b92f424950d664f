"""The File menu, the displays of a single page, keyboard navigation and themes."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.rviz import RvizConfig
from tests.browser.conftest import state, until

pytestmark = pytest.mark.browser

ACTIVE = "document.activeElement"


@pytest.fixture(autouse=True)
def _user_state(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


def display_names(page) -> list[str]:
    return [display["name"] for display in state(page, "displays")]


def locate_row(page, identity: str):
    return page.locator(f"[data-key='{identity}'] .row-title")


def test_configuration_file_is_saved_and_opened(grouped_displays, tmp_path: Path):
    _, page = grouped_displays
    path = tmp_path / "mine.rviz"
    page.keyboard.press("Control+s")  # the configuration has no file yet
    page.get_by_label("File name").fill(str(path))
    page.keyboard.press("Enter")
    page.wait_for_function("() => document.querySelector('.file-name').textContent === 'mine.rviz'")
    assert len(list(RvizConfig.load(path).walk())) == 4
    locate_row(page, "display-1").click()
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 3")
    # The page asks before it discards unsaved changes.
    page.get_by_role("button", name="File", exact=True).click()
    page.keyboard.press("Enter")
    dialog = page.get_by_role("dialog", name="Unsaved changes")
    dialog.get_by_role("button", name="Cancel").click()
    assert len(display_names(page)) == 3
    page.get_by_role("button", name="File", exact=True).click()
    page.get_by_role("menuitem", name="New", exact=True).click()
    dialog.get_by_role("button", name="Save", exact=True).click()
    until(page, "lw.displays.length === 1")
    assert len(list(RvizConfig.load(path).walk())) == 3
    page.keyboard.press("Control+o")
    page.get_by_label("File name").fill(str(path))
    page.keyboard.press("Enter")
    until(page, "lw.displays.length === 3")
    page.get_by_role("button", name="File", exact=True).click()
    assert page.get_by_role("menuitem", name="mine.rviz").get_attribute("title") == str(path)


def test_configuration_file_is_downloaded_and_uploaded(grouped_displays, tmp_path: Path):
    viewer, page = grouped_displays
    text = viewer.viewer.config.text()
    with page.expect_download() as downloads:
        page.get_by_role("button", name="File", exact=True).click()
        page.get_by_role("menuitem", name="Download").click()
    path = tmp_path / "down.rviz"
    downloads.value.save_as(path)
    assert (downloads.value.suggested_filename, path.read_text()) == ("untitled.rviz", text)
    path.write_text(text.replace("Name: Radar", "Name: Sonar"))
    with page.expect_file_chooser() as choosers:
        page.get_by_role("button", name="File", exact=True).click()
        page.get_by_role("menuitem", name="Open from this computer").click()
    choosers.value.set_files(path)
    until(page, "lw.displays[3].name === 'Sonar'")


def test_page_can_use_its_own_displays(grouped_displays, open_page):
    viewer, page = grouped_displays
    other_page = open_page(viewer, wait=False)
    other_page.wait_for_selector("[data-key='display-4']")
    other_page.get_by_role("button", name="Own", exact=True).click()
    other_page.wait_for_url("**displays=own**")
    other_page.wait_for_selector("[data-key='display-8']")
    locate_row(other_page, "display-5").click()
    other_page.keyboard.press("Delete")
    until(other_page, "lw.displays.length === 3")
    assert len(display_names(page)) == 4
    other_page.reload()
    other_page.wait_for_selector("[data-key='display-8']")
    assert len(display_names(other_page)) == 3
    other_page.get_by_role("button", name="Shared", exact=True).click()
    other_page.wait_for_selector("[data-key='display-1']")
    assert len(display_names(other_page)) == 4


def test_keyboard_reaches_all_controls_and_dialogs_trap_focus(grouped_displays):
    _, page = grouped_displays
    focused = set()
    page.locator("body").click(position={"x": 640, "y": 8})
    for _ in range(40):
        page.keyboard.press("Tab")
        focused.add(page.evaluate(f"({ACTIVE}.getAttribute('aria-label') || {ACTIVE}.textContent).trim()"))
    assert {"File", "Panels", "Add", "Filter displays and properties"} <= focused
    page.get_by_role("button", name="File", exact=True).focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowDown")
    assert page.evaluate("document.activeElement.getAttribute('role')") == "menuitemcheckbox"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.textContent") == "Panels"
    page.get_by_role("button", name="Add", exact=True).click()
    for _ in range(13):
        page.keyboard.press("Tab")
        assert page.evaluate(f"{ACTIVE}.closest('.add-dialog') !== null")
    page.keyboard.press("Shift+Tab")
    assert page.evaluate(f"{ACTIVE}.closest('.add-dialog') !== null")
    page.keyboard.press("Escape")
    page.wait_for_selector(".add-dialog", state="detached")


def test_theme_choice_is_remembered(grouped_displays):
    _, page = grouped_displays
    page.emulate_media(color_scheme="dark")
    page.wait_for_function("() => document.documentElement.dataset.theme === 'dark'")
    background = "getComputedStyle(document.body).backgroundColor"
    dark_background = page.evaluate(background)
    page.get_by_role("button", name="Colors").click()
    page.get_by_role("menuitemcheckbox", name="Light").click()
    assert page.evaluate(background) != dark_background
    page.reload()
    page.wait_for_selector("[data-key='display-4']")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
