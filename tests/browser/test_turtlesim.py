"""The TurtleSim panel: turtles and their lines on canvases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.browser.axe import find_violations
from tests.browser.conftest import Start, state, until

pytestmark = pytest.mark.browser

LAUNCH = """\
<launch>
  <node pkg="turtlesim" exec="turtlesim_node" name="sim" namespace="sea">
    <param name="background_r" value="10"/>
    <param name="background_g" value="100"/>
    <param name="background_b" value="60"/>
  </node>
</launch>
"""
BACKGROUND, PEN = "rgb(10, 100, 60)", [179, 184, 255]
CENTER = 499 / 90


def wait_for_line(page: Page, x: float, y: float, color: list[int]) -> None:
    """Wait until the line at a place of the first world, in units, has a color."""
    pixel = f"{round(45 * x)}, {round(499 - 45 * y)}, 1, 1"
    lines = "document.querySelector('.turtle-sea > canvas')?.getContext('2d')"
    until(page, f"{lines}?.getImageData({pixel}).data.join() === '{','.join(map(str, [*color, 255]))}'")


def find_offset(page: Page) -> tuple[float, float]:
    """Return the distance of the first turtle from the middle, to the right and down, in pixels of a world of 500."""
    sea, turtle = (page.locator(selector).first.bounding_box() for selector in (".turtle-sea", ".turtle"))
    scale = 500.0 / sea["width"]
    across = turtle["x"] + turtle["width"] / 2.0 - sea["x"] - sea["width"] / 2.0
    down = turtle["y"] + turtle["height"] / 2.0 - sea["y"] - sea["height"] / 2.0
    return across * scale, down * scale


def test_turtle_that_the_page_drives_draws_a_line_that_stays(
    start: Start, open_page: Callable[..., Page], tmp_path: Path
) -> None:
    (tmp_path / "sea.launch.xml").write_text(LAUNCH)
    page = open_page(start("launch", str(tmp_path / "sea.launch.xml")), wait=False)
    until(page, "lw.panels.turtlesim[0]?.turtles?.length === 1")
    assert state(page, "panels.turtlesim")[0]["name"] == "/sea/sim"
    until(page, f"getComputedStyle(document.querySelector('.turtle-sea')).backgroundColor === '{BACKGROUND}'")
    assert page.locator(".panel-tab").all_inner_texts() == ["3D View", "TurtleSim", "Time"]
    assert find_offset(page) == pytest.approx((0.0, 0.0), abs=1.0), "the turtle is in the middle"

    page.get_by_role("button", name="turtle1").click()
    assert page.get_by_role("textbox", name="Topic", exact=True).input_value() == "/sea/turtle1/cmd_vel"
    until(page, "lw.panels.monitor.teleop.aim?.subscribers === 1")
    page.get_by_role("application").focus()
    page.keyboard.down("ArrowUp")
    until(page, f"lw.panels.turtlesim[0].turtles[0].x > {CENTER} + 1.5")
    page.keyboard.up("ArrowUp")
    wait_for_line(page, CENTER + 0.5, CENTER, PEN)
    page.reload()
    wait_for_line(page, CENTER + 0.5, CENTER, PEN)
    page.locator(".turtle").wait_for()
    across, down = find_offset(page)
    assert across > 60.0
    assert down == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_each_node_has_its_world(start: Start, open_page: Callable[..., Page], theme: str) -> None:
    page = open_page(start("launch", "turtlesim", "multisim.launch.py"), wait=False, theme=theme)
    until(page, "lw.panels.turtlesim.filter(({ turtles }) => turtles?.length === 1).length === 2")
    names = [world["name"] for world in state(page, "panels.turtlesim")]
    assert names == ["/turtlesim1/turtlesim", "/turtlesim2/turtlesim"]
    boxes = [world.bounding_box() for world in page.locator(".turtle-sea").all()]
    assert [round(box["width"] / box["height"], 2) for box in boxes] == [1.0, 1.0]
    assert boxes[0]["x"] + boxes[0]["width"] < boxes[1]["x"]
    assert boxes[0]["width"] > 400
    assert page.get_by_role("img", name="/turtlesim2/turtlesim: turtle1").is_visible()
    assert find_violations(page, ".turtlesim-panel") == []


def test_turtles_take_the_place_of_the_scene_on_a_phone(start: Start, open_page: Callable[..., Page]) -> None:
    page = open_page(start("run", "turtlesim", "turtlesim_node"), wait=False, size=(400, 800))
    page.locator(".turtle-sea").wait_for()
    until(page, "document.querySelector('.turtle-sea').clientWidth > 340")
