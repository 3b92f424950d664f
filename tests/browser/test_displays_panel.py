"""The Displays panel: adding, removing and moving displays, and undo."""

from __future__ import annotations

import pytest
import yaml

from linkwright.messages import get_message
from tests.browser.conftest import state, until
from tests.browser.live import configuration

pytestmark = pytest.mark.browser

String = get_message("std_msgs/msg/String")
PointStamped = get_message("geometry_msgs/msg/PointStamped")

_SILENT = """
- Class: rviz_default_plugins/PointStamped
  Enabled: true
  Name: Clicks
  Topic:
    Value: /clicked_point
"""


def display_names(page) -> list[str]:
    return [display["name"] for display in state(page, "displays")]


def locate_row(page, identity: str):
    return page.locator(f"[data-key='{identity}'] .row-title")


def saved_displays(viewer) -> list[dict]:
    return yaml.safe_load(viewer.viewer.config.text())["Visualization Manager"]["Displays"]


def test_display_added_by_type_can_be_undone(grouped_displays):
    viewer, page = grouped_displays
    locate_row(page, "display-2").click()
    page.keyboard.press("Alt+a")
    page.keyboard.type("points of a cloud")
    page.wait_for_selector(".choice-row")
    assert page.locator(".choice-row").all_inner_texts()[-1].startswith("PointCloud2")
    page.locator(".choice-row", has_text="PointCloud2").click()
    assert page.get_by_label("Display name").input_value() == "PointCloud2"
    page.get_by_label("Display name").fill("Cloud")
    page.keyboard.press("Enter")
    until(page, "lw.displays.length === 5")
    assert display_names(page) == ["Grid", "Marks", "Axes", "Radar", "Cloud"]
    page.wait_for_function("document.title.startsWith('● ')")
    assert saved_displays(viewer)[1]["Displays"][2]["Name"] == "Cloud"
    page.keyboard.press("Control+z")
    until(page, "lw.displays.length === 4")
    page.keyboard.press("Control+Shift+z")
    until(page, "lw.displays.length === 5")


def test_display_is_added_by_topic(grouped_displays):
    viewer, page = grouped_displays
    viewer.publish("/found", PointStamped())
    viewer.publish("/other/robot_description", String())
    page.get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("tab", name="By topic").click()
    description_topic = page.get_by_role("group", name="/other/robot_description")
    assert description_topic.get_by_role("option").first.inner_text().startswith("RobotModel")
    page.locator(".choice-row", has_text="PointStamped").click()
    page.get_by_role("dialog").get_by_role("button", name="Add", exact=True).click()
    until(page, "lw.displays.length === 5")
    assert saved_displays(viewer)[2]["Topic"]["Value"] == "/found"


def test_displays_are_renamed_duplicated_and_removed_by_keys(grouped_displays):
    viewer, page = grouped_displays
    locate_row(page, "display-3").click()
    page.keyboard.press("F2")
    page.keyboard.type("Origin")
    page.keyboard.press("Enter")
    until(page, "lw.displays[2].name === 'Origin'")
    page.keyboard.press("Alt+d")
    until(page, "lw.displays.length === 5")
    assert display_names(page) == ["Grid", "Marks", "Origin", "Origin", "Radar"]
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 4")
    locate_row(page, "display-2").click()
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 1")
    for _ in range(4):
        page.keyboard.press("Control+z")
    until(page, "lw.displays.length === 4 && lw.displays[2].name === 'Axes'")
    assert not viewer.viewer.manager.history.has_unsaved_edits


def test_display_keys_are_ignored_on_property_rows(grouped_displays):
    _, page = grouped_displays
    locate_row(page, "display-1").click()
    page.keyboard.press("ArrowRight")
    locate_row(page, "display-1/Alpha").click(position={"x": 30, "y": 8})
    page.keyboard.press("Delete")
    page.keyboard.press("Alt+d")
    locate_row(page, "display-3").click()
    page.keyboard.press("Delete")
    until(page, "lw.displays.length === 3")
    assert display_names(page) == ["Grid", "Marks", "Radar"]
    page.wait_for_function("() => document.activeElement?.matches('[role=treeitem]')")


