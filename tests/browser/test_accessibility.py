"""Everything that the page can show is without a finding of axe-core, in dark and in light colors."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page

from linkwright.graph.log.logger import Logger
from linkwright.messages import get_message
from tests.browser.arm import write_arm
from tests.browser.axe import violations
from tests.browser.conftest import SECONDS, becomes, state, until
from tests.browser.live import LiveViewer, configuration
from tests.browser.test_modeling import modeled
from tests.browser.test_overlays import unfold

pytestmark = pytest.mark.browser

TWIST = get_message("geometry_msgs/msg/Twist")
JOINTS = get_message("sensor_msgs/msg/JointState")
DISPLAYS = """
- {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}
- {Class: rviz_default_plugins/Image, Name: Front, Enabled: true, Topic: {Value: /front}}
- {Class: my_plugins/Radar, Name: Radar, Enabled: true}
"""
OVERLAYS = ".overlay"


def opened(page: Page, name: str) -> str:
    """Opens a panel, or brings it to the front, and gives the selector of the group that it is in."""
    tab = page.locator(".dv-tab", has_text=name)
    if tab.count() == 0:
        page.get_by_role("button", name="Panels", exact=True).click()
        page.get_by_role("menuitemcheckbox", name=name, exact=True).click()
    tab.first.dispatch_event("pointerdown")
    page.locator(".dv-tab[aria-selected=true]", has_text=name).first.wait_for(state="attached")
    return f".dv-groupview:has([data-tab-panel-id='{tab.first.get_attribute('data-tab-panel-id')}'])"


def found_in_panels(page: Page, *names: str) -> list[str]:
    return [f"{name}: {violation}" for name in names for violation in violations(page, opened(page, name))]


def found_in_menu(page: Page) -> list[str]:
    """What is found in the menu that was opened, which goes then."""
    page.get_by_role("menu").wait_for()
    found_violations = violations(page, ".menu")
    page.keyboard.press("Escape")
    return found_violations


def found_in_dialog(page: Page, keys: str) -> list[str]:
    """What is found in the dialog that keys open."""
    page.keyboard.press(keys)
    page.locator("dialog[open]").wait_for()
    found_violations = violations(page, "dialog")
    page.keyboard.press("Escape")
    page.locator("dialog[open]").wait_for(state="detached")
    return found_violations


def test_robot_page_and_description_panels_pass_axe(start, open_page, tmp_path: Path):
    file = write_arm(tmp_path)
    page = open_page(start("view", str(file)))
    page.locator(".inspect > button").click()
    for box in page.locator(".inspect-card [type=checkbox]").all():
        box.click()
    page.get_by_role("treeitem").filter(has_text="Links").last.locator(".row-name").dblclick()
    page.get_by_role("treeitem").filter(has_text="fore").first.locator(".row-name").click()
    page.locator(".selection-card .provenance").wait_for(state="attached")
    unfold(page)
    page.locator(".selection-card .provenance").wait_for()
    page.locator(".inspect > button").click()  # the clicks on rows have closed it
    assert violations(page) == []
    for name in ("File", "Panels", "Share", "Colors"):
        page.get_by_role("button", name=name, exact=True).click()
        assert found_in_menu(page) == []
    for keys in ("?", "Control+o", "Control+Shift+s"):
        assert found_in_dialog(page, keys) == []
    own = ("Joints", "Links", "Diagram", "Source", "Joint Table", "Edit robot")
    assert found_in_panels(page, "Views", "Tool Properties", "Selection", "Transformation", *own) == []
    file.write_text(file.read_text().replace("</robot>", "<link/></robot>"))
    page.locator(".banner").wait_for()
    assert violations(page, OVERLAYS) == []
    assert found_in_panels(page, "Diagnostics") == []


RING = """() => {
  const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(document.activeElement);
  const name = document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent;
  const ring = (outlineStyle !== "none" && parseFloat(outlineWidth) >= 2) || boxShadow !== "none";
  return [name, ring || document.activeElement.matches(".slider"), document.activeElement === document.body];
}"""
"""A slider's thumb has the ring."""


