"""The page in windows of many sizes, and several displays at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.conftest import state, until
from tests.browser.live import LiveViewer, configuration

pytestmark = pytest.mark.browser

DISPLAYS = """
- {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}
- {Class: rviz_default_plugins/Axes, Name: Axes, Enabled: true}
- {Class: rviz_default_plugins/Image, Name: Front, Enabled: true, Topic: {Value: /front}}
- {Class: rviz_default_plugins/Image, Name: Back, Enabled: true, Topic: {Value: /back}}
- {Class: rviz_default_plugins/TF, Name: TF, Enabled: true}
"""


@pytest.fixture
def sized(browser: Browser, live: Callable[..., LiveViewer]) -> Iterator[Callable[[int, int], Page]]:
    """A function that opens a page in a window of some size, for the first time."""
    viewer = live(configuration(DISPLAYS))
    contexts = []

    def open_window(width: int, height: int) -> Page:
        context = browser.new_context(viewport={"width": width, "height": height}, locale="en-US")
        contexts.append(context)
        page = context.new_page()
        page.goto(viewer.url)
        until(page, "lw.displays.length === 5")
        page.wait_for_selector(".display-panel-host")
        return page

    yield open_window
    for context in contexts:
        context.close()


def box(page: Page, selector: str) -> dict[str, float]:
    found = page.locator(selector).first.bounding_box()
    assert found is not None, selector
    return found


def test_on_a_phone_the_scene_is_above_everything_else(sized):
    page = sized(500, 800)
    canvas = box(page, ".canvas-box")
    assert canvas["width"] == 500
    assert canvas["height"] > 300
    page.locator(".dv-tab", has_text="Displays").first.dispatch_event("pointerdown")
    page.wait_for_selector(".displays-panel")
    panel = box(page, ".displays-panel")
    assert panel["width"] == 500
    assert panel["y"] > canvas["y"] + canvas["height"]


@pytest.mark.parametrize(("width", "height"), [(900, 600), (1280, 800)])
def test_every_panel_that_is_open_has_room(sized, width, height):
    page = sized(width, height)
    page.wait_for_function("() => document.querySelector('.time-panel').offsetHeight < 45")
    assert box(page, ".canvas-box")["width"] > width / 3
    tree = box(page, ".displays-panel .tree")
    assert tree["height"] > 100
    assert box(page, ".time-panel")["height"] > 25
    reset = box(page, ".time-panel button:last-child")
    assert reset["x"] + reset["width"] <= width


def test_several_displays_are_selected_duplicated_removed_and_brought_back(sized):
    page = sized(1280, 800)

    def row(name: str) -> Any:
        return page.locator(".row.strong", has_text=name).first

    def selected() -> list[str]:
        return page.locator(".displays-panel .row.selected .row-title").all_inner_texts()

    def names() -> list[str]:
        return [each["name"] for each in state(page, "displays")]

    at = {"x": 60, "y": 8}
    row("Axes").click(position=at)
    row("TF").click(position=at, modifiers=["Shift"])
    assert selected() == ["Axes", "Front", "Back", "TF"]
    row("Front").click(position=at, modifiers=["Control"])
    row("Back").click(position=at, modifiers=["Control"])
    assert selected() == ["Axes", "TF"]
    page.keyboard.press("Alt+d")
    until(page, "lw.displays.length === 7")
    assert names() == ["Grid", "Axes", "Axes", "Front", "Back", "TF", "TF"]
    row("Grid").click(position=at)
    assert selected() == ["Grid"]
    page.keyboard.press("Shift+ArrowDown")
    assert selected() == ["Grid", "Axes"]
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 5")
    assert names() == ["Axes", "Front", "Back", "TF", "TF"]
    page.keyboard.press("Control+z")
    until(page, "lw.displays.length === 7")
    assert names() == ["Grid", "Axes", "Axes", "Front", "Back", "TF", "TF"]
