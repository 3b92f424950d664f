"""Overlays on the scene.

Nothing overlaps when everything is open at once, in windows of three sizes.
"""

from __future__ import annotations

import io
from itertools import combinations

import pytest
from PIL import Image

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.arm import write_arm
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.kept_pictures import keep
from tests.browser.live import configuration

pytestmark = pytest.mark.browser

OVERLAYS = (
    ".notice",
    ".banner",
    ".inspect > button",
    ".inspect-card",
    ".selection-card",
    ".line-notice:not([data-notice])",
    "[data-notice=tool]",
    "[data-notice=owner]",
    "[data-notice=meshes]",
    ".voice-notice",
)
SIZES = ((1280, 800), (1024, 768), (800, 600))

# Elements that are scrolled out of the column are not visible.
BOXES = """(selectors) => Object.fromEntries([...selectors, ".orientation", ".scene-box"].map((selector) => {
  const element = document.querySelector(selector);
  const { left, top, right, bottom } = element.getBoundingClientRect();
  const column = element.closest(".stack")?.getBoundingClientRect() ?? { top: -Infinity, bottom: Infinity };
  return [selector, [left, Math.max(top, column.top), right, Math.min(bottom, column.bottom)]];
}))"""

# Show the notices of a lost server, a slow connection and a voice together, which the page rarely does.
TELL = """() => {
  for (const element of document.querySelectorAll(".notice, .line-notice, .voice-notice")) {
    element.hidden = false;
    element.textContent = "Something is to be told about the connection, in two lines or more of this narrow column";
  }
}"""


def find_overlaps(boxes: dict[str, list[float]]) -> list[str]:
    """Return the pairs of boxes that overlap by more than an edge.

    Boxes outside the scene are returned, too.
    """
    left, top, right, bottom = boxes.pop(".scene-box")
    overlaps = [
        f"{first} over {second}"
        for (first, first_box), (second, second_box) in combinations(boxes.items(), 2)
        if min(first_box[2], second_box[2]) - max(first_box[0], second_box[0]) > 0.5
        and min(first_box[3], second_box[3]) - max(first_box[1], second_box[1]) > 0.5
    ]
    return overlaps + [
        f"{name} outside"
        for name, box in boxes.items()
        if box[0] < left - 0.5 or box[1] < top - 0.5 or box[2] > right + 0.5 or box[3] > bottom + 0.5
    ]


def test_scene_overlays_do_not_overlap(start, open_page, tmp_path):
    file = write_arm(tmp_path)
    page = open_page(start("view", str(file)))
    page.locator(".inspect > button").click()
    page.locator('[data-inspect="centers"] input').click()
    page.get_by_role("treeitem").filter(has_text="Links").last.locator(".row-name").dblclick()
    page.get_by_role("treeitem").filter(has_text="fore").first.locator(".row-name").click()
    page.locator(".selection-card").wait_for()
    unfold_overlays(page)
    page.locator(".inspect > button").click()  # the clicks on rows have closed the card of Inspect
    file.write_text(file.read_text().replace("</robot>", "<link/></robot>"))
    page.locator(".banner").wait_for()
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate(TELL)
        wait_until_equal(lambda: find_overlaps(page.evaluate(BOXES, list(OVERLAYS))), [])
        until(page, "lw.settled")
        keep(page, f"overlays-{width}x{height}")


def unfold_overlays(page) -> None:
    if page.locator(".selection-card .fold").get_attribute("aria-expanded") == "false":
        page.locator(".selection-card .fold").click()


WIDE = '<robot name="wide"><link name="base"><visual><geometry><box size="2 2 1"/></geometry></visual></link></robot>'


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_selection_card_does_not_cover_robot(start, open_page, tmp_path, width, height):
    """A card that would cover the robot is folded.

    If the user unfolds it, the robot moves aside until it is closed.
    """
    (tmp_path / "wide.urdf").write_text(WIDE)
    page = open_page(start("view", str(tmp_path / "wide.urdf")))
    page.set_viewport_size({"width": width, "height": height})
    fit = page.get_by_role("toolbar", name="Tools", exact=True).get_by_role("button", name="Fit", exact=True)
    fit.click()
    until(page, "lw.settled")
    right_edge = state(page, "robotsRightEdge")
    canvas = page.locator(".canvas-box canvas")
    middle = canvas.bounding_box()
    canvas.click(position={"x": middle["width"] / 2, "y": middle["height"] / 2})
    card, fold_button = page.locator(".selection-card"), page.locator(".selection-card .fold")
    card.wait_for()

    def card_covers_robot() -> bool:
        box = card.bounding_box()
        return state(page, "robotsRightEdge") > box["x"] - canvas.bounding_box()["x"]

    reaches = right_edge > middle["width"] - 10 - min(256, 0.55 * (middle["width"] - 20))
    assert fold_button.get_attribute("aria-expanded") == ("false" if reaches else "true")
    if reaches:
        assert card.bounding_box()["height"] < 45
        fold_button.click()
        wait_until_equal(lambda: state(page, "robotsRightEdge") < right_edge, True)
        fit.click()  # moving aside was not enough
    wait_until_equal(card_covers_robot, False)
    page.keyboard.press("Escape")
    card.wait_for(state="hidden")
    page.keyboard.press("Shift+F")
    wait_until_equal(lambda: state(page, "robotsRightEdge"), pytest.approx(right_edge, abs=1))


