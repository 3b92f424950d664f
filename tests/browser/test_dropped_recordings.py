"""Recordings dropped on the page in a real browser.

They open with their own timeline, or a reason is shown.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from linkwright.bag import BagWriter
from linkwright.graph import DEFAULT_QOS
from linkwright.messages import get_message, serialize
from tests.browser.conftest import Program, state, until
from tests.browser.test_timeline import LENGTH_S, SECOND_NS, START_S, seek, wait_for_second, write_recording

pytestmark = pytest.mark.browser

MODEL = '<robot name="arm"><link name="base"/></robot>'


@pytest.fixture
def page(start, open_page, tmp_path: Path) -> Page:
    """Open a page that shows a robot."""
    (tmp_path / "arm.urdf").write_text(MODEL)
    program: Program = start("view", "arm.urdf")
    robot_page: Page = open_page(program, wait=False)
    until(robot_page, "lw.timeline?.live && lw.robot")
    return robot_page


def drop_files(page: Page, *paths: Path) -> None:
    """Drop files from the desktop on the page."""
    session = page.context.new_cdp_session(page)
    data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
    for event_type in ("dragEnter", "dragOver", "drop"):
        session.send("Input.dispatchDragEvent", {"type": event_type, "x": 500, "y": 400, "data": data})
    session.detach()


def wait_and_pause(page: Page, name: str) -> None:
    """Wait until a recording is shown, and pause it."""
    until(
        page,
        f"lw.timeline?.name === {name!r} && lw.frames.tip && lw.displays.some(({{ drawn }}) => drawn?.width === 4)",
    )
    if state(page, "timeline")["playing"]:
        page.get_by_role("button", name="Pause (Space)").click()
    until(page, "!lw.timeline.playing")


def test_dropped_mcap_file_plays_and_back_returns_to_robot(page: Page, tmp_path: Path):
    file = write_recording(tmp_path)
    drop_files(page, file)
    wait_and_pause(page, file.name)
    assert state(page, "timeline")["length"] == LENGTH_S
    for seconds in (20.55, 4.55):
        seek(page, seconds)
        wait_for_second(page, int(seconds))
    page.reload()
    wait_and_pause(page, file.name)
    page.go_back()
    until(page, "lw.timeline?.live && lw.robot")


def test_dropped_sqlite_folder_plays_and_next_recording_replaces_it(page: Page, tmp_path: Path):
    folder = tmp_path / "numbers"
    with BagWriter(folder, "sqlite3") as writer:
        number = get_message("std_msgs/msg/Float64")
        writer.add_topic("/number", "std_msgs/msg/Float64", [DEFAULT_QOS])
        for second in range(5):
            writer.write("/number", (START_S + second) * SECOND_NS, serialize(number(data=float(second))))
    drop_files(page, folder)
    until(page, "lw.timeline?.name === 'numbers_0.db3' && lw.timeline.length === 4")
    file = write_recording(tmp_path)
    drop_files(page, file)
    wait_and_pause(page, file.name)


def test_recording_is_opened_from_file_menu(page: Page, tmp_path: Path):
    file = write_recording(tmp_path)
    page.get_by_role("button", name="File", exact=True).click()
    with page.expect_file_chooser() as file_chooser:
        page.get_by_role("menuitem", name="Open a recording…").click()
    file_chooser.value.set_files(str(file))
    wait_and_pause(page, file.name)


def test_invalid_recording_is_reported_and_page_stays(page: Page, tmp_path: Path):
    dialog = page.get_by_role("dialog")
    drop_files(page, tmp_path / "arm.urdf")
    expect(dialog).to_contain_text("There is no .mcap or .db3 file in 'arm.urdf'.")
    dialog.get_by_role("button", name="OK").click()
    false = tmp_path / "false.mcap"
    false.write_bytes(b"no recording at all")
    drop_files(page, false)
    message = "'false.mcap' cannot be read as a recording: it does not begin with a MCAP header"
    expect(dialog).to_contain_text(message)
    dialog.get_by_role("button", name="OK").click()
    until(page, "lw.timeline?.live && lw.robot")


def test_upload_is_canceled(page: Page, tmp_path: Path):
    def wait(route) -> None:
        held_requests.append(route)

    held_requests: list[object] = []
    page.route("**/recordings/*/0*", wait)
    drop_files(page, write_recording(tmp_path))
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("progressbar")).to_be_visible()
    dialog.get_by_role("button", name="Cancel").click()
    expect(dialog).to_have_count(0)
    page.unroute_all()
    file = shutil.copy(write_recording(tmp_path / "again"), tmp_path / "other.mcap")
    drop_files(page, Path(file))
    wait_and_pause(page, "other.mcap")
