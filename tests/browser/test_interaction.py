"""Interaction with mouse and keyboard: orbit, toggles, sliders, clicks on links."""

from __future__ import annotations

import math

import pytest

from tests.browser.conftest import count_frames, state, until, wait_until_equal
from tests.places import PACKAGE

pytestmark = pytest.mark.browser


@pytest.fixture
def page(start, open_page):
    return open_page(start("launch", "my_robot_description", "display_xacro.launch.py"))


def scene_box(page):
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    return box


def drag(page, dx, dy, button="left"):
    box = scene_box(page)
    x, y = box["x"] + 60, box["y"] + box["height"] - 60
    page.mouse.move(x, y)
    page.mouse.down(button=button)
    page.mouse.move(x + dx / 2, y + dy / 2)
    page.mouse.move(x + dx, y + dy)
    page.mouse.up(button=button)


def robot_model_drawing(page):
    return next(display for display in state(page, "displays") if display["name"] == "RobotModel")


def test_left_drag_orbits_camera_as_in_rviz(page):
    drag(page, 100, -40)
    view = state(page, "view")
    assert view["yaw"] == pytest.approx(5.5 - 0.005 * 100, abs=1e-6)
    assert view["pitch"] == pytest.approx(0.33 - 0.005 * 40, abs=1e-6)
    assert view["distance"] == pytest.approx(1.7)
    assert view["focalPoint"] == pytest.approx([0, 0, 0])


def test_pitch_is_clamped_before_pole(page):
    drag(page, 0, -500)
    assert state(page, "view.pitch") == pytest.approx(-(math.pi / 2 - 0.001), abs=1e-6) or state(
        page, "view.pitch"
    ) == pytest.approx(0.33 - 2.5, abs=1e-6)


def test_wheel_zooms_by_a_twelfth(page):
    box = scene_box(page)
    page.mouse.move(box["x"] + 300, box["y"] + 300)
    page.mouse.wheel(0, -120)
    until(page, "lw.view.distance < 1.7")
    assert state(page, "view.distance") == pytest.approx(1.7 * (1 - 0.12), rel=0.02)


def test_middle_drag_moves_focal_point_and_keeps_angles(page):
    drag(page, 80, 0, button="middle")
    view = state(page, "view")
    assert (view["yaw"], view["pitch"], view["distance"]) == pytest.approx((5.5, 0.33, 1.7))
    # The point moves to the camera's left in its image plane, by 2 d tan(fov/2) / height meters per pixel.
    meters = 80 * 2 * 1.7 * math.tan(math.radians(22.5)) / scene_box(page)["height"]
    focal_point = view["focalPoint"]
    assert math.hypot(*focal_point) == pytest.approx(meters, rel=0.02)
    assert focal_point[2] == pytest.approx(0, abs=1e-6)


def test_display_checkbox_hides_and_shows_robot(page):
    box = page.locator('.row[data-key="d1"]').get_by_role("checkbox")
    names = [display["name"] for display in state(page, "displays")]
    row = page.get_by_role("treeitem").filter(has_text="RobotModel").first
    box = row.get_by_role("checkbox")
    assert names[1] == "RobotModel"
    assert state(page, "robot.visuals") == 12
    box.click()
    until(page, "lw.robot.visuals === 0 && lw.displays[1].enabled === false")
    box.click()
    until(page, "lw.robot.visuals === 12 && lw.displays[1].enabled === true")


def test_slider_rotates_wheel_about_its_axis(page):
    slider = page.locator('[data-joint="left_wheel_joint"] input[type=range]')
    slider.fill("1.2")
    until(page, "Math.abs(lw.joints.left_wheel_joint - 1.2) < 0.01")
    angle = state(page, "joints.left_wheel_joint")
    until(page, f"Math.abs(lw.frames.left_wheel_link.orientation[1] - {math.sin(angle / 2)}) < 1e-4")
    x, y, z, w = state(page, "frames.left_wheel_link.orientation")
    assert (x, z) == pytest.approx((0, 0), abs=1e-6)
    assert (abs(y), abs(w)) == pytest.approx((math.sin(angle / 2), math.cos(angle / 2)), abs=1e-4)


def test_number_field_center_and_randomize(page):
    field = page.locator('[data-joint="right_wheel_joint"] input[type=text]')
    field.fill("-0.75")
    field.press("Enter")
    until(page, "lw.joints.right_wheel_joint === -0.75")
    page.get_by_role("button", name="Randomize").click()
    until(page, "Object.values(lw.joints).every((position) => position !== 0 && position !== -0.75)")
    assert all(abs(position) <= math.pi for position in state(page, "joints").values())
    page.get_by_role("button", name="Center").click()
    until(page, "Object.values(lw.joints).every((position) => position === 0)")


def test_position_beyond_limits_is_clamped(page):
    field = page.locator('[data-joint="right_wheel_joint"] input[type=text]')
    field.fill("12")
    field.press("Enter")
    until(page, "Math.abs(lw.joints.right_wheel_joint - Math.PI) < 1e-6")


def test_clicked_link_is_selected_with_source_location(page):
    box = scene_box(page)
    # The front of the lower deck, below the center of the scene, where nothing hides it.
    page.mouse.click(box["x"] + box["width"] * 0.56, box["y"] + box["height"] * 0.53)
    until(page, "lw.selected !== null")
    selected = state(page, "selected")
    source = PACKAGE / "urdf" / "mbot_base.xacro"
    assert selected["file"] == str(source)
    line = source.read_text(encoding="utf-8").splitlines()[selected["line"] - 1]
    assert "<link name=" in line
    assert line[selected["column"] - 1] == "<"
    row = page.locator('[role="treeitem"][aria-selected="true"]')
    assert selected["link"] in row.inner_text()
    page.keyboard.press("Escape")
    until(page, "lw.selected === null")


def test_idle_scene_is_not_redrawn(page):
    page.get_by_role("button", name="Panels", exact=True).click()
    page.get_by_role("menuitemcheckbox", name="Time", exact=True).click()
    wait_until_equal(lambda: count_frames(page) <= 2, True)
    assert count_frames(page) <= 2


def test_selected_link_shows_macro_call_and_values(page):
    row = page.get_by_role("treeitem").filter(has_text="Links").last
    row.locator(".row-name").dblclick()
    page.get_by_role("treeitem").filter(has_text="left_wheel_link").first.locator(".row-name").click()
    until(page, "lw.selected?.link === 'left_wheel_link'")
    # A card that would cover the robot is initially folded.
    page.locator(".selection-card [aria-expanded=false]").click()
    provenance = page.locator(".selection-card .provenance")
    provenance.wait_for()
    text = provenance.inner_text()
    assert "in macro 'wheel' called at" in text
    assert "prefix" in text
    assert "left" in text
