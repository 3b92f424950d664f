"""The page in windows of many sizes, and selections of several displays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import get_message
from tests.browser.conftest import TIMEOUT_S, state, until, wait_until_equal
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
def open_window_of_size(browser: Browser, start_viewer: Callable[..., LiveViewer]) -> Iterator[Callable[..., Page]]:
    """Return a function that opens a page in a window of some size, as on the first visit."""
    viewer = start_viewer(configuration(DISPLAYS))
    contexts = []

    def open_window(width: int, height: int, locale: str = "en-US") -> Page:
        context = browser.new_context(viewport={"width": width, "height": height}, locale=locale)
        context.set_default_timeout(1000 * TIMEOUT_S)
        contexts.append(context)
        page = context.new_page()
        page.goto(viewer.url)
        until(page, "lw.displays.length === 5")
        page.locator(".dv-tab", has_text="Back").wait_for(state="attached")
        until(page, "lw.settled")
        return page

    yield open_window
    for context in contexts:
        context.close()


RECTANGLE = """([selector, part, text]) => {
  const hasText = (element) => element.textContent.includes(text);
  const has = (element) => part === null || [...element.querySelectorAll(part)].some(hasText);
  const found = [...document.querySelectorAll(selector)].find((element) => element.checkVisibility() && has(element));
  const { x, y, width, height } = found?.getBoundingClientRect() ?? {};
  return width > 0 ? { x, y, width, height } : null;
}"""
"""Find and measure an element in one call, because a resized window creates all elements again."""


def visible_box(page: Page, selector: str, *, part_selector: str | None = None, text: str = "") -> dict[str, float]:
    """Return the box of the first visible element.

    With a text, the element has a part that contains the text.
    """
    rectangle: dict[str, float] = page.wait_for_function(RECTANGLE, arg=[selector, part_selector, text]).json_value()
    return rectangle


def group_box(page: Page, name: str) -> dict[str, float]:
    """Return the box of the group with a panel's tab."""
    return visible_box(page, ".dv-groupview", part_selector=".panel-tab", text=name)


@pytest.mark.parametrize(("width", "height"), [(500, 800), (900, 700)])
def test_scene_is_above_panels_up_to_tablet_width(open_window_of_size, width, height):
    page = open_window_of_size(width, height)
    width_beside = group_box(page, "Front")["width"] if width >= 600 else 0
    wait_until_equal(lambda: visible_box(page, ".canvas-box")["width"] + width_beside, pytest.approx(width, abs=8))
    canvas = visible_box(page, ".canvas-box")
    assert canvas["height"] > 300
    page.locator(".dv-tab", has_text="Displays").first.dispatch_event("pointerdown")
    page.wait_for_selector(".displays-panel")
    wait_until_equal(lambda: visible_box(page, ".displays-panel")["width"], width)
    assert visible_box(page, ".displays-panel")["y"] > canvas["y"] + canvas["height"]


def test_images_are_beside_scene_in_wide_enough_window(open_window_of_size):
    page = open_window_of_size(800, 600)
    assert page.locator(".dv-tab[aria-selected=true]", has_text="Displays").count() == 1
    wait_until_equal(lambda: group_box(page, "Front") == group_box(page, "Back"), True)
    scene, images = visible_box(page, ".canvas-box"), group_box(page, "Front")
    assert scene["x"] + scene["width"] <= images["x"]
    assert scene["width"] > images["width"] > 300


def test_displays_tab_is_in_front_of_images_when_panels_share_space(open_window_of_size):
    page = open_window_of_size(500, 800)
    assert page.locator(".dv-tab[aria-selected=true]", has_text="Displays").count() == 1
    page.locator(".dv-tab", has_text="Front").dispatch_event("pointerdown")
    page.locator(".dv-tab[aria-selected=true]", has_text="Front").wait_for()


def test_displays_filter_does_not_overlap_tabs(open_window_of_size):
    page = open_window_of_size(800, 600)
    tabs, filter_ = (
        visible_box(page, ".dv-tab", text="Displays", part_selector=".panel-tab"),
        visible_box(page, ".displays-panel .search-box"),
    )
    assert filter_["y"] >= tabs["y"] + tabs["height"]
    assert filter_["y"] < visible_box(page, ".displays-panel .toolbar")["y"] + 30, "the filter is beside the buttons"


@pytest.mark.parametrize("width", [360, 390])
def test_title_bar_fits_phone(open_window_of_size, width):
    page = open_window_of_size(width, 844)
    edges = page.locator(".title-bar button:visible").evaluate_all(
        "elements => elements.map(element => element.getBoundingClientRect()).map(({ left, right }) => [left, right])"
    )
    assert len(edges) == 9
    assert all(start >= 0 and end <= width for start, end in edges), edges
    assert all(one[1] <= following[0] + 0.5 for one, following in pairwise(edges)), edges


