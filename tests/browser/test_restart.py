"""A restart with Ctrl-C, arrow up and Enter: open pages continue with the new program."""

from __future__ import annotations

import re
import shutil
import socket
import sys

import pytest

from tests.browser.conftest import TIMEOUT_S, state, until, wait_until_equal
from tests.places import PACKAGE

pytestmark = pytest.mark.browser

MBOT = PACKAGE / "urdf" / "mbot_base.xacro"
TERMINAL = "lw.panels.terminal"
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals")


@pytest.fixture
def port() -> str:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return str(free.getsockname()[1])


@pytest.fixture
def context(browser):
    """Return a browser whose console may show connection errors."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale="en-US")
    context.set_default_timeout(1000 * TIMEOUT_S)
    yield context
    context.close()


def open_url(context, url):
    page = context.new_page()
    page.goto(url)
    until(page, "lw.ready")
    return page


def panel_titles(page) -> list[str]:
    """Return the titles of the panels, without the number of findings, which arrive one by one."""
    return [re.sub(r" \(\d+\)", "", text) for text in page.locator(".dv-tab").all_inner_texts()]


def wait_until_gone(page) -> None:
    page.locator(".notice[data-state=ended]").wait_for()


def wait_until_connected(page) -> None:
    page.locator(".notice[data-state=connected]").wait_for(state="attached")


def test_pages_keep_panels_joint_pose_and_camera_after_restart(start, context, port):
    program = start("view", str(MBOT), "--port", port)
    page, second = open_url(context, program.url), open_url(context, program.url)
    page.locator('[data-joint="left_wheel_joint"] input[type=range]').fill("1.2")
    until(page, "lw.joints.left_wheel_joint > 1")
    joints = state(page, "joints")
    page.mouse.move(600, 400)
    page.mouse.wheel(0, -360)
    page.get_by_role("tab", name="Links").click()
    until(page, "lw.view.distance < 1")
    view, panels = state(page, "view.values"), panel_titles(page)

    assert program.interrupt() == 130
    wait_until_gone(page)
    assert "Start it again" in page.locator(".notice[data-state=ended]").inner_text()
    new_program = start("view", str(MBOT), "--port", port)
    assert new_program.url == program.url
    wait_until_connected(page)
    wait_until_equal(lambda: state(page, "joints"), joints)
    wait_until_equal(lambda: state(second, "joints"), joints)
    until(page, "lw.robot.visuals === 12 && lw.settled")
    assert state(page, "view.values") == view
    assert panel_titles(page) == panels
    assert page.get_by_role("tab", name="Links").get_attribute("aria-selected") == "true"


def test_restart_with_other_file_resets_view_and_keeps_panels(start, context, port, tmp_path):
    other_file = tmp_path / "other.xacro"
    shutil.copy(MBOT, other_file)
    program = start("view", str(MBOT), "--port", port)
    page = open_url(context, program.url)
    first = state(page, "view.distance")
    page.locator('[data-joint="left_wheel_joint"] input[type=range]').fill("1.2")
    until(page, "lw.joints.left_wheel_joint > 1")
    page.mouse.move(600, 400)
    page.mouse.wheel(0, -360)
    until(page, "lw.view.distance < 1")
    panels = panel_titles(page)
    assert program.interrupt() == 130
    wait_until_gone(page)
    start("view", str(other_file), "--port", port)
    wait_until_connected(page)
    until(page, "lw.robot.visuals === 12 && lw.settled")
    wait_until_equal(lambda: state(page, "view.distance"), pytest.approx(first))
    assert state(page, "joints.left_wheel_joint") == 0
    assert page.title().startswith("other.xacro")
    wait_until_equal(lambda: panel_titles(page), panels)


@pytest.fixture
def shell(monkeypatch, tmp_path) -> None:
    monkeypatch.setenv("SHELL", "/bin/bash")
    monkeypatch.setenv("HOME", str(tmp_path))


def wait_for_text(page, text: str) -> None:
    page.wait_for_function("text => window.linkwright?.panels.terminal.text?.includes(text)", arg=text, polling=50)


def run_command(page, command: str) -> None:
    until(page, f"/[$#] *$/.test({TERMINAL}.text ?? '') && {TERMINAL}.notice === ''")
    page.locator(".terminal-screen:visible .xterm-helper-textarea").focus()
    page.keyboard.type(f"{command}\n")


@posix
@pytest.mark.parametrize("arguments", [("view", str(MBOT), "--terminal"), ("learn", "ws")], ids=["view", "learn"])
def test_tabs_reattach_to_terminal_of_restarted_program(start, context, port, shell, arguments):
    program = start(*arguments, "--port", port)
    first = context.new_page()
    first.goto(program.url)
    run_command(first, "echo mine=$((6*7))")
    wait_for_text(first, "mine=42")
    second = context.new_page()
    second.goto(program.url)
    until(second, f"{TERMINAL}.notice?.includes('another page')")
    assert program.interrupt() == 130
    until(first, f"{TERMINAL}.notice.includes('cannot be reached')")
    start(*arguments, "--port", port)
    for page in (first, second):
        wait_until_connected(page)
        page.reload()
        until(page, f"{TERMINAL}.notice?.includes('another page') || /[$#] *$/.test({TERMINAL}.text ?? '')")
        current = state(page, "panels.terminal.current")
        assert page.locator(".terminal-tabs [aria-selected=true]").inner_text() == f"Terminal {current}"
        assert "mine" not in state(page, "panels.terminal.text")
    if state(second, "panels.terminal.notice") != "":
        second.get_by_role("button", name="Show it here").click()
    run_command(second, "echo again=$((6*7))")
    wait_for_text(second, "again=42")


@posix
def test_page_with_lost_connection_reclaims_its_terminal(start, context, shell):
    """The program notices the loss only after seconds.

    The page must keep its terminal in that time.
    """
    sockets = []

    def forward_socket(page_end) -> None:
        page_end.connect_to_server()
        page_end.on_close(lambda *_: None)  # the connection to the program stays open
        sockets.append(page_end)

    page = context.new_page()
    page.route_web_socket(re.compile("/ws"), forward_socket)
    page.goto(start("view", str(MBOT), "--terminal").url)
    run_command(page, "echo mine=$((6*7))")
    wait_for_text(page, "mine=42")
    sockets[0].close()
    page.locator(".notice[data-state=reconnecting]").wait_for()
    wait_until_connected(page)
    until(page, f"{TERMINAL}.notice === ''")
    assert len(sockets) == 2
    run_command(page, "echo again=$((6*7))")
    wait_for_text(page, "again=42")


def test_token_is_not_sent_to_program_without_it(start, context, port, monkeypatch, tmp_path):
    program = start("view", str(MBOT), "--port", port)
    page = open_url(context, program.url)
    urls: list[str] = []
    page.on("request", lambda request: urls.append(request.url))
    page.on("websocket", lambda socket: urls.append(socket.url))
    assert program.interrupt() == 130
    wait_until_gone(page)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "of-another-user"))
    other_program = start("view", str(MBOT), "--port", port)
    assert other_program.url != program.url
    page.locator(".notice[data-state=refused]").wait_for()
    assert any("/proof?nonce=" in url for url in urls)
    assert not [url for url in urls if "token" in url]
