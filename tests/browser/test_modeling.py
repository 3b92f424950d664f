"""Editing of a world in the page: additions and moves are saved in its file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.browser.conftest import until, wait_until_equal
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

YARD = """\
<?xml version="1.0"?>
<sdf version="1.9">
  <world name="yard">
    <gui><camera name="user"><pose>-3.5 -3.5 5 0 0.7903 0.785398</pose></camera></gui>
    <!-- A crate, and nothing else. -->
    <model name="crate">
      <pose>4 0 0.5 0 0 0</pose>
      <link name="link">
        <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
        <visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual>
      </link>
    </model>
  </world>
</sdf>
"""
BOUNDS = "lw.displays.find(({class: c}) => c === 'linkwright/World').drawn.links['box::link']?.visuals[0]?.bounds"


def open_modeling(start, open_page, tmp_path: Path):
    """Open the page of a world in modeling mode; return it with the world's file."""
    path = tmp_path / "yard.world"
    path.write_text(YARD)
    page = open_page(start("sim", str(path)))
    page.get_by_role("button", name="Model the world: the simulation is paused").click()
    page.get_by_role("option", name="crate").wait_for()
    return page, path


def add_box(page) -> None:
    """Add a box with the keyboard, in the center of the view."""
    page.get_by_role("button", name="Box", exact=True).press("Enter")
    page.get_by_role("option", name="box", selected=True).wait_for()


def locate_number(page, key: str):
    return page.locator(f"[data-key='{key}'] input")


def test_added_box_is_moved_undone_and_saved(start, open_page, tmp_path):
    page, path = open_modeling(start, open_page, tmp_path)
    bar = page.get_by_role("toolbar", name="Model the world")
    undo, redo, save = (bar.get_by_role("button", name=name) for name in ("Undo", "Redo", "Save the world"))
    assert undo.is_disabled()
    add_box(page)
    x = float(locate_number(page, "pose/0").input_value())
    locate_number(page, "pose/0").fill("1.5")
    locate_number(page, "pose/0").press("Enter")
    until(page, f"Math.abs({BOUNDS}?.min[0] - 1.25) < 1e-3")
    undo.click()
    wait_until_equal(lambda: float(locate_number(page, "pose/0").input_value()), x)
    redo.click()
    wait_until_equal(lambda: locate_number(page, "pose/0").input_value(), "1.5")
    assert redo.is_disabled()
    assert page.get_by_role("img", name="unsaved changes").is_visible()
    assert path.read_text() == YARD
    save.click()
    page.get_by_role("img", name="unsaved changes").wait_for(state="hidden")
    text = path.read_text()
    box_element = re.search(r'    <model name="box">.*?</model>\n', text, re.DOTALL)
    assert box_element is not None
    assert "<pose>1.5 " in box_element[0]
    assert text.replace(box_element[0], "") == YARD


def test_gizmo_moves_selection_and_keys_group_and_delete(start, open_page, tmp_path):
    page, path = open_modeling(start, open_page, tmp_path)
    page.get_by_role("button", name="Snap to the grid").click()
    add_box(page)
    locate_number(page, "pose/2").fill("0")  # the middle of the box is in the middle of the view
    locate_number(page, "pose/2").press("Enter")
    until(page, f"Math.abs({BOUNDS}?.min[2] + 0.25) < 1e-3")
    position = [locate_number(page, f"pose/{axis}").input_value() for axis in range(3)]
    box = page.locator(".canvas-box canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=4)
    page.mouse.up()
    wait_until(lambda: [locate_number(page, f"pose/{axis}").input_value() for axis in range(3)] != position)
    page.get_by_role("option", name="crate").click(modifiers=["Shift"])
    page.keyboard.press("Control+g")
    page.get_by_role("option", name="group", selected=True).wait_for()
    page.keyboard.press("Delete")
    page.get_by_role("option", name="group").wait_for(state="detached")
    page.keyboard.press("Control+s")
    wait_until(lambda: "<model" not in path.read_text())
    page.get_by_role("button", name="End modeling").click()
    page.get_by_role("toolbar", name="Model the world").wait_for(state="hidden")
