"""View types, the mouse in them, and saved views."""

from __future__ import annotations

import math

import pytest

from tests.browser.arm_from_above import PIXELS_PER_METER, TIP, ArmPage, open_scene
from tests.browser.conftest import state, until, wait_until_equal

pytestmark = pytest.mark.browser


@pytest.fixture
def scene(start_viewer, open_page) -> ArmPage:
    return open_scene(start_viewer, open_page)


def test_view_type_change_keeps_camera_pose(scene):
    above = state(scene.page, "view")
    assert (above["type"], above["values"]["Scale"]) == ("TopDownOrtho", PIXELS_PER_METER)
    assert above["camera"]["position"] == [0, 0, 500]
    orbit = scene.show("Orbit")
    assert orbit["distance"] == pytest.approx(100)
    scene.page.keyboard.press("z")
    start = state(scene.page, "view")["camera"]
    fps = scene.show("FPS")
    assert fps["camera"]["position"] == pytest.approx(start["position"])
    assert fps["camera"]["back"] == pytest.approx(start["back"])
    ground = scene.show("XYOrbit")
    assert ground["camera"]["position"] == pytest.approx(start["position"])
    assert ground["values"]["Focal Point/Z"] == pytest.approx(0, abs=1e-9)
    follower = scene.show("ThirdPersonFollower")
    assert follower["camera"]["position"] == pytest.approx(start["position"])
    map_ = scene.show("TopDownOrtho")
    assert [map_["values"][axis] for axis in "XY"] == pytest.approx(follower["focalPoint"][:2])
    tree = scene.page.get_by_role("tree", name="Views")
    tree.get_by_text("Scale", exact=True).wait_for()
    assert "Focal Point" not in tree.inner_text()


def test_mouse_moves_orthographic_view_by_its_scale(scene):
    scene.drag((0, -3), (1, -3), "middle")
    values = state(scene.page, "view.values")
    assert (values["X"], values["Y"]) == pytest.approx((-1, 0), abs=0.03)
    scene.drag((0, -3), (2, -3))
    assert state(scene.page, "view.values")["Angle"] == pytest.approx(2 * PIXELS_PER_METER * 0.005, abs=0.02)
    scene.page.mouse.wheel(0, -120)
    until(scene.page, f"Math.abs(lw.view.values.Scale - {PIXELS_PER_METER * 1.12}) < 0.5")


def test_selected_number_stays_selected_while_mouse_changes_it(scene):
    scene.page.mouse.move(*scene.pixel(0, -3))
    field = scene.page.locator(".row").filter(has=scene.page.get_by_text("Scale", exact=True)).locator("input")
    field.focus()
    scene.page.mouse.wheel(0, -120)
    wait_until_equal(field.input_value, f"{PIXELS_PER_METER * 1.12:g}")
    scene.page.keyboard.type("40")  # replaces the number, although the number changed after it was selected
    scene.page.keyboard.press("Enter")
    until(scene.page, "lw.view.values.Scale === 40")


def test_fps_view_moves_and_rotates(scene):
    scene.show("FPS")
    scene.page.keyboard.press("z")
    start = state(scene.page, "view")
    scene.drag((0, 0), (1, 0))
    view = state(scene.page, "view")
    assert view["yaw"] == pytest.approx(start["yaw"] - PIXELS_PER_METER * 0.005, abs=0.01)
    assert view["camera"]["position"] == pytest.approx([5, 5, 10])
    scene.page.mouse.wheel(0, -120)
    until(scene.page, "Math.abs(lw.view.camera.position[2] - 10) > 0.5")
    position = state(scene.page, "view.camera.position")
    assert math.dist(position, [5, 5, 10]) == pytest.approx(1.2, rel=0.02)


def test_follower_view_follows_position_and_yaw_of_frame(scene):
    scene.show("ThirdPersonFollower")
    scene.page.keyboard.press("z")
    scene.page.evaluate("() => undefined")
    start = state(scene.page, "view.camera")
    row = scene.page.get_by_role("treeitem").filter(has_text="Target Frame")
    row.locator("input").fill("tip")
    row.locator("input").press("Enter")
    until(scene.page, "lw.view.values['Target Frame'] === 'tip'")
    assert state(scene.page, "view.camera.position") == pytest.approx(start["position"], abs=1e-6)
    half = math.sqrt(0.5)
    scene.viewer.place("tip", *TIP, 0.0, 0.0, 0.0, half, half)  # rotated by 90 degrees about z
    until(scene.page, "Math.abs(lw.frames.tip.orientation[2] - 0.7071) < 0.001")
    camera = state(scene.page, "view.camera")
    x, y = start["position"][0] - TIP[0], start["position"][1] - TIP[1]
    assert camera["position"][:2] == pytest.approx([TIP[0] - y, TIP[1] + x], abs=1e-5)
    assert camera["back"][2] == pytest.approx(start["back"][2])
    scene.viewer.place("tip", *TIP, 0.0, half, 0.0, 0.0, half)  # rotated about x only
    until(scene.page, "Math.abs(lw.frames.tip.orientation[0] - 0.7071) < 0.001")
    assert state(scene.page, "view.camera.up") == pytest.approx(start["up"], abs=1e-6)


def test_views_are_saved_renamed_used_and_removed(scene):
    page = scene.page
    page.get_by_role("button", name="Save", exact=True).click()
    until(page, "lw.view.saved.length === 1")
    page.get_by_role("treeitem").filter(has_text="TopDownOrtho").nth(1).locator(".row-name").click()
    page.get_by_role("button", name="Rename", exact=True).click()
    page.keyboard.type("map")
    page.keyboard.press("Enter")
    until(page, "lw.view.saved[0] === 'map'")
    scene.show("FPS")
    page.get_by_role("treeitem").filter(has_text="map").locator(".row-name").dblclick()
    until(page, "lw.view.type === 'TopDownOrtho'")
    assert state(page, "view.values")["Scale"] == PIXELS_PER_METER
    wait_until_equal(lambda: scene.saved_settings()["Views"]["Current"]["Class"], "rviz_default_plugins/TopDownOrtho")
    views = scene.saved_settings()["Views"]
    assert [(view["Name"], view["Scale"]) for view in views["Saved"]] == [("map", PIXELS_PER_METER)]
    page.get_by_role("button", name="Remove", exact=True).click()
    until(page, "lw.view.saved.length === 0")
    assert not scene.saved_settings()["Views"]["Saved"]