def test_phone_view_fits_map_until_user_moves_camera(browser, start_viewer):
    displays = "- {Class: rviz_default_plugins/Map, Name: Map, Enabled: true, Topic: {Value: /map}}"
    above = configuration(displays).replace("rviz_default_plugins/Orbit", "rviz_default_plugins/TopDownOrtho")
    viewer = start_viewer(above.replace("Distance: 10.0", "Scale: 60"))
    grid = get_message("nav_msgs/msg/OccupancyGrid")()
    grid.header.frame_id = "base"
    grid.info.width = grid.info.height = 100
    grid.info.resolution, grid.info.origin.position.x, grid.info.origin.orientation.w = 0.1, 20.0, 1.0
    grid.data = [0] * 10_000
    viewer.publish("/map", grid, DESCRIPTION_QOS)
    with closing(browser.new_context(viewport={"width": 1280, "height": 800})) as context:
        page = context.new_page()
        page.goto(viewer.url)
        until(page, "lw.displays[0]?.drawn?.cells === 10000 && lw.settled")
        assert state(page, "view.values.Scale") == 60
        page.set_viewport_size({"width": 390, "height": 844})
        until(page, "lw.view.values.X === 25 && lw.view.values.Scale * 10 < 390")
        assert state(page, "view.values.Scale") * 10 > 250
        page.set_viewport_size({"width": 844, "height": 390})
        until(page, "lw.view.values.Scale * 10 < document.querySelector('.canvas-box canvas').clientHeight")
        fitted_scale = state(page, "view.values.Scale")
        page.locator(".canvas-box canvas").hover()
        page.mouse.wheel(0, -120)
        until(page, f"lw.view.values.Scale !== {fitted_scale}")
        scale = state(page, "view.values.Scale")
        page.set_viewport_size({"width": 390, "height": 844})
        viewer.settle(page)
        assert state(page, "view.values.Scale") == scale


@pytest.mark.parametrize(("width", "height"), [(1024, 600), (1280, 800)])
def test_open_panels_have_enough_space(open_window_of_size, width, height):
    page = open_window_of_size(width, height)
    foot = visible_box(page, ".foot")
    assert foot["height"] < 45, "the last minutes and the status share one line"
    canvas = visible_box(page, ".canvas-box")
    assert canvas["y"] + canvas["height"] > foot["y"] - 10, "the time fields are folded"
    page.get_by_role("button", name="Time", exact=True).click()
    page.wait_for_function("() => document.querySelector('.time-panel').offsetHeight < 45")

    def has_room() -> dict[str, bool]:
        reset = visible_box(page, ".time-panel button:last-child")
        return {
            "scene": visible_box(page, ".canvas-box")["width"] > width / 3,
            "tree": visible_box(page, ".displays-panel .tree")["height"] > 100,
            "time": visible_box(page, ".time-panel")["height"] > 25,
            "reset": reset["x"] + reset["width"] <= width,
        }

    wait_until_equal(has_room, dict.fromkeys(("scene", "tree", "time", "reset"), True))


@pytest.mark.parametrize(("width", "height"), [(844, 390), (667, 375), (932, 430)])
def test_panels_are_beside_scene_on_phone_in_landscape(open_window_of_size, width, height):
    page = open_window_of_size(width, height)
    canvas = visible_box(page, ".canvas-box")
    assert canvas["height"] > 0.65 * height
    assert 0.5 * width < canvas["width"] < 0.7 * width
    assert group_box(page, "Front") == group_box(page, "Displays") == group_box(page, "Views")
    displays = group_box(page, "Displays")
    assert displays["x"] >= canvas["x"] + canvas["width"]
    assert displays["x"] + displays["width"] <= width + 1
    page.set_viewport_size({"width": height, "height": width})
    wait_until_equal(lambda: visible_box(page, ".canvas-box")["width"], height)
    page.set_viewport_size({"width": width, "height": height})
    wait_until_equal(lambda: visible_box(page, ".canvas-box")["height"] > 0.65 * height, True)


def test_window_resized_narrow_and_wide_keeps_its_panels(open_window_of_size):
    page = open_window_of_size(1280, 800)
    page.get_by_role("button", name="Panels", exact=True).click()
    page.get_by_role("menuitemcheckbox", name="Topics", exact=True).click()
    wait_until_equal(lambda: group_box(page, "Topics")["y"] > visible_box(page, ".canvas-box")["y"] + 100, True)
    page.set_viewport_size({"width": 500, "height": 800})
    wait_until_equal(lambda: visible_box(page, ".canvas-box")["width"], 500)
    wait_until_equal(lambda: group_box(page, "Topics") == group_box(page, "Displays"), True)
    page.set_viewport_size({"width": 1280, "height": 800})
    wait_until_equal(lambda: group_box(page, "Topics")["x"] > group_box(page, "Displays")["x"], True)


def test_wide_text_panels_share_one_group(open_window_of_size):
    page = open_window_of_size(1280, 800)
    for name in ("Source", "Topics", "Diagram", "Log"):
        page.get_by_role("button", name="Panels", exact=True).click()
        page.get_by_role("menuitemcheckbox", name=name, exact=True).click()
    wait_until_equal(
        lambda: [group_box(page, name) for name in ("Topics", "Diagram", "Log")], [group_box(page, "Source")] * 3
    )
    assert page.locator(".dv-tab[aria-selected=true]", has_text="Log").count() == 1