def test_disabled_group_disables_its_displays(grouped_displays):
    _, page = grouped_displays
    page.locator("[data-key='display-2'] .check").click()
    until(page, "lw.displays.every((display) => display.enabled === (display.name === 'Grid'))")
    assert page.locator("[data-key='display-3'] .check").is_checked()
    page.locator("[data-key='display-2'] .check").click()
    until(page, "lw.displays.every((display) => display.enabled)")


def test_displays_are_reordered_by_drag_and_keys(grouped_displays):
    viewer, page = grouped_displays
    page.locator("[data-key='display-1'] .row-title").drag_to(page.locator("[data-key='display-2']"))
    until(page, "lw.displays[0].name === 'Marks'")
    assert [display["Name"] for display in saved_displays(viewer)[0]["Displays"]] == ["Grid", "Axes", "Radar"]
    locate_row(page, "display-1").click()
    page.keyboard.press("Alt+ArrowDown")
    until(page, "lw.displays[1].name === 'Axes'")
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    until(page, "lw.displays[0].name === 'Grid'")


def test_filter_finds_properties(grouped_displays):
    _, page = grouped_displays
    page.get_by_label("Filter displays and properties").fill("cell size")
    page.wait_for_function("() => document.querySelectorAll('.displays-panel .row').length === 2")
    assert page.locator(".displays-panel .row-title").all_inner_texts() == ["Grid", "Cell Size"]
    page.get_by_label("Filter displays and properties").fill("nothing like that")
    page.get_by_text("No name of a display or property contains this text.").wait_for()


def test_context_menu_renames_and_groups_display(grouped_displays):
    _, page = grouped_displays
    locate_row(page, "display-3").click(button="right")
    page.keyboard.press("r")
    assert "Rename" in page.evaluate("document.activeElement.textContent")
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.dataset.key") == "display-3"
    locate_row(page, "display-3").click(button="right")
    page.get_by_role("menuitem", name="Move to a new group").click()
    until(page, "lw.displays.length === 5")
    assert display_names(page) == ["Grid", "Marks", "Group", "Axes", "Radar"]


def test_reason_for_empty_display_is_shown_in_row_and_diagnostics(start_viewer, open_page):
    """The tooltip, the help below the list and the diagnostics show the reason.

    The diagnostics link to the row.
    """
    viewer = start_viewer(configuration(_SILENT))
    page = open_page(viewer, wait=False)
    reason = "Topic: No messages received: the topic has no publisher"
    card = page.locator(".diagnostic", has_text="Clicks")
    card.wait_for()
    assert reason in card.inner_text()
    assert page.get_by_text("No problems found.").is_hidden()
    assert page.locator("[data-key='display-1'] .row-title").get_attribute("title").splitlines() == ["Clicks", reason]
    page.evaluate("window.shownFirst = document.querySelector('.diagnostic .text-link')")
    viewer.run(lambda: viewer.node.create_publisher(PointStamped, "/clicked_point", 1))
    card.get_by_text("no message arrived yet").wait_for()
    assert page.evaluate("window.shownFirst.isConnected"), "the element to click is not replaced"
    reason = card.locator("li").inner_text()
    card.get_by_role("button", name="Clicks").click()
    page.locator(".help .trouble").wait_for()
    assert page.locator(".help .trouble").inner_text() == reason
    assert page.locator("[role=treeitem][aria-selected=true]").get_attribute("data-key") == "display-1"
    viewer.place("tip", 0.0, 0.0, 0.0)
    message = PointStamped()
    message.header.frame_id = "tip"
    viewer.publish("/clicked_point", message)
    page.get_by_text("No problems found.").wait_for()
    assert page.locator(".help .trouble").count() == 0