def test_keyboard_focus_has_visible_ring(start, open_page, tmp_path: Path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    reached: list[str] = []
    for _ in range(150):
        page.keyboard.press("Tab")
        name, has_ring, is_end = page.evaluate(RING)
        if is_end:
            break
        assert has_ring, name
        reached.append(name)
    assert len(reached) > 40, reached


def test_displays_menu_and_dialogs_pass_axe(live: Callable[..., LiveViewer], open_page):
    page = open_page(live(configuration(DISPLAYS)), wait=False)
    until(page, "lw.displays.length === 3")
    row = page.locator("[data-key='display-1'] .row-title")
    row.click()
    for keys in ("Alt+a", "F2"):
        assert found_in_dialog(page, keys) == []
    row.dblclick()
    assert violations(page) == []
    row.click(button="right")
    assert found_in_menu(page) == []


def heard(say: Callable[[], None], answer: Locator) -> None:
    """Say something until the page shows it: it may listen a moment later than it is asked to."""

    def is_shown() -> bool:
        say()
        return answer.count() > 0

    becomes(is_shown, True)


def test_live_panels_pass_axe(live: Callable[..., LiveViewer], open_page):
    viewer = live(configuration(DISPLAYS))

    def join() -> Logger:
        arm = viewer.node.graph.create_node("arm")
        arm.declare_parameter("speed", 1.5)
        arm.declare_parameter("names", ["left", "right"])
        arm.create_subscription(TWIST, "/cmd_vel", lambda _: None, 10)
        return arm.get_logger()

    def say_joints() -> None:
        viewer.publish("/joint_states", JOINTS(name=["shoulder"], position=[0.25]))

    logger = viewer.run(join)
    page = open_page(viewer, wait=False)
    opened(page, "Plots")
    page.get_by_role("button", name="Add a series").first.click()
    assert found_in_panels(page, "Plots") == []
    for text in ("/joint_states.position[0]", "/joint_states.wrong"):
        page.get_by_role("combobox", name="Topic and field").fill(text)
        page.keyboard.press("Enter")
        say_joints()
        page.get_by_role("button", name="Add a series").first.click()
    heard(say_joints, page.get_by_text("has no field"))
    assert found_in_panels(page, "Plots") == []
    opened(page, "Topics")
    page.get_by_role("button", name="Last message of /joint_states").click()
    heard(say_joints, page.locator(".topic-message:visible").get_by_text("position"))
    assert found_in_panels(page, "Topics") == []
    opened(page, "Node graph")
    page.locator(".vertex[data-id='node:/arm']").click()
    assert found_in_panels(page, "Node graph") == []
    opened(page, "Parameters")
    page.get_by_role("option", name="/arm").click()
    page.get_by_role("textbox", name="speed").fill("fast")
    page.keyboard.press("Enter")
    assert found_in_panels(page, "Parameters") == []
    viewer.run(lambda: logger.error("the arm is hot"))  # what is older than 10 s is told to nobody who asks then
    opened(page, "Log")
    page.locator(".virtual-list").get_by_text("the arm is hot").click()
    assert found_in_panels(page, "Log") == []
    opened(page, "Voice")
    page.locator(".word-box summary").click()
    answer = get_message("std_msgs/msg/String")(data="Turning left.")
    heard(lambda: viewer.publish("/voice/response", answer), page.locator(".voice-said.response"))
    assert found_in_panels(page, "Voice", "Teleop") == []


def test_world_modeling_passes_axe(start, open_page, tmp_path: Path):
    page, _ = modeled(start, open_page, tmp_path)
    page.get_by_role("option", name="crate").click()
    page.locator("[data-key='pose/0'] input").wait_for()
    assert violations(page) == []
    page.get_by_role("button", name="End modeling").click()
    page.get_by_role("button", name="Add a model").click()
    page.locator("dialog[open]").wait_for()
    assert violations(page, "dialog") == []


def test_token_form_and_page_without_webgl_pass_axe(live: Callable[..., LiveViewer], browser: Browser):
    viewer = live(configuration(DISPLAYS))
    with browser.new_context(locale="en-US") as context:
        context.set_default_timeout(1000 * SECONDS)
        context.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
        page = context.new_page()
        page.goto(viewer.url.partition("?")[0])
        page.locator(".door:visible").wait_for()
        assert violations(page) == []
        page.goto(viewer.url)
        page.locator(".no-webgl").wait_for()
        assert violations(page) == []


def test_exported_page_passes_axe(browser: Browser, tmp_path: Path):
    out = tmp_path / "arm.html"
    subprocess.run([sys.executable, "-m", "linkwright", "export", str(out), str(write_arm(tmp_path))], check=True)
    with browser.new_context(locale="en-US", bypass_csp=True) as context:
        context.set_default_timeout(1000 * SECONDS)
        page = context.new_page()
        page.goto(out.as_uri())
        page.get_by_role("slider").first.wait_for()
        assert violations(page) == []


def test_recording_menu_and_playback_pass_axe(start, open_page, tmp_path: Path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    until(page, "lw.timeline?.live && lw.timeline.length > 2")
    record = page.get_by_role("button", name="Record", exact=True)
    record.click()
    assert found_in_menu(page) == []
    record.click()
    page.get_by_role("menuitem", name="Record chosen topics…").click()
    page.locator("dialog[open] [type=checkbox]").first.wait_for()
    assert violations(page, "dialog") == []
    page.keyboard.press("Escape")
    record.click()
    page.get_by_role("menuitem", name="Record all topics").click()
    until(page, "lw.recording.length >= 1")
    assert violations(page) == []
    page.get_by_role("button", name="Stop recording").click()
    page.get_by_role("dialog").get_by_role("button", name="Download").wait_for()
    assert violations(page, "dialog") == []
    (file,) = state(page, "recording")["files"]
    robot_page = open_page(start("view", file), wait=False)
    until(robot_page, "lw.timeline?.live === false && lw.timeline.length > 0.5")
    assert violations(robot_page) == []


def test_robot_editing_and_comparison_pass_axe(start, open_page, tmp_path: Path):
    file = write_arm(tmp_path)
    page = open_page(start("view", str(file)))
    page.get_by_role("tab", name="Links").click()
    page.get_by_text("fore", exact=True).first.click()
    page.get_by_role("button", name="Move and rotate the joint").click()
    for text in ("0.77", "1e400"):
        page.locator("[data-number=xyz2]").fill(text)
        page.locator("[data-number=xyz2]").press("Enter")
        if text == "0.77":
            page.locator(".edit-diff, .edit-refusal").first.wait_for()
        assert found_in_panels(page, "Edit robot") == []
    new = tmp_path / "new.xacro"
    new.write_text(file.read_text().replace('name="fore"', 'name="lower"').replace('link="fore"', 'link="lower"'))
    both = open_page(start("view", str(file), str(new)), wait=False)
    both.locator(".difference-group").first.wait_for()
    assert violations(both) == []
