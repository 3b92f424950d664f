"""All views of the page pass axe-core, in dark and in light colors."""

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
from tests.browser.axe import find_violations
from tests.browser.conftest import TIMEOUT_S, state, until, wait_until_equal
from tests.browser.live import LiveViewer, configuration
from tests.browser.test_modeling import open_modeling
from tests.browser.test_overlays import unfold_overlays

pytestmark = pytest.mark.browser

TWIST = get_message("geometry_msgs/msg/Twist")
JOINTS = get_message("sensor_msgs/msg/JointState")
DISPLAYS = """
- {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}
- {Class: rviz_default_plugins/Image, Name: Front, Enabled: true, Topic: {Value: /front}}
- {Class: my_plugins/Radar, Name: Radar, Enabled: true}
"""
OVERLAYS = ".overlay"


def open_panel(page: Page, name: str) -> str:
    """Open a panel or bring it to the front, and return the selector of its group."""
    tab = page.locator(".dv-tab", has_text=name)
    if tab.count() == 0:
        page.get_by_role("button", name="Panels", exact=True).click()
        page.get_by_role("menuitemcheckbox", name=name, exact=True).click()
    tab.first.dispatch_event("pointerdown")
    page.locator(".dv-tab[aria-selected=true]", has_text=name).first.wait_for(state="attached")
    return f".dv-groupview:has([data-tab-panel-id='{tab.first.get_attribute('data-tab-panel-id')}'])"


def find_panel_violations(page: Page, *names: str) -> list[str]:
    return [f"{name}: {violation}" for name in names for violation in find_violations(page, open_panel(page, name))]


def find_menu_violations(page: Page) -> list[str]:
    """Return the violations in the open menu, and close it."""
    page.get_by_role("menu").wait_for()
    found_violations = find_violations(page, ".menu")
    page.keyboard.press("Escape")
    return found_violations


def find_dialog_violations(page: Page, keys: str) -> list[str]:
    """Return the violations in the dialog that a key combination opens."""
    page.keyboard.press(keys)
    page.locator("dialog[open]").wait_for()
    found_violations = find_violations(page, "dialog")
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
    unfold_overlays(page)
    page.locator(".selection-card .provenance").wait_for()
    page.locator(".inspect > button").click()  # the clicks on rows have closed the card of Inspect
    assert find_violations(page) == []
    for name in ("File", "Panels", "Share", "Colors"):
        page.get_by_role("button", name=name, exact=True).click()
        assert find_menu_violations(page) == []
    for keys in ("?", "Control+o", "Control+Shift+s"):
        assert find_dialog_violations(page, keys) == []
    panels = ("Joints", "Links", "Diagram", "Source", "Joint Table", "Edit robot")
    assert find_panel_violations(page, "Views", "Tool Properties", "Selection", "Transformation", *panels) == []
    file.write_text(file.read_text().replace("</robot>", "<link/></robot>"))
    page.locator(".banner").wait_for()
    assert find_violations(page, OVERLAYS) == []
    assert find_panel_violations(page, "Diagnostics") == []


FOCUS_RING = """() => {
  const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(document.activeElement);
  const name = document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent;
  const ring = (outlineStyle !== "none" && parseFloat(outlineWidth) >= 2) || boxShadow !== "none";
  return [name, ring || document.activeElement.matches(".slider"), document.activeElement === document.body];
}"""
"""Return the focused element's name, whether it has a ring (a slider's thumb has it), and whether it is the body."""


