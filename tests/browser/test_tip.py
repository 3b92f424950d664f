"""Dragging of the tip of a chain, with handles in the scene and with the keyboard."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.browser.arm import write_arm
from tests.browser.axe import find_violations
from tests.browser.conftest import state, until, wait_until_equal

pytestmark = pytest.mark.browser


@pytest.fixture
def page(start, open_page, tmp_path: Path):
    """Return the page of an arm that is bent, seen from its side, with the tip switched on."""
    page = open_page(start("view", str(write_arm(tmp_path))))
    for name, value in (("Yaw", "-1.5707963"), ("Pitch", "0"), ("Distance", "3")):
        row = page.locator(".row").filter(has=page.get_by_text(name, exact=True))
        row.locator("input").first.fill(value)
        row.locator("input").first.press("Enter")
    for joint in ("upper_joint", "fore_joint"):
        field = page.locator(f'[data-joint="{joint}"] input[type=text]')
        field.fill("0.6")
        field.press("Enter")
    until(page, "lw.joints.upper_joint === 0.6 && lw.joints.fore_joint === 0.6")
    page.get_by_role("button", name="Drag the tip").click()
    return page


def select(page, link: str) -> None:
    """Select a link in the tree of links."""
    page.get_by_role("treeitem").filter(has_text="Links").last.locator(".row-name").dblclick()
    page.get_by_role("treeitem").filter(has_text=link).first.locator(".row-name").click()
    until(page, f"lw.frames.{link} !== undefined")
    page.get_by_label("The link that stays in place").wait_for()
    until(page, "lw.panels.tip.x !== undefined && lw.settled")


def drag(page, handle: str, x: float, y: float) -> None:
    """Drag a handle by pixels."""
    canvas = page.locator("canvas").first.bounding_box()
    place = state(page, f"panels.tip.{handle}")
    start_x, start_y = canvas["x"] + place["x"], canvas["y"] + place["y"]
    page.mouse.move(start_x, start_y)
    until(page, "lw.tool.cursor === 'grab'")
    page.mouse.down()
    for step in range(1, 11):
        page.mouse.move(start_x + x * step / 10, start_y + y * step / 10)
    page.mouse.up()


def position(page, link: str) -> list[float]:
    """Return the place of a link's frame."""
    return state(page, f"frames.{link}.position")


def test_handle_moves_the_chain_and_publishes_joint_states(page):
    page.get_by_text("Select a link in the scene or in Links.").wait_for()
    select(page, "slide")
    before = position(page, "slide")
    drag(page, "x", 0, 60)  # the x axis of the link points down to the right
    until(page, f"lw.frames.slide.position[2] < {before[2] - 0.03}")
    until(page, "lw.settled")
    joints = state(page, "joints")
    assert -2 <= joints["upper_joint"] <= 2
    assert -0.5 <= joints["fore_joint"] <= 2
    # A line of pixels in the direction of the arrow: the link goes along its own x axis.
    after = position(page, "slide")
    along = [math.cos(1.2), 0.0, -math.sin(1.2)]
    moved = [new - old for new, old in zip(after, before, strict=True)]
    distance = sum(a * b for a, b in zip(moved, along, strict=True))
    assert [m - distance * a for m, a in zip(moved, along, strict=True)] == pytest.approx([0, 0, 0], abs=2e-3)
    # The sliders follow, those of mimic joints included, and the positions are published.
    for name in ("upper_joint", "fore_joint", "slide_joint", "finger_joint"):
        slider = page.locator(f'.joint[data-joint="{name}"] input[type=range]')
        assert float(slider.input_value()) == pytest.approx(joints[name], abs=1e-3)
    assert joints["finger_joint"] == pytest.approx(0.01 - 0.5 * joints["slide_joint"])
    page.get_by_role("button", name="Panels", exact=True).click()
    page.get_by_role("menuitemcheckbox", name="Topics").click()
    page.get_by_role("button", name="Last message of /joint_states").click()
    page.get_by_role("button", name="position", exact=True).click()
    message = page.locator(".topic-message:visible")
    wait_until_equal(lambda: str(joints["upper_joint"])[:6] in message.inner_text(), True)


def test_target_out_of_reach_is_told_and_limits_hold(page):
    select(page, "slide")
    drag(page, "z", 300, -200)
    notice = page.locator(".tip-notice")
    notice.get_by_text("Out of reach: the tip is").wait_for()
    joints = state(page, "joints")
    assert -2 <= joints["upper_joint"] <= 2
    assert -0.5 <= joints["fore_joint"] <= 2
    assert -0.1 <= joints["slide_joint"] <= 0.2
    page.get_by_role("button", name="Drag the tip").click()
    notice.wait_for(state="hidden")


def test_keyboard_moves_the_tip_from_a_chosen_base(page):
    select(page, "fore")
    base = page.get_by_label("The link that stays in place")
    assert base.locator("option").all_inner_texts() == ["base", "upper"]
    base.select_option("upper")
    before = state(page, "joints")
    page.get_by_role("group", name="Turn", exact=True).get_by_role("button", name="y +").focus()
    page.keyboard.press("Enter")
    until(page, f"Math.abs(lw.joints.fore_joint - {before['fore_joint'] + math.radians(5)}) < 1e-3")
    assert state(page, "joints.upper_joint") == before["upper_joint"]
    assert find_violations(page, ".joints-panel") == []
    # Without a joint above the link, the panel says so.
    page.get_by_role("treeitem").filter(has_text="base").first.locator(".row-name").click()
    page.get_by_text("No joint above 'base' can be moved.").wait_for()
    assert base.is_hidden()
