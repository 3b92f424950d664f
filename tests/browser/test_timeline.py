"""The timeline of a recording in a real browser.

Images, plots and frames belong to its time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from linkwright.bag import BagWriter
from linkwright.graph import DEFAULT_QOS
from linkwright.messages import TFMessage, TransformBatch, get_message, serialize
from tests.browser.conftest import state, until, wait_until_equal
from tests.images.test_images import image

pytestmark = pytest.mark.browser

START_S = 1_700_000_000
SECOND_NS = 1_000_000_000
FLOAT = get_message("std_msgs/msg/Float64")

LENGTH_S = 30
"""The length in seconds. Each topic has ten messages a second; number, frame and image identify the second."""


def write_recording(folder: Path) -> Path:
    """Write a recording to an MCAP file."""
    with BagWriter(folder / "drive") as writer:
        writer.add_topic("/second", "std_msgs/msg/Float64", [DEFAULT_QOS])
        writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        writer.add_topic("/camera", "sensor_msgs/msg/Image", [DEFAULT_QOS])
        for tenth in range(10 * LENGTH_S + 1):
            second, stamp = tenth // 10, START_S * SECOND_NS + tenth * SECOND_NS // 10
            batch = TransformBatch(("base",), ("tip",), stamp, np.array([[second, 0, 0, 0, 0, 0, 1.0]]))
            writer.write("/tf", stamp, serialize(TFMessage(batch=batch)))
            writer.write("/second", stamp, serialize(FLOAT(data=float(second))))
            message = image("rgb8", 4, 4, bytes(color_of_second(second)) * 16)
            message.header.frame_id = "tip"
            writer.write("/camera", stamp, serialize(message))
            if tenth % 10 == 9:
                writer.flush()
    (file,) = (folder / "drive").glob("*.mcap")
    return file


def color_of_second(second: int) -> tuple[int, int, int]:
    return 8 * second, 0, 255 - 8 * second


@pytest.fixture
def page(start, open_page, tmp_path: Path) -> Page:
    """Open a page with the recording, paused; without a robot, the page waits only for frames."""
    recording_page = open_page(start("view", str(write_recording(tmp_path))), wait=False)
    until(recording_page, "lw.timeline && lw.frames.tip && lw.displays.some(({ drawn }) => drawn?.width === 4)")
    if state(recording_page, "timeline")["playing"]:
        recording_page.get_by_role("button", name="Pause (Space)").click()
    until(recording_page, "!lw.timeline.playing")
    return recording_page


def shown_position(page: Page) -> float:
    return float(state(page, "timeline")["position"])


def track_box(page: Page) -> dict[str, float]:
    box = page.get_by_role("slider", name="Time in the recording").bounding_box()
    assert box is not None
    return dict(box)


def seek(page: Page, seconds: float) -> None:
    """Click on a time of the timeline."""
    box = track_box(page)
    page.mouse.click(box["x"] + box["width"] * seconds / LENGTH_S, box["y"] + box["height"] / 2)
    until(page, f"Math.abs(lw.timeline.position - {seconds}) < {LENGTH_S / box['width'] + 0.01}")


def wait_for_second(page: Page, second: int) -> None:
    """Wait until the frame and the image belong to a second."""
    until(page, f"Math.abs(lw.frames.tip?.position[0] - {second}) < 1e-6")
    corner = "window.linkwright.displays.find(({ drawn }) => drawn?.width === 4).drawn.corner"
    wait_until_equal(lambda: page.evaluate(corner), [*color_of_second(second), 255])


def test_seek_shows_frames_and_images_of_that_time(page: Page):
    assert state(page, "timeline")["length"] == LENGTH_S
    for seconds in (20.55, 4.55, 12.55):
        seek(page, seconds)
        wait_for_second(page, int(seconds))
    assert not state(page, "timeline")["playing"]


def test_dragging_slider_updates_scene_before_release(page: Page):
    box = track_box(page)
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.1 * box["width"], middle)
    page.mouse.down()
    for share in (0.3, 0.6, 0.851):
        page.mouse.move(box["x"] + share * box["width"], middle, steps=5)
    wait_for_second(page, 25)
    page.mouse.move(box["x"] - 100, middle)
    wait_for_second(page, 0)
    assert shown_position(page) == 0
    page.mouse.up()


def test_step_buttons_move_between_messages(page: Page):
    seek(page, 9.95)
    wait_for_second(page, 9)
    # There are three messages at each time; a step shows all of them.
    page.get_by_role("button", name="Next message (→)").click()
    until(page, "Math.abs(lw.timeline.position - 10) < 1e-5")
    wait_for_second(page, 10)
    page.keyboard.press("ArrowLeft")
    until(page, "Math.abs(lw.timeline.position - 9.9) < 1e-5")
    wait_for_second(page, 9)
    page.get_by_role("button", name="Previous message (←)").click()
    until(page, "Math.abs(lw.timeline.position - 9.8) < 1e-5")


def test_arrow_keys_step_after_click_into_scene(page: Page):
    seek(page, 9.95)
    page.locator(".canvas-box canvas").first.click(position={"x": 30, "y": 30})
    page.keyboard.press("ArrowLeft")
    until(page, "Math.abs(lw.timeline.position - 9.9) < 1e-5")
    page.keyboard.press("ArrowRight")
    until(page, "Math.abs(lw.timeline.position - 10) < 1e-5")


def test_steps_follow_the_chosen_topic(start, open_page, tmp_path: Path):
    with BagWriter(tmp_path / "rare") as writer:
        writer.add_topic("/second", "std_msgs/msg/Float64", [DEFAULT_QOS])
        writer.add_topic("/rare", "std_msgs/msg/Float64", [DEFAULT_QOS])
        for tenth in range(101):
            for topic in ("/second", *(["/rare"] if tenth % 40 == 0 else [])):
                writer.write(topic, START_S * SECOND_NS + tenth * SECOND_NS // 10, serialize(FLOAT(data=0.0)))
    page = open_page(start("view", str(tmp_path / "rare")), wait=False)
    until(page, "lw.timeline")
    page.get_by_role("combobox", name="Step by the messages of").select_option("/rare")
    if state(page, "timeline")["playing"]:
        page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.playing")
    page.get_by_role("slider", name="Time in the recording").press("Home")
    until(page, "lw.timeline.position === 0")
    page.get_by_role("button", name="Next message (→)").click()
    until(page, "Math.abs(lw.timeline.position - 4) < 1e-5")
    page.get_by_role("button", name="Next message (→)").click()
    until(page, "Math.abs(lw.timeline.position - 8) < 1e-5")
    page.get_by_role("button", name="Previous message (←)").click()
    until(page, "Math.abs(lw.timeline.position - 4) < 1e-5")


def test_space_plays_and_pauses_at_chosen_speed(page: Page):
    page.get_by_role("combobox", name="Speed").select_option("10")
    seek(page, 2.05)
    page.locator("body").focus()
    page.keyboard.press("Space")
    until(page, "lw.timeline.playing && lw.timeline.position > 6")
    page.keyboard.press("Space")
    until(page, "!lw.timeline.playing")
    start_position = shown_position(page)
    wait_for_second(page, int(start_position))
    page.get_by_role("combobox", name="Speed").select_option("0.1")
    page.get_by_role("button", name="Play (Space)").click()
    until(page, f"lw.timeline.position > {start_position}")
    page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.playing")


def test_playback_stops_or_repeats_at_end(page: Page):
    page.get_by_role("combobox", name="Speed").select_option("10")
    seek(page, LENGTH_S - 3)
    page.get_by_role("button", name="Play (Space)").click()
    until(page, f"!lw.timeline.playing && lw.timeline.position === {LENGTH_S}")
    wait_for_second(page, LENGTH_S)
    page.get_by_role("button", name="Repeat from the start").click()
    seek(page, LENGTH_S - 3)
    page.get_by_role("button", name="Play (Space)").click()
    until(page, "lw.timeline.playing && lw.timeline.position < 20")


def test_plots_follow_timeline_position(page: Page):
    seek(page, 5.05)
    page.get_by_role("button", name="Panels").click()
    page.get_by_role("menuitemcheckbox", name="Plots", exact=True).click()
    page.get_by_role("button", name="Add a series").first.click()
    page.get_by_role("combobox", name="Topic and field").fill("/second.data")
    page.keyboard.press("Enter")
    last = "lw.panels.monitor.plots[0].series[0].last"
    until(page, f"{last} === 5")
    page.locator(".timeline-track").focus()
    page.keyboard.press("Home")
    until(page, f"{last} === 0")
    page.get_by_role("button", name="Play (Space)").click()
    until(page, f"{last} >= 1")


def test_history_supports_pause_seek_and_return_to_live(start, open_page, tmp_path: Path):
    model = tmp_path / "arm.urdf"
    model.write_text(
        '<robot name="arm"><link name="base"/><link name="tip"/><joint name="turn" type="continuous">'
        '<parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint></robot>'
    )
    page = open_page(start("view", str(model), "--history", "1MB"), wait=False)
    until(page, "lw.timeline?.live && lw.timeline.sizeBytes > 1000 && lw.timeline.length > 2 && lw.frames.tip")
    page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.live && !lw.timeline.playing")
    paused_timeline = state(page, "timeline")
    until(page, f"lw.timeline.length > {paused_timeline['length'] + 1}")
    page.get_by_role("slider", name="Time within the last minutes").click(position={"x": 3, "y": 5})
    until(page, "lw.timeline.position < 1")
    start_viewer = page.get_by_role("button", name="Live: follow the newest messages")
    for width in (360, 390):  # on phones, the button stays in its line
        page.set_viewport_size({"width": width, "height": 844})
        box = start_viewer.bounding_box()
        assert (box["height"], box["x"] + box["width"] <= width) == (22, True)
    start_viewer.click()
    until(page, "lw.timeline.live && lw.timeline.sizeBytes <= 1e6 && lw.frames.tip")


def test_viewer_without_history_has_no_timeline(start, open_page, tmp_path: Path):
    model = tmp_path / "arm.urdf"
    model.write_text('<robot name="arm"><link name="base"/></robot>')
    page = open_page(start("view", str(model), "--history", "0"), wait=False)
    until(page, "lw.frames && lw.robot")
    assert state(page, "timeline") is None
    assert page.locator(".timeline-track").is_hidden()