def test_keyboard_focus_has_visible_ring(start, open_page, tmp_path: Path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    focused_elements: list[str] = []
    for _ in range(150):
        page.keyboard.press("Tab")
        name, has_ring, is_end = page.evaluate(FOCUS_RING)
        if is_end:
            break
        assert has_ring, name
        focused_elements.append(name)
    assert len(focused_elements) > 40, focused_elements


def test_displays_menu_and_dialogs_pass_axe(start_viewer: Callable[..., LiveViewer], open_page):
    page = open_page(start_viewer(configuration(DISPLAYS)), wait=False)
    until(page, "lw.displays.length === 3")
    row = page.locator("[data-key='display-1'] .row-title")
    row.click()
    for keys in ("Alt+a", "F2"):
        assert find_dialog_violations(page, keys) == []
    row.dblclick()
    assert find_violations(page) == []
    row.click(button="right")
    assert find_menu_violations(page) == []


def publish_until_shown(publish: Callable[[], None], shown_text: Locator) -> None:
    """Publish a text until the page shows it; the page may subscribe a moment later."""

    def is_shown() -> bool:
        publish()
        return shown_text.count() > 0

    wait_until_equal(is_shown, True)


def test_live_panels_pass_axe(start_viewer: Callable[..., LiveViewer], open_page):
    viewer = start_viewer(configuration(DISPLAYS))

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
    open_panel(page, "Plots")
    page.get_by_role("button", name="Add a series").first.click()
    assert find_panel_violations(page, "Plots") == []
    for text in ("/joint_states.position[0]", "/joint_states.wrong"):
        page.get_by_role("combobox", name="Topic and field").fill(text)
        page.keyboard.press("Enter")
        say_joints()
        page.get_by_role("button", name="Add a series").first.click()
    publish_until_shown(say_joints, page.get_by_text("has no field"))
    assert find_panel_violations(page, "Plots") == []
    open_panel(page, "Topics")
    page.get_by_role("button", name="Last message of /joint_states").click()
    publish_until_shown(say_joints, page.locator(".topic-message:visible").get_by_text("position"))
    assert find_panel_violations(page, "Topics") == []
    open_panel(page, "Node graph")
    page.locator(".vertex[data-id='node:/arm']").click()
    assert find_panel_violations(page, "Node graph") == []
    open_panel(page, "Parameters")
    page.get_by_role("option", name="/arm").click()
    page.get_by_role("textbox", name="speed").fill("fast")
    page.keyboard.press("Enter")
    assert find_panel_violations(page, "Parameters") == []
    viewer.run(lambda: logger.error("the arm is hot"))  # a late subscriber gets no records older than 10 s
    open_panel(page, "Log")
    page.locator(".virtual-list").get_by_text("the arm is hot").click()
    assert find_panel_violations(page, "Log") == []
    open_panel(page, "Voice")
    page.locator(".word-box summary").click()
    answer = get_message("std_msgs/msg/String")(data="Turning left.")
    publish_until_shown(lambda: viewer.publish("/voice/response", answer), page.locator(".voice-said.response"))
    assert find_panel_violations(page, "Voice", "Teleop") == []


def test_world_modeling_passes_axe(start, open_page, tmp_path: Path):
    page, _ = open_modeling(start, open_page, tmp_path)
    page.get_by_role("option", name="crate").click()
    page.locator("[data-key='pose/0'] input").wait_for()
    assert find_violations(page) == []
    page.get_by_role("button", name="End modeling").click()
    page.get_by_role("button", name="Add a model").click()
    page.locator("dialog[open]").wait_for()
    assert find_violations(page, "dialog") == []


def test_token_form_and_page_without_webgl_pass_axe(start_viewer: Callable[..., LiveViewer], browser: Browser):
    viewer = start_viewer(configuration(DISPLAYS))
    with browser.new_context(locale="en-US") as context:
        context.set_default_timeout(1000 * TIMEOUT_S)
        context.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
        page = context.new_page()
        page.goto(viewer.url.partition("?")[0])
        page.locator(".door:visible").wait_for()
        assert find_violations(page) == []
        page.goto(viewer.url)
        page.locator(".no-webgl").wait_for()
        assert find_violations(page) == []


def test_exported_page_passes_axe(browser: Browser, tmp_path: Path):
    exported_file = tmp_path / "arm.html"
    subprocess.run(
        [sys.executable, "-m", "linkwright", "export", str(exported_file), str(write_arm(tmp_path))], check=True
    )
    with browser.new_context(locale="en-US", bypass_csp=True) as context:
        context.set_default_timeout(1000 * TIMEOUT_S)
        page = context.new_page()
        page.goto(exported_file.as_uri())
        page.get_by_role("slider").first.wait_for()
        assert find_violations(page) == []


def test_recording_menu_and_playback_pass_axe(start, open_page, tmp_path: Path):
    page = open_page(start("view", str(write_arm(tmp_path))))
    until(page, "lw.timeline?.live && lw.timeline.length > 2")
    record = page.get_by_role("button", name="Record", exact=True)
    record.click()
    assert find_menu_violations(page) == []
    record.click()
    page.get_by_role("menuitem", name="Record chosen topics…").click()
    page.locator("dialog[open] [type=checkbox]").first.wait_for()
    assert find_violations(page, "dialog") == []
    page.keyboard.press("Escape")
    record.click()
    page.get_by_role("menuitem", name="Record all topics").click()
    until(page, "lw.recording.length >= 1")
    assert find_violations(page) == []
    page.get_by_role("button", name="Stop recording").click()
    page.get_by_role("dialog").get_by_role("button", name="Download").wait_for()
    assert find_violations(page, "dialog") == []
    (file,) = state(page, "recording")["files"]
    robot_page = open_page(start("view", file), wait=False)
    until(robot_page, "lw.timeline?.live === false && lw.timeline.length > 0.5")
    assert find_violations(robot_page) == []


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
        assert find_panel_violations(page, "Edit robot") == []
    new = tmp_path / "new.xacro"
    new.write_text(file.read_text().replace('name="fore"', 'name="lower"').replace('link="fore"', 'link="lower"'))
    comparison_page = open_page(start("view", str(file), str(new)), wait=False)
    comparison_page.locator(".difference-group").first.wait_for()
    assert find_violations(comparison_page) == []
