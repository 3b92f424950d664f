"""The Joints panel: units, poses, sweeps, and dragging of links in the scene."""

from __future__ import annotations

import math

import pytest

from tests.browser.arm import write_arm
from tests.browser.conftest import state, until, wait_two_seconds, wait_until_equal

pytestmark = pytest.mark.browser


@pytest.fixture
def page(start, open_page, tmp_path):
    return open_page(start("view", str(write_arm(tmp_path))))


def move_joint(page, joint, text):
    field = page.locator(f'[data-joint="{joint}"] input[type=text]')
    field.fill(text)
    field.press("Enter")


def test_units_limits_and_mimic_joints_are_shown(page):
    row = page.locator('.joint[data-joint="fore_joint"]')
    assert "-0.500 rad" in row.inner_text()
    page.get_by_role("button", name="deg").first.click()
    wait_until_equal(lambda: "-28.6 deg" in row.inner_text(), True)
    move_joint(page, "fore_joint", "90")
    until(page, f"Math.abs(lw.joints.fore_joint - {math.pi / 2}) < 1e-3")
    follower = page.locator('.joint[data-joint="finger_joint"]')
    assert "-0.5 × slide_joint + 0.01 m" in follower.inner_text()
    assert follower.locator("input[type=range]").is_disabled()


def test_long_joint_names_keep_their_ends(start, open_page, tmp_path):
    name = "hand_at_the_end_of_the_left_arm_of_the_upper_body_finger_{}_joint"
    elements = ['<link name="base"/>']
    for number in (1, 2):
        ends = f'<parent link="base"/><child link="finger_{number}"/>'
        elements.append(
            f'<link name="finger_{number}"/><joint name="{name.format(number)}" type="continuous">{ends}</joint>'
        )
    (tmp_path / "hand.urdf").write_text(f'<robot name="hand">{"".join(elements)}</robot>')
    page = open_page(start("view", str(tmp_path / "hand.urdf")))
    names = page.locator(".joint-name")
    names.nth(1).wait_for()
    for number, label in enumerate(names.all(), start=1):
        assert label.get_attribute("title") == label.text_content() == name.format(number)
        head, tail = (label.locator("span").nth(index) for index in (0, 1))
        assert tail.text_content() == f"finger_{number}_joint"
        assert head.evaluate("(element) => element.scrollWidth > element.clientWidth")
        assert tail.evaluate("(element) => element.scrollWidth <= element.clientWidth + 1")
        assert page.get_by_role("slider", name=name.format(number), exact=True).is_visible()


def test_saved_poses_are_recalled_and_survive_reload(page):
    move_joint(page, "upper_joint", "0.5")
    until(page, "lw.joints.upper_joint === 0.5")
    page.get_by_label("Name of the pose").fill("bent")
    page.get_by_label("Name of the pose").press("Enter")
    page.locator('.chip.on[data-pose="bent"]').wait_for()
    page.get_by_role("button", name="Center").click()
    until(page, "lw.joints.upper_joint === 0")
    page.reload()
    until(page, "lw.ready")
    page.locator('.chip[data-pose="bent"] .chip-name').click()
    until(page, "lw.joints.upper_joint === 0.5")
    with page.expect_download() as download:
        page.get_by_label("More about poses").click()
        page.get_by_role("menuitem", name="Export as SRDF").click()
    text = download.value.path().read_text()
    assert download.value.suggested_filename == "arm.srdf"
    assert '<group_state name="bent"' in text
    assert '<joint name="upper_joint" value="0.5"/>' in text
    page.locator('.chip[data-pose="bent"] .chip-remove').click()
    page.locator(".chip").wait_for(state="detached")


def test_sweep_moves_joints_until_stopped(page):
    page.get_by_label("Order of the joints").select_option("all")
    page.get_by_role("group", name="Sweep").get_by_label("Speed").select_option("4")
    page.get_by_role("button", name="Start the sweep").click()
    positions_seen = set()

    def has_swept() -> bool:
        positions_seen.add(round(state(page, "joints.upper_joint"), 2))
        return len(positions_seen) >= 6 and max(positions_seen) - min(positions_seen) > 1.5

    wait_until_equal(has_swept, True)
    page.get_by_role("button", name="Stop the sweep").click()

    def is_standing_still() -> bool:
        positions = state(page, "joints")
        wait_two_seconds(page)
        return state(page, "joints") == positions

    wait_until_equal(is_standing_still, True)


def test_dragged_link_moves_its_joint(page):
    # The camera looks along the joints' axis from the right: in the image, x is to the right, and z is up.
    page.keyboard.press("z")  # the view is about the root
    for name, value in (("Yaw", "-1.5707963"), ("Pitch", "0"), ("Distance", "2")):
        row = page.locator(".row").filter(has=page.get_by_text(name, exact=True))
        field = row.locator("input").first
        field.fill(value)
        field.press("Enter")
    until(page, "Math.abs(lw.view.pitch) < 1e-6 && lw.view.distance === 2")
    until(page, "lw.settled")
    box = page.locator(".canvas-box canvas").bounding_box()
    meter = box["height"] / (2 * 2 * math.tan(math.radians(22.5)))

    def screen_position(x, z):
        return box["x"] + box["width"] / 2 + x * meter, box["y"] + box["height"] / 2 - z * meter

    page.keyboard.down("Alt")
    page.mouse.move(*screen_position(0, 0.3))
    until(page, "lw.description.joints === 4")  # the page requests the axes of the joints now
    page.mouse.move(*screen_position(0.002, 0.3))
    until(page, "lw.tool.cursor === 'grab'")
    page.mouse.down()
    for step in range(1, 9):
        angle = 0.8 * step / 8
        page.mouse.move(*screen_position(0.2 * math.sin(angle), 0.1 + 0.2 * math.cos(angle)))
    page.mouse.up()
    page.keyboard.up("Alt")
    until(page, "Math.abs(Math.abs(lw.joints.upper_joint) - 0.8) < 0.1")
    yaw = state(page, "view.yaw")

    # Without Alt, the same drag rotates the camera.
    page.mouse.move(*screen_position(0, 0.02))
    page.mouse.down()
    page.mouse.move(*screen_position(0.2, 0.02), steps=4)
    page.mouse.up()
    until(page, f"Math.abs(lw.view.yaw - {yaw}) > 0.05")
