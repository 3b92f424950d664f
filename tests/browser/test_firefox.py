"""The page in Firefox: it draws, takes keys, and shows what is missing without WebGL."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from tests.browser import firefox
from tests.browser.arm import write_arm
from tests.browser.firefox import Firefox
from tests.browser.live import POLL_PERIOD_S
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

RIGHT, ENTER, CONTROL, HOME, END, ESCAPE = "\ue014", "\ue007", "\ue009", "\ue011", "\ue010", "\ue00c"
CRATE = """\
<robot name="crate">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry><material name="red"><color rgba="1 0 0 1"/></material></visual>
  </link>
  <link name="lid"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/><child link="lid"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>
  </joint>
</robot>
"""


@pytest.fixture
def launch(tmp_path: Path) -> Iterator[Callable[..., Firefox]]:
    """Return a function that starts Firefox.

    If that fails, the test is skipped, or fails in CI.
    """
    with ExitStack() as stack:

        def run(*, headless: bool) -> Firefox:
            skip_reason = "no Firefox" if firefox.find_firefox() is None else None
            if not skip_reason and not headless and not firefox.can_show_windows():
                skip_reason = "no display and no Xvfb for Firefox's WebGL"
            if skip_reason and "CI" in os.environ:
                pytest.fail(f"{skip_reason}, which .ci/run installs")
            if skip_reason:
                pytest.skip(skip_reason)
            profile = tmp_path / "profile"
            profile.mkdir()
            return stack.enter_context(firefox.launch(profile, headless=headless))

        yield run


def test_firefox_draws_and_moves_robot(start, launch, tmp_path):
    (tmp_path / "crate.urdf").write_text(CRATE)
    program = start("view", str(tmp_path / "crate.urdf"))
    browser = launch(headless=False)
    browser.goto(program.url)
    browser.until("lw.ready")

    def share_of_red() -> float:
        image = browser.screenshot(".canvas-box canvas")
        reds = sum(count for count, (r, g, b) in image.getcolors(1 << 24) if r > 80 and r > 3 * max(g, b))
        return reds / (image.width * image.height)

    wait_until(lambda: share_of_red() > 0.05, what=share_of_red, pause=POLL_PERIOD_S)
    # The arrow keys move the focus between tabs.
    browser.evaluate("document.querySelector('[data-tab-panel-id=displays]').focus()")
    browser.press(RIGHT, ENTER)
    browser.until("document.querySelector('[data-tab-panel-id=links][aria-selected=true]')")
    # The arrow keys move the thumb of a slider too.
    browser.evaluate("document.querySelector('[data-joint=hinge] .slider').focus()")
    orientation = browser.evaluate("window.linkwright.frames.lid.orientation")
    browser.press(RIGHT, RIGHT)
    browser.until(f"JSON.stringify(lw.frames.lid.orientation) !== JSON.stringify({orientation})")
    thumb = browser.evaluate("getComputedStyle(document.documentElement).getPropertyValue('--thumb')").strip()
    color = tuple(bytes.fromhex(thumb[1:]))
    colors = {
        pixel_color: count for count, pixel_color in browser.screenshot("[data-joint=hinge] .slider").getcolors(1 << 24)
    }
    assert colors.get(color, 0) > 40, (thumb, colors)
    assert browser.errors == []


def test_firefox_compares_two_robots_and_edits_one(start, launch, tmp_path):
    file = tmp_path / "crate.urdf"
    file.write_text(CRATE)
    (tmp_path / "old.urdf").write_text(CRATE.replace('size="1 1 1"', 'size="1 1 2"'))
    program = start("view", str(tmp_path / "old.urdf"), str(file))
    browser = launch(headless=False)
    browser.goto(program.url)
    browser.until("lw.ready && document.querySelector('.difference-name')")
    assert browser.evaluate("document.querySelector('.comparison-count').innerText") == "1 difference"
    browser.evaluate("document.querySelector('.difference-name').click()")
    browser.until("document.querySelector('.selection-card .edit-link')")
    browser.evaluate("document.querySelector('.selection-card .edit-link').click()")
    browser.until("document.querySelector('.editing-part[aria-pressed=true]')")
    browser.evaluate("document.querySelector('[data-number=xyz2]').focus()")
    browser.press(*"0.25", ENTER)
    browser.until(
        "document.querySelector('.edit-diff .added') && !document.querySelector('.edit-bar .primary').disabled"
    )
    assert file.read_text() == CRATE
    browser.evaluate("document.querySelector('.edit-bar .primary').click()")
    wait_until(lambda: 'xyz="0 0 0.25"' in file.read_text(), what=file.read_text)
    browser.until("document.querySelector('.comparison-count').innerText === '2 differences'")
    assert browser.errors == []


def test_firefox_drags_handle(start, launch, tmp_path):
    file = tmp_path / "crate.urdf"
    file.write_text(CRATE)
    program = start("view", str(file))
    browser = launch(headless=False)
    browser.goto(program.url)
    browser.until("lw.ready")
    browser.evaluate("document.querySelector('[data-tab-panel-id=displays]').focus()")
    browser.press(RIGHT, ENTER)
    browser.until("document.querySelector('.link-row[data-link=lid]')")
    browser.evaluate("document.querySelector('.link-row[data-link=lid] .link-name').click()")
    browser.until("document.querySelector('.selection-card .edit-link')")
    browser.evaluate("document.querySelector('.selection-card .edit-link').click()")
    browser.until("lw.panels.editing?.handles?.z")
    samples: list[Any] = []

    def is_still() -> bool:  # the new panel makes the scene smaller
        samples.append(browser.evaluate("window.linkwright.panels.editing.handles.z"))
        return len(samples) > 5 and samples[-1] == samples[-5]

    wait_until(is_still, pause=POLL_PERIOD_S)
    handle = samples[-1]
    canvas = browser.evaluate("document.querySelector('.canvas-box canvas').getBoundingClientRect()")
    browser.drag(canvas["x"] + handle["x"], canvas["y"] + handle["y"], 0, -60)
    browser.until("lw.panels.editing.draft?.xyz[2] > 0.01")
    assert browser.evaluate("window.linkwright.panels.editing.draft.xyz.slice(0, 2)") == [0, 0]
    browser.until("document.querySelector('.edit-diff .added')")
    assert file.read_text() == CRATE
    browser.evaluate("document.querySelector('.edit-bar .primary').click()")
    wait_until(lambda: "<origin" in file.read_text(), what=file.read_text)
    assert browser.errors == []


def test_firefox_edits_file_with_language_server(start, launch, tmp_path):
    file = tmp_path / "crate.urdf"
    file.write_text(CRATE)
    program = start("view", str(file))
    browser = launch(headless=False)
    browser.goto(program.url)
    browser.until("lw.ready")

    def click(selector: str, text: str) -> None:
        element = (
            f"[...document.querySelectorAll('{selector}')].find((element) => element.textContent.trim() === '{text}')"
        )
        browser.until(f"{element} && !{element}.disabled")
        browser.evaluate(f"{element}.click()")

    click(".title-bar button", "Panels")
    click("[role=menuitemcheckbox]", "Source")
    click(".source-panel button", "Edit")
    browser.until("lw.panels.source.editor?.file?.endsWith('crate.urdf')")
    browser.evaluate("document.querySelector('.cm-content').focus()")
    browser.chord(CONTROL, HOME)
    browser.press(END, ENTER, *"<lin")
    browser.until("document.querySelector('.cm-tooltip-autocomplete li')?.textContent.includes('link')")
    browser.press(ESCAPE, *'k nme="top"/>')
    browser.until("lw.panels.source.editor.findings.length > 0 && document.querySelector('.cm-lintRange')")
    assert file.read_text() == CRATE

    line = browser.evaluate("document.querySelectorAll('.cm-line')[0].firstElementChild.getBoundingClientRect()")
    browser.point(line["x"] + 20, line["y"] + line["height"] / 2)
    browser.until("document.querySelector('.cm-lsp-hover-tooltip')")
    while browser.evaluate("window.linkwright.panels.source.editor.unsaved.length"):
        browser.chord(CONTROL, "z")
    browser.chord(CONTROL, HOME)
    browser.press(*"<!-- mine -->")
    browser.chord(CONTROL, "s")
    wait_until(lambda: file.read_text() == "<!-- mine -->" + CRATE, what=file.read_text)
    browser.until("lw.panels.source.editor.unsaved.length === 0")
    while "mine" in browser.evaluate("window.linkwright.panels.source.editor.text"):
        browser.chord(CONTROL, "z")
    browser.chord(CONTROL, "s")
    wait_until(lambda: file.read_text() == CRATE, what=file.read_text)
    assert browser.errors == []


def test_firefox_without_webgl_shows_message_and_panels(start, launch, tmp_path):
    program = start("view", str(write_arm(tmp_path)))
    browser = launch(headless=True)
    browser.goto(program.url)
    browser.until("document.querySelector('.no-webgl')?.checkVisibility()")
    message = browser.evaluate("document.querySelector('.no-webgl').innerText")
    assert message.startswith("The 3D view needs WebGL 2, which this browser does not provide.\n")
    assert "The other panels work without it." in message
    box, scene = (
        browser.evaluate(f"document.querySelector('{selector}').getBoundingClientRect()")
        for selector in (".no-webgl > strong", ".scene-box")
    )
    assert scene["left"] < box["left"] < box["right"] < scene["right"]
    browser.until("document.querySelectorAll('.joint').length === 4")
    browser.evaluate("document.querySelector('[data-joint=upper_joint] .slider').focus()")
    browser.press(RIGHT)
    browser.until("lw.frames.fore?.position[0] > 0.01")
    assert all("WebGL" in error for error in browser.errors), browser.errors
