"""Invisible properties, drawn at their positions.

The tests cover masses, inertias, joint axes, frames, collisions.
"""

from __future__ import annotations

import pytest

from tests.browser.arm import write_arm
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.pixels import colors_at

pytestmark = pytest.mark.browser


@pytest.fixture
def page(start, open_page, tmp_path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    page.locator(".inspect > button").click()
    return page


def toggle_overlays(page, *names):
    for name in names:
        page.locator(f'[data-inspect="{name}"] input').click()


def count_orange(page):
    """Return how many of some pixels on the arm's base are orange, the color of collisions."""
    until(page, "lw.settled")  # wait for the fine frame after the coarse one
    box = page.locator(".canvas-box canvas").bounding_box()
    free = page.locator(".stack").bounding_box()["x"] - box["x"]  # the open card of Inspect covers the rest
    x, y = box["x"] + free / 2, box["y"] + box["height"] / 2
    colors = colors_at(page, *((x + dx, y + dy) for dx, dy in ((-40, 0), (-30, 10), (30, 10), (40, 0), (0, 25))))
    return sum(r > 100 and 0.3 * r < g < 0.8 * r and b < 0.7 * g for r, g, b in colors)


def test_masses_inertias_and_implausible_values_are_shown(page):
    toggle_overlays(page, "centers", "boxes", "ellipsoids")
    until(
        page,
        "(({boxes, ellipsoids, totals}) => boxes === 3 && ellipsoids === 3 && totals?.length === 1)"
        "(lw.invisibleProperties)",
    )
    # base at 0.05 with 4 kg, upper arm at 0.1 + 0.2 with 2 kg, forearm at 0.5 + 0.15 with 1 kg
    total = (4 * 0.05 + 2 * 0.3 + 1 * 0.65) / 7
    assert state(page, "invisibleProperties.totals[0]") == pytest.approx([0, 0, total], abs=1e-5)
    assert state(page, "invisibleProperties.centers") == 4  # three links, and the whole robot

    # The center follows the joints.
    page.locator('[data-joint="fore_joint"] input[type=text]').fill("1.5707963")
    page.keyboard.press("Enter")
    center_of_mass = [0.15 / 7, 0, (4 * 0.05 + 2 * 0.3 + 1 * 0.5) / 7]
    until(page, f"Math.abs(lw.invisibleProperties.totals[0][0] - {center_of_mass[0]}) < 1e-4")
    assert state(page, "invisibleProperties.totals[0]") == pytest.approx(center_of_mass, abs=1e-4)

    until(page, "lw.description.findings.some(({ link, code }) => link === 'fore' && code.startsWith('LW3'))")
    assert "Mass of the robot: 7 kg" in page.locator(".inspect-facts").inner_text()
    page.locator('.inspect-facts [data-link="fore"] button').first.click()
    until(page, "lw.selected.link === 'fore'")


def test_inspect_card_names_missing_parts_and_closes_like_menu(start, open_page, tmp_path):
    (tmp_path / "bare.urdf").write_text(
        '<robot name="bare"><link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>'
    )
    page = open_page(start("view", str(tmp_path / "bare.urdf")))
    card, button = page.locator(".inspect-card"), page.locator(".inspect > button")
    button.click()
    toggle_overlays(page, "contrast", "joints")
    page.locator(".inspect-facts").get_by_text("All joints are fixed").wait_for()
    page.locator(".inspect-facts").get_by_text("No link has a <collision>").wait_for()
    page.locator(".canvas-box").focus()
    page.keyboard.press("Escape")
    assert card.is_hidden()
    button.click()
    box = page.locator(".canvas-box").bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 400)
    page.mouse.down()
    page.mouse.move(box["x"] + 260, box["y"] + 400)
    page.mouse.up()
    assert card.is_visible(), "the card stays visible while the scene is rotated"
    page.mouse.click(box["x"] + 200, box["y"] + 400)
    assert card.is_hidden()


def test_joint_axes_show_limits_and_positions(page):
    toggle_overlays(page, "joints")
    until(page, "lw.invisibleProperties.joints?.length === 4")
    page.locator('[data-joint="upper_joint"] input[type=text]').fill("0.7")
    page.keyboard.press("Enter")
    page.locator('[data-joint="slide_joint"] input[type=text]').fill("0.1")
    page.keyboard.press("Enter")
    until(page, "Math.abs(lw.invisibleProperties.joints[0].position - 0.7) < 1e-4")
    until(page, "Math.abs(lw.invisibleProperties.joints[2].position - 0.1) < 1e-4")
    joints = {joint["name"]: joint for joint in state(page, "invisibleProperties.joints")}
    assert (joints["upper_joint"]["lower"], joints["upper_joint"]["upper"]) == (-2, 2)
    assert joints["finger_joint"]["position"] == pytest.approx(-0.04, abs=1e-4)
    toggle_overlays(page, "joints")
    until(page, "lw.invisibleProperties.joints.length === 0 && lw.invisibleProperties.vertices === 0")


def test_frames_are_drawn_by_depth_and_collisions_in_contrast(page):
    page.keyboard.press("z")
    distance = page.locator(".row").filter(has=page.get_by_text("Distance", exact=True)).locator("input").first
    distance.fill("3")
    distance.press("Enter")
    until(page, "lw.view.distance === 3")  # the base is then in the center of the scene
    toggle_overlays(page, "frames")
    until(page, "String(lw.invisibleProperties.frames) === '1,1,1,1,1'")
    page.locator(".inspect-depth input").fill("2")
    until(page, "String(lw.invisibleProperties.frames) === '1,1,1'")
    toggle_overlays(page, "frames")
    wait_until_equal(lambda: count_orange(page), 0)  # the base has RViz's default color, red
    toggle_overlays(page, "contrast")
    wait_until_equal(lambda: count_orange(page) >= 3, True)
    toggle_overlays(page, "contrast")
    wait_until_equal(lambda: count_orange(page), 0)
