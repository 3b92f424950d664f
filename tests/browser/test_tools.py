"""Tools, selection and time with mouse and keyboard, and the messages that a node receives."""

from __future__ import annotations

import asyncio
import math

import pytest

from linkwright.messages import get_message
from tests.browser.arm_from_above import TIP, ArmPage, open_scene
from tests.browser.conftest import state, until, wait_two_seconds, wait_until_equal
from tests.waiting import wait_until

pytestmark = pytest.mark.browser


@pytest.fixture
def scene(start_viewer, open_page) -> ArmPage:
    return open_scene(start_viewer, open_page)


# --- tools -----------------------------------------------------------------------------------------------------------


def test_shortcut_keys_select_and_deselect_tools(scene):
    assert state(scene.page, "tool.class").endswith("/Interact")
    for key, tool in zip(
        "mcnpgu", ("MoveCamera", "FocusCamera", "Measure", "SetInitialPose", "SetGoal", "PublishPoint"), strict=True
    ):
        assert scene.press(key) == tool
    assert scene.press("u") == "Interact"
    assert scene.press("g") == "SetGoal"
    assert scene.press("Escape") == "Interact"
    assert scene.press("s") == "Select"
    assert scene.press("m") == "Select"  # the tool Select takes all keys, as in RViz
    assert scene.press("s") == "Interact"
    scene.page.get_by_role("button", name="Measure", exact=True).click()
    assert state(scene.page, "tool.class").endswith("/Measure")


def test_letters_typed_into_field_do_not_select_tools(scene):
    field = scene.page.get_by_role("treeitem").filter(has_text="Target Frame").locator("input")
    field.click()
    field.fill("")
    scene.page.keyboard.type("map")
    assert state(scene.page, "tool.class").endswith("/Interact")
    assert field.input_value() == "map"


def test_goal_pose_is_published_where_dragged(scene):
    scene.press("g")
    (x0, y0), (x1, y1) = scene.pixel(-2, 1), scene.pixel(-2, 3)
    scene.page.mouse.move(x0, y0)
    scene.page.mouse.down()
    scene.page.mouse.move(x0, y0 - 20)
    scene.page.mouse.move(x1, y1)
    wait_until_equal(lambda: state(scene.page, "tool.state")["arrows"], 1)
    scene.page.mouse.up()
    until(scene.page, "lw.tool.class.endsWith('/Interact')")
    goal = scene.single_message("/goal_pose")
    assert goal.header.frame_id == "base"
    assert goal.header.stamp.sec > 0
    assert (goal.pose.position.x, goal.pose.position.y, goal.pose.position.z) == pytest.approx((-2, 1, 0), abs=0.03)
    assert (goal.pose.orientation.z, goal.pose.orientation.w) == pytest.approx((math.sqrt(0.5),) * 2, abs=0.01)


def test_pose_estimate_uses_covariance_of_tool_properties(scene):
    scene.page.get_by_text("Tool Properties", exact=True).click()
    row = scene.page.get_by_role("treeitem").filter(has_text="Covariance yaw")
    row.locator("input").fill("0.5")
    row.locator("input").press("Enter")
    scene.press("p")
    scene.drag((2, -2), (1, -2))
    estimate = scene.single_message("/initialpose")
    pose = estimate.pose.pose
    assert (pose.position.x, pose.position.y) == pytest.approx((2, -2), abs=0.03)
    assert (abs(pose.orientation.z), pose.orientation.w) == pytest.approx((1, 0), abs=0.01)
    covariance = list(estimate.pose.covariance)
    assert (covariance[0], covariance[7], covariance[35]) == (0.25, 0.25, 0.5)
    pose_tool = next(tool for tool in scene.saved_settings()["Tools"] if tool["Class"].endswith("/SetInitialPose"))
    assert pose_tool["Covariance yaw"] == 0.5


def test_clicked_point_is_published_and_drawn(scene):
    scene.press("u")
    scene.page.mouse.move(*scene.pixel(-3, -3))
    wait_until_equal(lambda: state(scene.page, "tool.hint"), "Move over an object to select the target point.")
    scene.click(0.25, 0.5)
    until(scene.page, "lw.tool.class.endsWith('/Interact')")
    point = scene.single_message("/clicked_point")
    assert (point.point.x, point.point.y, point.point.z) == pytest.approx((0.25, 0.5, 1.5), abs=0.03)
    until(scene.page, "lw.displays[2].drawn !== null")


def test_measure_shows_distance_between_two_points(scene):
    scene.press("n")
    scene.click(-0.4, 0)
    scene.click(0.4, 0.5)
    length = state(scene.page, "tool.state")["length"]
    assert length == pytest.approx(math.hypot(0.8, 0.5), abs=0.05)
    assert state(scene.page, "tool.hint").startswith(f"[Length: {length:.6g}"[:14])
    scene.click(0.4, 0.5, button="right")
    assert state(scene.page, "tool.state")["length"] is None


