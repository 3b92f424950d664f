"""The panels of the description.

Tree, diagram, source and joint table show the same element.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.browser.arm import SEGMENT_JOINT, SEGMENT_LINK, write_arm
from tests.browser.conftest import state, until

pytestmark = pytest.mark.browser


@pytest.fixture
def arm(tmp_path):
    return write_arm(tmp_path)


@pytest.fixture
def page(start, open_page, arm):
    page = open_page(start("view", str(arm)))
    page.locator(".panel-tab", has_text="Links").click()
    return page


def open_panel(page, name):
    page.locator(".title-bar").get_by_text("Panels", exact=True).click()
    page.get_by_role("menuitemcheckbox", name=name, exact=True).click()
    page.locator(".panel-tab", has_text=name).first.click()


def marked_elements(page, panel):
    return [(mark["from"], mark["to"]) for mark in state(page, f"panels.source.{panel}.marks")]


def test_clicked_link_is_selected_and_marked_in_both_sources(page, arm):
    open_panel(page, "Source")
    page.locator('[data-link="fore"]').click()
    until(page, "lw.selected?.link === 'fore' && lw.panels.source.origin.marks.length === 1")
    assert state(page, "panels.source.origin.file") == str(arm.parent / "segment.xacro")
    assert marked_elements(page, "origin") == [SEGMENT_LINK]
    ((first, last),) = marked_elements(page, "expanded")
    assert page.locator(f'.source-line.focus[data-line="{first}"]').first.inner_text().endswith('<link name="fore">')
    assert last - first > 10

    # A click opens the macro call that created the link.
    call = page.locator(".trail-step")
    assert call.inner_text() == "macro segment, called at …/arm.xacro:14"
    call.click()
    until(page, f"lw.panels.source.origin.file === {str(arm)!r}")
    assert marked_elements(page, "origin") == [(14, 14)]

    # A joint is a separate element; the scene selects the link that it moves.
    page.locator('.joint-of[data-joint="upper_joint"]').click()
    until(page, "lw.description.focus?.kind === 'joint' && lw.selected?.link === 'upper'")
    until(page, "lw.panels.source.origin.file.endsWith('segment.xacro') && lw.panels.source.origin.marks.length === 1")
    assert marked_elements(page, "origin") == [SEGMENT_JOINT]

    # A line of a macro belongs to one element of each call; each click selects the next of these elements.
    line = page.locator('.source-pane >> nth=0 >> .source-line[data-line="20"]')
    line.click()
    until(page, "lw.description.focus.name === 'fore_joint' && lw.selected.link === 'fore'")
    line.click()
    until(page, "lw.description.focus.name === 'upper_joint'")


def test_link_tree_is_searched_and_navigated_by_keyboard(page):
    search = page.get_by_label("Find links and joints")
    search.fill("finger_jo")
    page.wait_for_function("document.querySelectorAll('.link-row').length === 5")
    search.fill("upper")
    page.wait_for_function("document.querySelectorAll('.link-row').length === 2")
    search.fill("")
    page.locator('[data-link="base"]').click()
    page.keyboard.press("ArrowDown")
    until(page, "lw.selected.link === 'upper'")
    page.keyboard.press("ArrowDown")
    until(page, "lw.selected.link === 'fore'")
    page.keyboard.press("Enter")
    until(page, "lw.description.focus.name === 'fore_joint'")
    page.keyboard.press("ArrowLeft")  # folds the row
    page.wait_for_function("document.querySelectorAll('.link-row').length === 3")


def test_diagram_and_joint_table_show_and_select_all_elements(page):
    open_panel(page, "Diagram")
    until(page, "lw.panels.diagram.links === 5 && lw.panels.diagram.joints === 4")
    assert "xyz: 0 0 0.4" in page.locator('.node[data-joint="fore_joint"]').text_content()
    assert state(page, "panels.diagram.scale") >= 10 / 11  # texts of 11 pixels are at least 10 pixels high
    page.locator(".diagram").focus()
    page.keyboard.press("0")  # shows the whole diagram
    page.locator('.node[data-joint="slide_joint"] .name').click()
    until(page, "lw.description.focus.name === 'slide_joint'")
    page.locator('.node[data-link="base"] .name').click()
    until(page, "lw.selected.link === 'base'")
    scale = state(page, "panels.diagram.scale")
    page.locator(".diagram").hover()
    page.mouse.wheel(0, -480)
    until(page, f"Math.abs(lw.panels.diagram.scale / {scale} - 2) < 0.01")

    open_panel(page, "Joint Table")
    row = page.locator('tr[data-joint="fore_joint"] td')
    assert row.all_inner_texts() == [
        *("fore_joint", "revolute", "upper", "fore", "0 1 0", "-0.5 rad", "2 rad", "1.5 rad/s", "30 N m", ""),
        *("damping 0.4, friction 0.1", ""),
    ]
    assert "-0.5 × slide_joint + 0.01 m" in page.locator('tr[data-joint="finger_joint"]').inner_text()
    page.locator("th button", has_text="Upper").click()
    names = page.locator("tr[data-joint]").evaluate_all("rows => rows.map(row => row.dataset.joint)")
    assert names == ["finger_joint", "slide_joint", "upper_joint", "fore_joint"]
    page.locator('tr[data-joint="slide_joint"]').click()
    until(page, "lw.description.focus.name === 'slide_joint' && lw.selected.link === 'slide'")


def test_edited_link_flashes_and_finding_leads_to_source(page, arm):
    page.locator('.link-row[data-link="fore"]').wait_for()  # wait for the highlighted row
    revision = state(page, "description.revision")
    page.evaluate("""() => {
        window.lit = new Set();
        setInterval(() => document.querySelectorAll(".link-row.flash").forEach((row) => lit.add(row.dataset.link)), 50);
    }""")
    valid_text = arm.read_text().replace('length="0.3" mass="1"', 'length="0.35" mass="1"')
    arm.write_text(valid_text)
    until(page, f"lw.description.revision > {revision} && lw.description.edited.includes('fore')")
    assert state(page, "description.edited") == ["fore"]
    page.wait_for_function("window.lit.size > 0")
    page.locator(".link-row.flash").wait_for(state="detached")
    assert page.evaluate("[...window.lit]") == ["fore"]

    arm.write_text(valid_text.replace('mass="2"', 'mas="2"'))
    page.locator(".panel-tab", has_text="Diagnostics (").click()
    page.locator(".diagnostic button.place").first.click()
    until(page, f"lw.panels.source.origin.file === {str(arm)!r}")
    problem = page.locator(".source-line.problem", has_text='mas="2"')
    problem.wait_for()
    arm.write_text(valid_text)
    problem.wait_for(state="detached")


def test_robot_broken_at_start_is_shown_without_tf_once_fixed(start, open_page, tmp_path):
    file = tmp_path / "robot.urdf.xacro"
    valid_text = Path(write_arm(tmp_path)).read_text()
    file.write_text(valid_text.replace("</robot>", "<link/></robot>"))
    page = open_page(start("view", str(file)), wait=False)
    page.locator(".banner").wait_for()
    page.locator(".waiting").wait_for(state="hidden")  # only the banner shows the reason
    file.write_text(valid_text)
    until(page, "lw.robot?.visuals > 0 && lw.ready")
    page.locator(".banner").wait_for(state="hidden")
    displays = {display["class"].rpartition("/")[2]: display["enabled"] for display in state(page, "displays")}
    assert displays == {"Grid": True, "RobotModel": True, "TF": False}
