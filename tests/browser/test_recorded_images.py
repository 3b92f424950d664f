"""The images of a recording in windows of several sizes.

A message replaces an unreadable image.
"""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import PIL.Image
import pytest
from playwright.sync_api import Page

from linkwright.bag import BagWriter
from linkwright.graph import DEFAULT_QOS
from linkwright.messages import get_message, serialize
from tests.browser.conftest import until, wait_until_equal
from tests.images.test_images import image

pytestmark = pytest.mark.browser

START_NS, SECOND_NS = 1_700_000_000_000_000_000, 1_000_000_000
CompressedImage = get_message("sensor_msgs/msg/CompressedImage")
LaserScan = get_message("sensor_msgs/msg/LaserScan")


def write_recording(path: Path, *, scans: bool) -> Path:
    """Write a recording with raw and compressed images of 4x4 pixels.

    One of the images is truncated. Scans are optional.
    """
    file = BytesIO()
    PIL.Image.new("RGB", (64, 64), (200, 30, 60)).save(file, "jpeg")
    raw = image("rgb8", 4, 4, bytes((200, 30, 60)) * 16)
    scan = LaserScan(angle_max=1.0, angle_increment=0.5, range_max=5.0, ranges=[1.0, 2.0, 3.0])
    scan.header.frame_id = raw.header.frame_id = "camera"
    topics = {
        "/raw": raw,
        "/front": CompressedImage(format="jpeg", data=file.getvalue()),
        "/cut/compressed": CompressedImage(format="jpeg", data=file.getvalue()[:300]),
        **({"/scan": scan} if scans else {}),
    }
    with BagWriter(path) as writer:
        for name, message in topics.items():
            writer.add_topic(name, message.TYPE_NAME, [DEFAULT_QOS])
        for second in range(5):
            for name, message in topics.items():
                writer.write(name, START_NS + second * SECOND_NS, serialize(message))
    return path


@pytest.fixture
def open_recording(start, open_page, tmp_path: Path) -> Callable[..., Page]:
    """Return a function that opens such a recording in a page with the given window size."""

    def show(width: int, height: int, *, scans: bool) -> Page:
        program = start("view", str(write_recording(tmp_path / "drive", scans=scans)))
        page = open_page(program, wait=False, size=(width, height))
        until(page, "lw.timeline && lw.displays.some(({ drawn }) => drawn?.width === 4)")
        return page

    return show


def bounding_box(page: Page, selector: str) -> dict[str, float]:
    box = page.locator(selector).first.bounding_box()
    assert box is not None
    return dict(box)


def image_boxes(page: Page) -> list[dict[str, float]]:
    """Return the visible images."""
    rectangles = (panel.bounding_box() for panel in page.locator(".image-panel").all())
    return [dict(box) for box in rectangles if box is not None]


def toggle_display(page: Page, name: str) -> None:
    """Toggle a display."""
    page.get_by_role("treeitem").filter(has_text=name).get_by_role("checkbox").first.click()


@pytest.mark.parametrize("size", [(1280, 800), (800, 600)])
def test_recording_with_only_images_shows_them_in_place_of_scene(open_recording, size):
    page = open_recording(*size, scans=False)
    wait_until_equal(
        lambda: bounding_box(page, ".image-panel")["width"] >= size[0] / 2 and page.locator(".canvas-box").count(), 0
    )
    page.locator(".dv-tab", has_text="3D View").dispatch_event("pointerdown")
    page.locator(".canvas-box").wait_for()
    page.locator(".dv-tab", has_text="raw").dispatch_event("pointerdown")
    toggle_display(page, "front")
    wait_until_equal(lambda: len({box["y"] for box in image_boxes(page)}) == 1 and len(image_boxes(page)), 2)
    left_box, right_box = sorted(image_boxes(page), key=lambda box: box["x"])
    assert left_box["x"] + left_box["width"] <= right_box["x"], "the images are side by side"


def test_image_is_beside_scene_in_small_window(open_recording):
    page = open_recording(800, 600, scans=True)
    wait_until_equal(lambda: bounding_box(page, ".canvas-box")["width"] > 400, True)
    scene, panel = bounding_box(page, ".canvas-box"), bounding_box(page, ".image-panel")
    assert scene["x"] + scene["width"] <= panel["x"]
    assert panel["width"] > 300
    assert panel["height"] > 200
    assert page.locator(".dv-tab[aria-selected=true]", has_text="Displays").count() == 1


def test_unreadable_image_shows_reason(open_recording):
    page = open_recording(1280, 800, scans=False)
    toggle_display(page, "cut/compressed")
    notice = page.locator(".image-notice", has_text="The image cannot be read")
    notice.get_by_text("The image file is truncated").wait_for()
