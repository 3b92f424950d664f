"""Editing of a robot in the page, with numbers and handles.

The tests cover changes of the source in both directions.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.browser.conftest import state, until, wait_until_equal

pytestmark = pytest.mark.browser

ROBOT = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="height" value="0.5"/>
  <xacro:macro name="arm" params="name y">
    <link name="${name}"><visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual></link>
    <joint name="${name}_joint" type="fixed">
      <origin xyz="0.6 ${y} 0"/><parent link="base"/><child link="${name}"/>
    </joint>
  </xacro:macro>
  <link name="base"><visual><geometry><box size="1 1 0.2"/></geometry></visual></link>
  <link name="mast">
    <visual><origin xyz="0 0 0.2"/><geometry><box size="0.2 0.2 0.4"/></geometry></visual>
  </link>
  <joint name="mast_joint" type="revolute">
    <origin xyz="0 0 ${height}"/><parent link="base"/><child link="mast"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <xacro:arm name="left" y="0.6"/>
  <xacro:arm name="right" y="-0.6"/>
</robot>
"""
MAST = "lw.displays.find(({class: c}) => c === 'rviz_default_plugins/RobotModel').drawn.links.mast.visuals[0].bounds"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(ROBOT)
    return path


def start_editing(page, link: str) -> None:
    """Start editing a link from its card."""
    page.get_by_role("tab", name="Links").click()
    page.get_by_text(link, exact=True).first.click()
    page.get_by_role("button", name="Move and rotate the joint").click()
    page.locator(".editing-part").first.wait_for()


def locate_number(page, name: str):
    return page.locator(f"[data-number={name}]")


def type_in(page, name: str, text: str) -> None:
    locate_number(page, name).fill(text)
    locate_number(page, name).press("Enter")


def test_number_edit_is_previewed_written_and_undone(start, open_page, file):
    page = open_page(start("view", str(file)))
    start_editing(page, "mast")
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "0.5")
    until(page, f"Math.abs({MAST}.min[2] - 0.5) < 1e-6")
    type_in(page, "xyz2", "0.8")
    until(page, f"Math.abs({MAST}.min[2] - 0.8) < 1e-6")
    page.get_by_text('+  <xacro:property name="height" value="0.8"/>').wait_for()
    assert file.read_text() == ROBOT

    page.get_by_role("button", name="Write", exact=True).click()
    page.get_by_text("Written: ", exact=False).wait_for()
    assert file.read_text() == ROBOT.replace('"0.5"', '"0.8"')
    until(page, "Math.abs(lw.frames.mast.position[2] - 0.8) < 1e-6")
    until(page, f"Math.abs({MAST}.min[2] - 0.8) < 1e-6")

    page.get_by_role("button", name="Undo the last written edit").click()
    until(page, "Math.abs(lw.frames.mast.position[2] - 0.5) < 1e-6")
    assert file.read_text() == ROBOT
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "0.5")


def test_visual_is_rotated_in_degrees_and_reset(start, open_page, file):
    page = open_page(start("view", str(file)))
    start_editing(page, "mast")
    page.get_by_role("button", name="Visual box").click()
    page.locator(".editing-tools").get_by_role("button", name="deg").click()
    type_in(page, "rpy1", "90")
    until(page, f"Math.abs({MAST}.max[0] - {MAST}.min[0] - 0.4) < 1e-6")
    page.get_by_text('rpy="0 1.570796327 0"', exact=False).wait_for()
    page.get_by_role("button", name="Discard").click()
    until(page, f"Math.abs({MAST}.max[0] - {MAST}.min[0] - 0.2) < 1e-6")
    assert locate_number(page, "rpy1").input_value() == "0"
    assert file.read_text() == ROBOT