def test_robot_shifted_aside_stays_on_canvas(start, open_page, tmp_path):
    """A robot that fills nearly all of the canvas moves aside only as far as the canvas's edge."""
    (tmp_path / "flat.urdf").write_text(WIDE.replace("2 2 1", "2 2 0.1"))
    page = open_page(start("view", str(tmp_path / "flat.urdf")))
    page.set_viewport_size({"width": 1024, "height": 768})
    page.get_by_role("toolbar", name="Tools", exact=True).get_by_role("button", name="Fit", exact=True).click()
    until(page, "lw.settled")
    # The robot is in the middle of the canvas, so its margins on the left and right are equal.
    right_edge, width = state(page, "robotsRightEdge"), page.locator(".canvas-box canvas").bounding_box()["width"]
    page.locator(".inspect > button").click()
    page.locator(".inspect-card").wait_for()
    wait_until_equal(lambda: state(page, "robotsRightEdge"), pytest.approx(right_edge - (width - right_edge), abs=1))


TALL = """\
<robot name="tall">
  <link name="base"><visual><origin xyz="0 0 1"/><geometry><box size="0.2 0.2 2"/></geometry></visual></link>
  <link name="head"><visual><geometry><sphere radius="0.15"/></geometry>
    <material name="green"><color rgba="0 1 0 1"/></material></visual></link>
  <joint name="neck" type="fixed"><origin xyz="0 0 2.1"/><parent link="base"/><child link="head"/></joint>
</robot>
"""


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_tall_robot_moves_below_banner_and_returns(start, open_page, tmp_path, width, height):
    file = tmp_path / "tall.urdf"
    file.write_text(TALL)
    page = open_page(start("view", str(file)))
    page.set_viewport_size({"width": width, "height": height})
    page.keyboard.press("Shift+F")

    def count_head_pixels() -> int:
        """Return the number of visible pixels of the head."""
        until(page, "lw.settled")
        box = page.locator(".scene-box").bounding_box()
        with Image.open(io.BytesIO(page.screenshot(clip=box))) as image:
            return sum(count for count, (r, g, b) in image.convert("RGB").getcolors(1 << 24) if g > 60 > max(r, b))

    head_before = count_head_pixels()
    assert head_before > 300
    file.write_text(TALL.replace("</robot>", "<link/></robot>"))
    page.locator(".banner").wait_for()
    if height > 600:
        wait_until_equal(lambda: count_head_pixels() > 0.98 * head_before, True)
    page.keyboard.press("Shift+F")  # moving down was not enough
    wait_until_equal(lambda: count_head_pixels() > 0.15 * head_before, True)
    file.write_text(TALL)
    page.locator(".banner").wait_for(state="hidden")
    page.keyboard.press("Shift+F")
    wait_until_equal(count_head_pixels, head_before)


def test_fit_button_shows_whole_robot(start, open_page, tmp_path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    until(page, "lw.settled")
    view = state(page, "view.values")
    page.get_by_role("button", name="Zero", exact=True).click()
    until(page, f"lw.view.values.Distance !== {view['Distance']}")
    page.get_by_role("toolbar", name="Tools", exact=True).get_by_role("button", name="Fit", exact=True).click()
    until(page, "Math.abs(lw.view.values['Focal Point/Z'] - " + str(view["Focal Point/Z"]) + ") < 1e-6")
    assert state(page, "view.values.Distance") < 10
    page.keyboard.press("z")
    until(page, "lw.view.values.Distance === 10")
    page.keyboard.press("Shift+F")
    until(page, "lw.view.values.Distance < 10")


def test_replaced_description_is_reported(start_viewer, open_page):
    viewer = start_viewer(configuration("- {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}"))
    viewer.publish("/robot_description", String(data=WIDE), DESCRIPTION_QOS)
    page = open_page(viewer)
    notice = page.locator("[data-notice=owner]")
    assert notice.is_hidden()
    other_node = viewer.run(lambda: viewer.node.graph.create_node("other"))
    publisher = viewer.run(lambda: other_node.create_publisher(String, "/robot_description", DESCRIPTION_QOS))
    viewer.run(lambda: publisher.publish(String(data=WIDE.replace('"wide"', '"narrow"'))))
    notice.get_by_text("Another node now publishes the description").wait_for()
    wait_until_equal(lambda: "Robot The description of /other is shown" in notice.inner_text(), True)


def test_missing_fixed_frame_offers_existing_frame_and_robot_display(start_viewer, open_page):
    grid = "- {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}"
    viewer = start_viewer(configuration(grid, distance=100.0).replace("Fixed Frame: base", "Fixed Frame: map"))
    viewer.publish("/robot_description", String(data=WIDE), DESCRIPTION_QOS)
    viewer.place("base", 8, 0, 0, parent="odom")
    page = open_page(viewer, wait=False)
    notice = page.locator("[data-notice=frame]")
    notice.get_by_text("The frame 'map' does not exist").wait_for()
    notice.get_by_role("button", name="Use odom, and show the robot").click()
    notice.wait_for(state="hidden")
    # The view must not depend on when the frames arrive.
    until(page, "lw.displays.length === 2 && lw.view.values.Distance < 50")
    assert abs(state(page, "view.values")["Focal Point/X"] - 8) < 1