def test_tabs_are_operable_by_keyboard(open_window_of_size):
    page = open_window_of_size(1280, 800)
    tabs = page.locator("[role=tablist]", has=page.locator(".dv-tab", has_text="Views")).get_by_role("tab")
    assert tabs.evaluate_all("elements => elements.map(element => element.tabIndex)").count(0) == 1
    focused_label = "() => document.activeElement.getAttribute('aria-label')"
    page.locator(".dv-tab", has_text="Views").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate(focused_label) == "Tool Properties"
    focus_ring = "() => getComputedStyle(document.activeElement).outlineStyle"
    assert page.evaluate(focus_ring) == "solid"
    page.keyboard.press("Enter")
    page.locator(".dv-tab[aria-selected=true]", has_text="Tool Properties").wait_for()
    page.keyboard.press("End")
    assert page.evaluate(focused_label) == "Selection"
    page.keyboard.press("Home")
    assert page.evaluate(focused_label) == "Views"
    page.keyboard.press("Delete")
    page.locator(".dv-tab", has_text="Views").wait_for(state="detached")
    assert page.evaluate(focused_label) == "Tool Properties"
    # The scene cannot be closed.
    page.locator(".dv-tab", has_text="3D View").focus()
    page.keyboard.press("Delete")
    page.locator(".canvas-box canvas").focus()
    yaw = state(page, "view.yaw")
    page.keyboard.press("ArrowLeft")
    until(page, f"lw.view.yaw !== {yaw}")


def test_multiple_displays_are_selected_duplicated_removed_and_restored(open_window_of_size):
    page = open_window_of_size(1280, 800)

    def row(name: str) -> Any:
        return page.locator(".row.strong", has_text=name).first

    def selected() -> list[str]:
        return page.locator(".displays-panel .row.selected .row-title").all_inner_texts()

    def names() -> list[str]:
        return [display["name"] for display in state(page, "displays")]

    click_position = {"x": 60, "y": 8}
    row("Axes").click(position=click_position)
    row("TF").click(position=click_position, modifiers=["Shift"])
    assert selected() == ["Axes", "Front", "Back", "TF"]
    row("Front").click(position=click_position, modifiers=["Control"])
    row("Back").click(position=click_position, modifiers=["Control"])
    assert selected() == ["Axes", "TF"]
    page.keyboard.press("Alt+d")
    until(page, "lw.displays.length === 7")
    assert names() == ["Grid", "Axes", "Axes", "Front", "Back", "TF", "TF"]
    row("Grid").click(position=click_position)
    assert selected() == ["Grid"]
    page.keyboard.press("Shift+ArrowDown")
    assert selected() == ["Grid", "Axes"]
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 5")
    assert names() == ["Axes", "Front", "Back", "TF", "TF"]
    page.keyboard.press("Control+z")
    until(page, "lw.displays.length === 7")
    assert names() == ["Grid", "Axes", "Axes", "Front", "Back", "TF", "TF"]


def test_tabs_beside_views_are_not_clipped_in_chinese(open_window_of_size):
    """At 1280 pixels, the third tab was clipped.

    Characters that no font has are drawn with the same width.
    """
    page = open_window_of_size(1280, 800, "zh-CN")
    page.evaluate(
        """() => {
          const title = document.querySelector(".tab-title");
          const glyph = title.getBoundingClientRect().width / title.textContent.length;
          const wide = new CSSStyleSheet();
          wide.replaceSync(`.tab-title { letter-spacing: ${Math.max(0, 12 - glyph)}px }`);
          document.adoptedStyleSheets = [wide];
        }"""
    )
    page.set_viewport_size({"width": 1281, "height": 800})
    group = page.locator(".dv-tabs-and-actions-container", has=page.locator(".dv-tab", has_text="视角"))
    tabs = group.locator(".dv-tab")

    def fit() -> tuple[int, bool, int]:
        last, bar = tabs.last.bounding_box(), group.bounding_box()
        assert last is not None
        assert bar is not None
        is_inside = last["x"] + last["width"] <= bar["x"] + bar["width"]
        return tabs.count(), is_inside, group.locator(".dv-tabs-overflow-dropdown-default").count()

    wait_until_equal(fit, (3, True, 0))


def test_tabs_beside_views_are_not_clipped_in_english(open_window_of_size):
    page = open_window_of_size(1280, 800)
    group = page.locator(".dv-tabs-and-actions-container", has=page.locator(".dv-tab", has_text="Views"))
    wait_until_equal(
        lambda: (group.locator(".dv-tab").count(), group.locator("[class*=overflow-dropdown]").count()), (3, 0)
    )


def test_view_type_label_stays_on_one_line_in_chinese(open_window_of_size):
    page = open_window_of_size(800, 600, "zh-CN")
    page.locator(".dv-tab", has_text="视角").click()
    label = page.locator(".view-type > .toolbar-label")
    wait_until_equal(
        lambda: label.evaluate("element => element.offsetHeight < 2 * parseFloat(getComputedStyle(element).fontSize)"),
        True,
    )