def test_handle_moves_link_along_one_axis(start, open_page, file):
    page = open_page(start("view", str(file)))
    start_editing(page, "left")
    wait_until_equal(lambda: locate_number(page, "xyz0").input_value(), "0.6")
    page.get_by_role("button", name="Snap to a grid").click()
    canvas = page.locator("canvas").first.bounding_box()
    until(page, "lw.panels.editing.handles !== undefined")
    handle = state(page, "panels.editing.handles.z")
    x, y = canvas["x"] + handle["x"], canvas["y"] + handle["y"]
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 6):
        page.mouse.move(x, y - 12 * step)
    page.mouse.up()
    until(page, "lw.panels.editing.draft !== null && lw.panels.editing.draft.xyz[2] > 0.01")
    position = state(page, "panels.editing.draft.xyz")
    assert position[:2] == [0.6, 0.6]
    assert position[2] == pytest.approx(round(position[2], 2), abs=1e-12)
    page.get_by_text("would also change joint 'right_joint'", exact=False).wait_for()


def test_edit_of_macro_used_twice_requires_confirmation(start, open_page, file):
    page = open_page(start("view", str(file)))
    start_editing(page, "left")
    type_in(page, "xyz2", "0.1")
    page.get_by_text("would also change joint 'right_joint'", exact=False).wait_for()
    assert page.get_by_role("button", name="Write", exact=True).is_disabled()
    page.get_by_role("button", name="Change all").click()
    page.get_by_text("Also changes: joint 'right_joint'").wait_for()
    page.get_by_role("button", name="Write", exact=True).click()
    until(page, "Math.abs(lw.frames.right.position[2] - 0.1) < 1e-6")
    assert file.read_text() == ROBOT.replace("${y} 0", "${y} 0.1")


def test_file_changed_meanwhile_is_not_overwritten(start, open_page, file):
    page = open_page(start("view", str(file)))
    start_editing(page, "mast")
    type_in(page, "xyz2", "0.8")
    page.get_by_text('value="0.8"', exact=False).wait_for()
    external_text = ROBOT.replace('value="0.5"', 'value="0.7"')
    file.write_text(external_text)
    until(page, "Math.abs(lw.frames.mast.position[2] - 0.7) < 1e-6")
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "0.7")
    assert page.get_by_role("button", name="Write", exact=True).is_disabled()
    assert file.read_text() == external_text


def test_edit_diff_is_shown_beside_numbers(start, browser, file: Path) -> None:
    page = browser.new_page(viewport={"width": 1024, "height": 768}, locale="en-US")
    page.goto(start("view", str(file)).url)
    page.wait_for_function("window.linkwright?.ready === true")
    start_editing(page, "mast")
    type_in(page, "xyz0", "0.1")
    page.locator(".edit-diff").first.wait_for()
    text, numbers = page.locator(".edit-text").bounding_box(), page.locator(".editing-numbers").bounding_box()
    assert text is not None
    assert numbers is not None
    assert text["x"] >= numbers["x"] + numbers["width"]
    assert text["height"] > 100
    page.close()


def test_diff_of_long_line_shows_changed_values(start, browser, file: Path) -> None:
    line = '<joint name="mast_joint" type="revolute"> <!-- {} -->\n    <origin'.format(
        "how the mast stands on its base, " * 5
    )
    file.write_text(ROBOT.replace('<joint name="mast_joint" type="revolute">\n    <origin', line.replace("\n   ", "")))
    page = browser.new_page(viewport={"width": 1024, "height": 768}, locale="en-US")
    page.goto(start("view", str(file)).url)
    page.wait_for_function("window.linkwright?.ready === true")
    start_editing(page, "mast")
    type_in(page, "xyz0", "0.1")
    page.locator(".edit-diff mark").first.wait_for()
    text = page.locator(".edit-text").bounding_box()
    assert page.locator(".edit-diff mark").all_inner_texts() == ["0", "0.1"]
    for mark in page.locator(".edit-diff mark").all():
        box = mark.bounding_box()
        assert text["y"] <= box["y"]
        assert box["y"] + box["height"] <= text["y"] + text["height"]
    page.close()


