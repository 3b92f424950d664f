"""Actions in the page of a running command, as a learner does them.

`lesson_pictures.py` uses them. An action is a line with a verb first:

| action | effect |
| --- | --- |
| ``run COMMAND`` | start another command, until the picture is made |
| ``once COMMAND`` | run a command to its end |
| ``stop`` | press Ctrl-C in the terminal of the last command that was started |
| ``wait SECONDS`` | let time pass |
| ``until CONDITION`` | wait for a condition in JavaScript, in which ``lw`` is ``window.linkwright`` |
| ``drawn DISPLAY`` | wait until a display has received messages |
| ``panel NAME`` | open a panel from the menu *Panels* |
| ``add TOPIC`` | add the first display that shows a topic |
| ``plot FIELD`` | add a series to the panel *Plots* |
| ``set PANEL NAME=VALUE ...`` | write the value of a property in a tree of properties, such as ``Views`` |
| ``view TYPE NAME=VALUE ...`` | choose a type of view and write its properties |
| ``click TEXT``, ``press NAME``, ``key KEY`` | click what has a text, a button with a name, or press a key |
| ``point X Y``, ``drag X Y X Y`` | click or drag in the scene, in shares of its width and height |
"""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

from playwright.sync_api import Locator, Page

TIMEOUT_MS = 60_000
"""The timeout of an action, in milliseconds."""


class Terminals:
    """Commands that run in parallel in a workspace, each as in a separate terminal.

    Args:
        workspace: the folder in which they run.
    """

    def __init__(self, workspace: Path) -> None:
        self.workspace = workspace
        self.running: list[subprocess.Popen[str]] = []
        self._environment = {**os.environ, "PYTHONUNBUFFERED": "1", "NO_COLOR": "1", "LINKWRIGHT_LANG": "en"}
        self._environment["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        self._environment.setdefault("ROS_DOMAIN_ID", "87")

    def close(self) -> None:
        """Stop all commands, the last one first."""
        while self.running:
            self.stop()

    def start(self, command: str, folder: str = ".") -> subprocess.Popen[str]:
        """Start a command and return it; its output is read by the caller, or dropped by `drain`."""
        words = shlex.split(command)
        if words[0] == "linkwright":
            words[:1] = [sys.executable, "-m", "linkwright"]
        program = subprocess.Popen(
            words,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            cwd=self.workspace / folder,
            env=self._environment,
            text=True,
        )
        self.running.append(program)
        return program

    def serve(self, command: str) -> str:
        """Start a command with a page, and return the address of the page."""
        program = self.start(f"{command} --no-open")
        assert program.stdout is not None
        lines = []
        for line in program.stdout:
            lines.append(line)
            if line.startswith("Viewer: "):
                drain(program)
                return line.split()[1]
        raise SystemExit(f"{command} has no page:\n{''.join(lines)}")

    def run(self, command: str) -> str:
        """Run a command to its end, and return its output."""
        program = self.start(command)
        output, _ = program.communicate(timeout=TIMEOUT_MS / 1000)
        self.running.remove(program)
        return output

    def wait_for_topic(self, topic: str) -> None:
        """Wait until a topic is listed."""
        for _ in range(TIMEOUT_MS // 1000):
            if topic in self.run("linkwright topic list").split():
                return
            time.sleep(0.5)
        raise SystemExit(f"there is no topic {topic}")

    def stop(self) -> None:
        """Press Ctrl-C in the terminal of the last command, and wait for its end."""
        program = self.running.pop()
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)


def drain(program: subprocess.Popen[str]) -> None:
    """Read the rest of the output of a program, so that it never waits for a reader."""
    threading.Thread(target=lambda: program.stdout and program.stdout.read(), daemon=True).start()


def perform_action(page: Page, terminals: Terminals, action: str) -> None:
    """Carry out an action from the table in the module's docstring."""
    verb, _, text = action.partition(" ")
    match verb:
        case "run":
            drain(terminals.start(text))
        case "once":
            terminals.run(text)
        case "stop":
            terminals.stop()
        case "wait":
            page.wait_for_timeout(float(text) * 1000)
        case "until":
            page.wait_for_function(f"(() => {{ const lw = window.linkwright; return {text}; }})()", timeout=TIMEOUT_MS)
        case "drawn":
            display = f"lw.displays.find((each) => each.name === '{text}')"
            perform_action(
                page, terminals, f"until {display}?.status.some((row) => / messages? received/.test(row.text))"
            )
        case "panel":
            page.get_by_role("button", name="Panels", exact=True).click()
            page.get_by_role("menuitemcheckbox", name=text, exact=True).click()
        case "add":
            _add_display(page, text)
        case "plot":
            page.get_by_role("button", name="Add a series").first.click()
            page.get_by_role("combobox", name=re.compile("^Topic and field")).fill(text)
            page.keyboard.press("Enter")
        case "set":
            panel, *values = shlex.split(text)
            for name, _, value in (setting.partition("=") for setting in values):
                _write_value(_find_row(page, panel, name), value)
        case "view":
            kind, *values = shlex.split(text)
            page.get_by_role("tabpanel", name="Views").get_by_label("Type", exact=True).select_option(label=kind)
            perform_action(page, terminals, f"until lw.view.type === '{kind}'")
            for name, _, value in (setting.partition("=") for setting in values):
                _write_value(_find_row(page, "Views", name), value)
        case "click":
            page.get_by_text(text, exact=True).first.click(timeout=TIMEOUT_MS)
        case "press":
            page.get_by_role("button", name=text, exact=True).last.click(timeout=TIMEOUT_MS)
        case "key":
            page.keyboard.press(text)
        case "point" | "drag":
            _use_mouse(page, [float(number) for number in text.split()])
        case _:
            raise SystemExit(f"there is no action '{verb}'")


def _add_display(page: Page, topic: str) -> None:
    page.get_by_role("button", name="Add", exact=True).first.click()
    page.get_by_role("tab", name="By topic").click()
    choice = page.get_by_role("group", name=topic, exact=True).get_by_role("option").first
    choice.click(timeout=TIMEOUT_MS)
    page.get_by_role("dialog").get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("dialog").wait_for(state="hidden")


def _find_row(page: Page, panel: str, path: str) -> Locator:
    """Unfold the parents of a property such as ``Focal Point/X``, and return its row."""
    tree = page.get_by_role("tree", name=panel).first
    *parents, name = path.split("/")
    for parent in parents:
        parent_row = tree.get_by_role("treeitem").filter(has=page.get_by_text(parent, exact=True)).first
        if parent_row.get_attribute("aria-expanded") == "false":
            parent_row.locator(".twist").click()
    rows = tree.get_by_role("treeitem").filter(has=page.get_by_text(name, exact=True))
    return rows.filter(has=page.locator("input, select")).last  # a status has a row with the same name


def _write_value(row: Locator, value: str) -> None:
    row.scroll_into_view_if_needed(timeout=TIMEOUT_MS)
    if value in ("yes", "no"):
        row.locator(".check").set_checked(value == "yes")
    elif row.locator("select").count():
        row.locator("select").select_option(label=value)
    else:
        row.locator("input").last.fill(value)
        row.locator("input").last.press("Enter")


def _use_mouse(page: Page, shares: list[float]) -> None:
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    points = [
        (box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in zip(*[iter(shares)] * 2, strict=True)
    ]
    page.mouse.move(*points[0])
    page.mouse.down()
    page.mouse.move(*points[-1], steps=8)
    page.mouse.up()