def test_measure_without_hit_shows_notice(scene):
    scene.press("n")
    box = scene.page.locator(".canvas-box canvas").bounding_box()
    scene.page.mouse.click(box["x"] + 3, box["y"] + box["height"] - 3)
    notice = scene.page.locator("[data-notice=tool]")
    notice.get_by_text("There is nothing at this point").wait_for()
    scene.click(-0.4, 0)
    notice.wait_for(state="hidden")


def test_focus_camera_centers_clicked_point(scene):
    scene.press("c")
    scene.click(0.25, 0.5)
    until(scene.page, "lw.tool.class.endsWith('/Interact')")
    values = state(scene.page, "view.values")
    assert (values["X"], values["Y"]) == pytest.approx((0.25, 0.5), abs=0.03)
    scene.page.mouse.move(*scene.pixel(-0.25, -0.5))
    scene.page.keyboard.press("f")
    until(scene.page, "Math.abs(lw.view.values.X) < 0.03 && Math.abs(lw.view.values.Y) < 0.03")


def test_tools_are_added_and_removed(scene):
    page = scene.page
    page.get_by_role("button", name="Remove a tool").click()
    page.get_by_role("menuitem", name="Publish Point").click()
    until(page, "lw.tools.length === 7")
    page.get_by_role("button", name="Add a tool").click()
    page.get_by_role("menuitem", name="Measure").click()
    until(page, "lw.tools.length === 8")
    tools = [tool["Class"].rpartition("/")[2] for tool in scene.saved_settings()["Tools"]]
    assert tools[-2:] == ["SetGoal", "Measure"]


# --- selection -------------------------------------------------------------------------------------------------------


def test_links_are_selected_by_click_and_box(scene):
    page = scene.page
    scene.press("s")
    scene.click(0, 0)
    assert scene.selected_keys() == ["base"]
    page.keyboard.down("Shift")
    scene.click(*TIP)
    assert scene.selected_keys() == ["base", "tip"]
    page.keyboard.up("Shift")
    page.keyboard.down("Control")
    scene.click(0, 0)
    page.keyboard.up("Control")
    assert scene.selected_keys() == ["tip"]
    scene.click(-3, -3)
    assert scene.selected_keys() == []
    scene.drag((-3, -3), (2, 2))
    assert scene.selected_keys() == ["base"]
    scene.drag((-3, -3), (4, 2))
    assert sorted(scene.selected_keys()) == ["base", "tip"]
    scene.viewer.settle(page)
    assert sorted(scene.selected_keys()) == ["base", "tip"]


def test_selection_panel_shows_link_poses(scene):
    page = scene.page
    scene.press("s")
    scene.click(*TIP)
    scene.viewer.place("tip", *TIP, 0.5)
    page.get_by_role("tab", name="Selection", exact=True).click()
    tree = page.get_by_role("tree", name="Selection")
    tree.get_by_text("Link tip").wait_for()
    position = tree.get_by_role("treeitem").filter(has_text="Position")
    position.get_by_text("3; 1; 0.5").wait_for()


# --- time and keys ---------------------------------------------------------------------------------------------------


def test_pause_freezes_displayed_scene(scene):
    page = scene.page
    page.get_by_role("button", name="Time", exact=True).click()
    page.get_by_role("button", name="Pause").click()
    until(page, "lw.time.paused")
    scene.viewer.place("tip", 5.0, 1.0, 0.0)
    message = get_message("geometry_msgs/msg/PointStamped")()
    message.header.frame_id = "base"
    scene.viewer.publish("/clicked_point", message)
    wait_until(lambda: scene.viewer.status("Clicks")["Topic"][1].startswith("1 message"))
    scene.viewer.run(lambda: asyncio.sleep(0.5))  # enough for pending callbacks in the viewer's loop
    scene.viewer.settle(page)
    assert state(page, "frames.tip.position")[0] == pytest.approx(TIP[0])
    assert scene.viewer.run(scene.viewer.viewer.displays[2].data) == []
    page.get_by_role("button", name="Pause").click()
    until(page, "lw.frames.tip.position[0] === 5")
    wait_two_seconds(page)
    elapsed = page.locator(".time-panel .figure").nth(1)
    time_before = float(elapsed.inner_text())
    page.keyboard.press("r")
    wait_until_equal(lambda: float(elapsed.inner_text()) < time_before, True)
    assert not state(page, "time.paused")


def test_keyboard_shortcuts_dialog_opens_and_closes(scene):
    page = scene.page
    page.keyboard.press("?")
    sheet = page.get_by_role("dialog", name="Keyboard shortcuts")
    sheet.wait_for()
    assert "2D Goal Pose" in sheet.inner_text()
    assert sheet.locator("section", has_text="Terminal").locator("kbd").all_inner_texts() == [
        "Ctrl+Shift+C",
        "Ctrl+Shift+V",
        "Ctrl+Shift+M",
        "← →",
    ]
    page.keyboard.press("Escape")
    sheet.wait_for(state="detached")
    page.keyboard.press("F11")
    # The page draws no frames while it enters or leaves full screen, so the test polls.
    wait_until_equal(lambda: page.evaluate("document.fullscreenElement?.className ?? null"), "scene-box")
    page.keyboard.press("F11")
    wait_until_equal(lambda: page.evaluate("document.fullscreenElement"), None)