def test_link_card_is_hidden_while_editing(start, open_page, file: Path) -> None:
    page = open_page(start("view", str(file)))
    start_editing(page, "mast")
    card = page.locator(".selection-card")
    card.wait_for(state="hidden")
    page.get_by_role("tab", name="Edit robot").hover()
    page.get_by_role("tab", name="Edit robot").locator(".tab-close").click()
    card.wait_for(state="visible")


def test_camera_moves_to_handles_that_are_out_of_view(start, open_page, file: Path) -> None:
    joint = '<origin xyz="0 0 4"/><parent link="base"/><child link="far"/>'
    far_link = f'<link name="far"/><joint name="far_joint" type="fixed">{joint}</joint>\n</robot>'
    file.write_text(ROBOT.replace("</robot>", far_link))
    page = open_page(start("view", str(file)))
    yaw = state(page, "view.yaw")
    start_editing(page, "mast")
    until(page, "lw.panels.editing.handles !== undefined")
    assert state(page, "view.yaw") == yaw, "the view stays if the handles are visible"
    page.get_by_role("tab", name="Links").click()
    page.get_by_text("far", exact=True).first.click()
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "4")
    size = page.locator(".canvas-box canvas").bounding_box()

    def is_in_sight() -> bool:
        handle_positions = state(page, "panels.editing.handles").values()
        return all(0 < tip["x"] < size["width"] and 0 < tip["y"] < size["height"] for tip in handle_positions)

    wait_until_equal(is_in_sight, True)
    assert state(page, "view.yaw") == yaw, "the direction of the view stays"
    assert state(page, "view.distance") > 4, "the camera moves back, so that the robot is visible too"


def test_joint_axis_has_only_rotation_handles(start, open_page, file: Path) -> None:
    page = open_page(start("view", str(file)))
    start_editing(page, "mast")
    tools = page.locator(".editing-tools")
    frames, lengths = tools.get_by_label("The axes that the handles follow"), tools.get_by_label("Grid, m")
    frames.wait_for()
    page.locator(".editing-part", has_text="Axis").click()
    frames.wait_for(state="hidden")
    lengths.wait_for(state="hidden")
    assert tools.get_by_role("button", name="Show handles that move the part").count() == 0
    page.locator(".editing-part", has_text="Visual").click()
    frames.wait_for()


def test_low_panel_shows_parts_numbers_and_diff_without_scrolling(start, browser, file: Path) -> None:
    file.write_text(
        ROBOT.replace('name="mast_joint" type="revolute">\n    <origin', 'name="mast_joint" type="revolute"><origin')
    )
    page = browser.new_page(viewport={"width": 800, "height": 600}, locale="zh-CN")
    page.goto(start("view", str(file)).url)
    page.wait_for_function("window.linkwright?.ready === true")
    page.get_by_role("tab", name="连杆").click()
    page.get_by_text("mast", exact=True).first.click()
    page.get_by_role("button", name="移动和转动此连杆").click()
    page.locator(".editing-part").first.wait_for()
    type_in(page, "xyz0", "0.1")
    page.locator(".edit-diff mark").first.wait_for()
    assert page.locator(".edit-diff mark").all_inner_texts() == ["0", "0.1"]
    selector = ".editing-part, .editing-number .field, .editing-tools select, .edit-diff mark, .edit-bar .primary"
    panel = page.locator(".editing-panel").bounding_box()
    text = page.locator(".edit-text").bounding_box()
    assert panel is not None
    assert text is not None
    for element in page.locator(selector).all():
        box = element.bounding_box()
        assert box is not None
        container = text if element.evaluate("(e) => e.tagName") == "MARK" else panel
        assert container["y"] <= box["y"] + 1, element.inner_text()
        assert box["y"] + box["height"] <= container["y"] + container["height"] + 1, element.inner_text()
    page.close()
