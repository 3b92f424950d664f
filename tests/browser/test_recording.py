"""Recording from the page in a real browser.

Topics and the last minutes become files that can be opened.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from linkwright.bag import BagReader
from tests.browser.conftest import Program, state, until, wait_until_equal

pytestmark = pytest.mark.browser

MODEL = (
    '<robot name="arm"><link name="base"/><link name="tip"/><joint name="turn" type="continuous">'
    '<parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint></robot>'
)


@pytest.fixture
def program(start, tmp_path: Path) -> Program:
    (tmp_path / "arm.urdf").write_text(MODEL)
    viewer: Program = start("view", "arm.urdf")
    return viewer


@pytest.fixture
def page(program: Program, open_page) -> Page:
    """Open a page that shows a robot whose transforms are published continuously."""
    robot_page: Page = open_page(program, wait=False)
    until(robot_page, "lw.timeline?.live && lw.timeline.sizeBytes > 1000 && lw.timeline.length > 2 && lw.frames.tip")
    return robot_page


def choose_record_entry(page: Page, entry: str) -> None:
    """Choose an entry of the Record menu."""
    page.get_by_role("button", name="Record", exact=True).click()
    page.get_by_role("menuitem", name=entry).click()


def stop_recording(page: Page) -> None:
    page.get_by_role("button", name="Stop recording").click()


def wait_until_stopped(page: Page, count: int) -> None:
    until(page, f"lw.recording.path === '' && lw.recording.files.length === {count}")


def recorded_topics(page: Page) -> dict[str, int]:
    """Return the topics of the newest file, with their message counts."""
    with BagReader(state(page, "recording")["files"][0]) as bag:
        assert not bag.findings
        return {topic.name: topic.count for topic in bag.topics}


def recorded_duration(page: Page) -> float:
    """Return the time from the first to the last message of the newest file, in seconds."""
    with BagReader(state(page, "recording")["files"][0]) as bag:
        return (bag.end_ns - bag.start_ns) / 1e9


def test_all_topics_are_recorded_downloaded_and_reopened(page: Page, open_page, start, tmp_path: Path):
    choose_record_entry(page, "Record all topics")
    until(page, "lw.recording.path !== ''")
    folder = Path(state(page, "recording")["path"])
    assert folder.parent == tmp_path
    until(page, "lw.recording.length >= 2")
    stop_recording(page)
    wait_until_stopped(page, 1)
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text(str(folder))
    with page.expect_download() as download:
        dialog.get_by_role("button", name="Download").click()
    copy = tmp_path / "taken.mcap"
    download.value.save_as(copy)
    (file,) = folder.glob("*.mcap")
    assert copy.read_bytes() == file.read_bytes()
    assert {"/tf", "/robot_description", "/joint_states"} <= recorded_topics(page).keys()
    recorded_page = open_page(start("view", str(copy)), wait=False)
    until(recorded_page, "lw.timeline?.live === false && lw.timeline.length > 1 && lw.frames.tip")
    assert recorded_page.get_by_role("button", name="Record", exact=True).count() == 0


def test_finished_recording_opens_in_page(page: Page):
    choose_record_entry(page, "Record all topics")
    until(page, "lw.recording.length >= 2")
    stop_recording(page)
    wait_until_stopped(page, 1)
    page.get_by_role("dialog").get_by_role("button", name="Open here").click()
    until(page, "lw.timeline?.live === false && lw.timeline.length > 1 && lw.frames.tip")
    page.go_back()
    until(page, "lw.timeline?.live && lw.frames.tip")
    assert Path(state(page, "recording")["files"][0]).exists()


def test_chosen_topics_are_recorded(page: Page):
    choose_record_entry(page, "Record chosen topics…")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Record", exact=True)).to_be_disabled()
    dialog.get_by_role("checkbox", name="/joint_states").check()
    dialog.get_by_role("button", name="Record", exact=True).click()
    until(page, "lw.recording.length >= 2")
    stop_recording(page)
    wait_until_stopped(page, 1)
    assert recorded_topics(page).keys() == {"/joint_states"}


def test_all_pages_show_recording_after_its_page_closes(program: Program, page: Page, open_page):
    other_page = open_page(program, wait=False)
    choose_record_entry(page, "Record all topics")
    until(other_page, "lw.recording?.path !== ''")
    page.close()
    until(other_page, "lw.recording.length >= 3")
    stop_recording(other_page)
    wait_until_stopped(other_page, 1)
    other_page.get_by_role("dialog").get_by_role("button", name="OK").click()
    other_page.get_by_role("button", name="Record", exact=True).click()
    name = Path(state(other_page, "recording")["files"][0]).name
    assert other_page.get_by_role("menuitem", name=f"Download {name}").count() == 1


def test_last_minutes_and_marked_range_are_saved(page: Page):
    choose_record_entry(page, "Save the last minutes")
    wait_until_stopped(page, 1)
    assert recorded_topics(page)["/robot_description"] == 1
    full_span = recorded_duration(page)
    page.get_by_role("dialog").get_by_role("button", name="OK").click()
    page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.live")
    box = page.get_by_role("slider", name="Time within the last minutes").bounding_box()
    assert box is not None
    middle = box["y"] + box["height"] / 2
    page.keyboard.down("Shift")
    page.mouse.move(box["x"] + 0.2 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], middle, steps=4)
    page.mouse.up()
    page.keyboard.up("Shift")
    until(page, "lw.recording.mark && lw.recording.mark[1] > lw.recording.mark[0]")
    begin, end = state(page, "recording")["mark"]
    choose_record_entry(page, "Save the marked part")
    wait_until_stopped(page, 2)
    range_topics = recorded_topics(page)
    assert range_topics["/tf"]
    assert range_topics["/robot_description"] == 1, "the description is older than the marked part, but needed"
    assert 0.0 < recorded_duration(page) < full_span
    assert recorded_duration(page) == pytest.approx(end - begin, abs=0.1)


def test_range_is_marked_by_keys_and_cleared(page: Page):
    page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.live")
    page.locator("body").focus()
    page.keyboard.press("]")
    until(page, "lw.recording.mark?.[0] === 0")
    choose_record_entry(page, "Clear the mark")
    wait_until_equal(lambda: state(page, "recording")["mark"], None)


def test_viewer_without_history_can_record(start, open_page, tmp_path: Path):
    (tmp_path / "arm.urdf").write_text(MODEL)
    page = open_page(start("view", "arm.urdf", "--history", "0"))
    choose_record_entry(page, "Record all topics")
    until(page, "lw.recording.path !== ''")
    stop_recording(page)
    wait_until_stopped(page, 1)
    assert "/robot_description" in recorded_topics(page)
    expect(page.get_by_role("dialog")).to_contain_text("linkwright view rosbag2_")


def test_recording_folder_that_cannot_be_created_is_reported(start, open_page, tmp_path: Path):
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "arm.urdf").write_text(MODEL)
    page = open_page(start("view", "arm.urdf", cwd=folder), wait=False)
    until(page, "lw.timeline?.live && lw.frames.tip")
    folder.rename(tmp_path / "away")
    folder.write_text("a file in its place")
    choose_record_entry(page, "Record all topics")
    expect(page.get_by_role("dialog")).to_contain_text("cannot be created")
    assert state(page, "recording")["path"] == ""
