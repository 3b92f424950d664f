"""The terminal in the page.

The tests cover commands, keys, sizes, several terminals, and leaving it with the keyboard.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.browser.axe import find_violations
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.test_description import open_panel

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals"),
]

ROBOT = '<robot name="r"><link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>\n'
TERMINAL = "lw.panels.terminal"
INPUT = ".terminal-screen:visible .xterm-helper-textarea"


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SHELL", "/bin/bash")
    monkeypatch.setenv("HOME", str(tmp_path))  # without the user's start-up files, whose output varies
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT)
    return path


def wait_for_text(page, text: str) -> None:
    """Wait until the terminal shows a text."""
    page.wait_for_function("text => window.linkwright.panels.terminal.text?.includes(text)", arg=text, polling=50)


def open_terminal(page) -> None:
    """Wait for the shell's prompt, and focus the terminal."""
    until(page, f"/[$#] *$/.test({TERMINAL}.text ?? '')")
    page.locator(INPUT).focus()


def run_command(page, command: str) -> None:
    page.keyboard.type(f"{command}\n")


def test_commands_run_and_are_stopped_by_keys(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, "echo 你好-$((40+2)); pwd")
    wait_for_text(page, f"\n你好-42\n{file.parent}\n")
    run_command(page, "sh -c 'echo be''gun; exec sleep 1000'")
    wait_for_text(page, "\nbegun")
    page.keyboard.press("Control+c")
    run_command(page, "echo interrupted=$?")
    wait_for_text(page, "\ninterrupted=130")
    run_command(page, "sh -c 'echo once'' more; exec sleep 1000'")
    wait_for_text(page, "\nonce more")
    page.keyboard.press("Control+z")
    wait_for_text(page, "Stopped")
    run_command(page, "kill %1; env -u LINKWRIGHT_DDS linkwright topic list; echo listed=$?")
    wait_for_text(page, "\nlisted=0")
    columns = state(page, "panels.terminal.size.columns")
    run_command(page, "echo columns=$(stty size)")
    wait_for_text(page, f"columns={state(page, 'panels.terminal.size.rows')} {columns}")
    page.set_viewport_size({"width": 1000, "height": 700})
    until(page, f"{TERMINAL}.size.columns < {columns}")
    run_command(page, "clear; echo columns=$(stty size)")
    wait_for_text(
        page, f"columns={state(page, 'panels.terminal.size.rows')} {state(page, 'panels.terminal.size.columns')}\n"
    )


def test_endless_output_does_not_block_page_or_program(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, "yes")
    until(page, f"{TERMINAL}.scrollback >= 5000")
    assert state(page, "ready")
    page.keyboard.press("Control+c")
    run_command(page, "echo done=$((1+1))")
    wait_for_text(page, "\ndone=2")


def test_exited_shell_is_reported_and_restarts(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, "exit 3")
    until(page, f"{TERMINAL}.notice.includes('exit status 3')")
    page.keyboard.press("Enter")
    until(page, f"{TERMINAL}.terminals[0].status === null && {TERMINAL}.notice === ''")
    run_command(page, "echo again=$((1+1))")
    wait_for_text(page, "\nagain=2")


def test_multiple_terminals_survive_reload(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, "name=first; echo $name")
    wait_for_text(page, "\nfirst")
    page.get_by_role("button", name="New", exact=True).click()
    until(page, f"{TERMINAL}.current === 2")
    open_terminal(page)
    run_command(page, "echo second=$name.")
    wait_for_text(page, "\nsecond=.")
    page.reload()
    until(page, f"{TERMINAL}.text?.includes('first') && {TERMINAL}.terminals.length === 2")
    page.locator(INPUT).focus()
    run_command(page, "echo again=$name")
    wait_for_text(page, "\nagain=first")
    page.get_by_role("tab", name="Terminal 2").click()
    wait_for_text(page, "\nsecond=.")
    page.locator(".terminal-deck").get_by_role("button", name="Close", exact=True).click()
    until(page, f"{TERMINAL}.terminals.length === 1 && {TERMINAL}.text.includes('again=first')")


def test_second_page_shows_terminal_owner_and_can_take_over(start, open_page, file):
    program = start("view", str(file), "--terminal")
    first = open_page(program)
    open_terminal(first)
    run_command(first, "echo mine=$((6*7))")
    wait_for_text(first, "\nmine=42")
    second = open_page(program)
    until(second, f"{TERMINAL}.current === 1 && {TERMINAL}.notice?.includes('another page')")
    assert second.get_by_role("tab", name="Terminal 1").get_attribute("aria-selected") == "true"
    second.get_by_role("button", name="Show it here").click()
    wait_for_text(second, "\nmine=42")
    until(first, f"{TERMINAL}.notice.includes('another page')")


def test_text_is_copied_and_pasted_by_keys(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    open_terminal(page)
    run_command(page, "clear; echo copy-$((1+1))-me")
    wait_for_text(page, "copy-2-me")
    page.locator(".terminal-screen:visible .xterm-screen").dblclick(position={"x": 20, "y": 8})
    page.keyboard.press("Control+Shift+C")
    wait_until_equal(lambda: page.evaluate("navigator.clipboard.readText()"), "copy-2-me")
    page.keyboard.type("echo pasted-")
    page.keyboard.press("Control+Shift+V")
    page.keyboard.press("Enter")
    wait_for_text(page, "\npasted-copy-2-me")


def test_keyboard_can_leave_terminal_and_page_shortcuts_are_ignored(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, "echo ready-$((1+1)); cat -v")
    wait_for_text(page, "\nready-2")  # keys that the shell still reads have other line ends
    page.keyboard.press("Control+s")
    page.keyboard.press("Control+q")
    page.keyboard.press("Tab")
    page.keyboard.type("?f\n")
    wait_for_text(page, "\n        ?f\n")
    assert state(page, "panels.terminal.focused")
    assert page.locator("dialog").count() == 0
    page.keyboard.press("Control+Shift+M")
    wait_until_equal(lambda: page.evaluate("document.activeElement.getAttribute('role')"), "tab")
    page.keyboard.press("Enter")
    until(page, f"{TERMINAL}.focused")


def test_terminal_passes_axe_in_both_themes(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    run_command(page, r"printf '\033[31mred\033[33myellow\033[90mgrey\033[44mon blue\033[0m\n'")
    wait_for_text(page, "\nredyellowgreyon blue")
    assert find_violations(page) == []


def test_screen_reader_can_read_output(start, open_page, file):
    page = open_page(start("view", str(file), "--terminal"))
    open_terminal(page)
    page.get_by_role("button", name="Let a screen reader read the terminal").click()
    page.locator(INPUT).focus()
    run_command(page, "echo read-$((1+1))-aloud")
    until(page, "document.querySelector('.xterm-accessibility-tree')?.textContent.includes('read-2-aloud')")
    assert "Ctrl+Shift+M" in page.locator(INPUT).get_attribute("aria-label")


def test_terminal_is_unavailable_without_option(start, open_page, file):
    page = open_page(start("view", str(file)))
    assert not state(page, "panels.terminal.available")
    page.locator(".title-bar").get_by_text("Panels", exact=True).click()
    assert page.get_by_role("menuitemcheckbox", name="Terminal", exact=True).count() == 0
    page.keyboard.press("Escape")
    open_panel(page, "Log")
    assert not any(
        "terminal" in address for address in page.evaluate("performance.getEntriesByType('resource').map(e => e.name)")
    )
