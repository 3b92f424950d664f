"""Editing of a robot's files in the page.

The tests cover findings, completion, saving, and notices of external changes.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.browser.axe import find_violations
from tests.browser.conftest import until, wait_until_equal
from tests.browser.test_description import open_panel
from tests.browser.test_editing import locate_number, type_in

pytestmark = pytest.mark.browser

ROBOT = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="leg.xacro"/>
  <link name="base"><visual><geometry><box size="1 1 0.2"/></geometry></visual></link>
  <xacro:leg name="left"/>
</robot>
"""
LEG = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="leg" params="name">
    <link name="${name}"><visual><geometry><box size="0.1 0.1 0.6"/></geometry></visual></link>
    <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
  </xacro:macro>
</robot>
"""
EDITOR = "lw.panels.source.editor"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    package = tmp_path / "leg_description"
    package.mkdir()
    (package / "package.xml").write_text(
        '<package format="3"><name>leg_description</name><version>1.0.0</version><description>A leg.</description>'
        '<maintainer email="a@b.org">A</maintainer><license>MIT</license></package>\n'
    )
    (package / "leg.xacro").write_text(LEG)
    path = package / "robot.urdf.xacro"
    path.write_text(ROBOT)
    return path


def open_editor(page):
    """Open the editor with the main file, and put the cursor at its start."""
    open_panel(page, "Source")
    page.get_by_role("button", name="Edit", exact=True).click()
    until(page, f"{EDITOR}.file?.endsWith('robot.urdf.xacro')")
    text = page.locator(".cm-content")
    text.click(position={"x": 30, "y": 8})
    text.press("Control+Home")
    return text


def wait_for_text(page, line: str) -> None:
    """Wait until the editor shows a text."""
    page.wait_for_function("part => window.linkwright.panels.source.editor.text?.includes(part)", arg=line, polling=50)


def move_cursor(text, line: int, column: int = 0) -> None:
    """Put the cursor on a line, given from the start of its text."""
    text.press("Control+Home")
    for _ in range(line - 1):
        text.press("ArrowDown")
    for _ in range(column):
        text.press("ArrowRight")


def test_file_is_edited_and_saved_and_robot_follows(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 4)
    text.press("End")
    page.keyboard.insert_text('\n  <xacro:leg name="right"/>')
    until(page, f"{EDITOR}.unsaved.length === 1")
    text.press("Control+s")
    page.get_by_text("Saved: robot.urdf.xacro").wait_for()
    wait_until_equal(file.read_text, ROBOT.replace("</robot>", '  <xacro:leg name="right"/>\n</robot>'))
    until(page, "lw.frames.right !== undefined")
    text.press("Control+z")
    page.locator(".editor-bar").get_by_role("button", name="Save", exact=True).click()
    wait_until_equal(file.read_text, ROBOT)


def test_change_on_disk_is_merged_or_reported_as_conflict(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 1)
    text.press("End")
    page.keyboard.insert_text("<!-- mine -->")
    file.write_text(ROBOT.replace("0.2", "0.3"))
    wait_for_text(page, "1 1 0.3")
    wait_for_text(page, "<!-- mine -->")
    until(page, f"!{EDITOR}.isConflict && {EDITOR}.unsaved.length === 1")

    file.write_text(ROBOT.replace('wiki/xacro">', 'wiki/xacro"><!-- theirs -->'))
    until(page, f"{EDITOR}.isConflict")
    page.get_by_role("button", name="Take the file").click()
    wait_for_text(page, "<!-- theirs -->")
    text.press("Control+z")
    wait_for_text(page, "<!-- mine -->")
    text.press("Control+s")
    wait_until_equal(file.read_text, ROBOT.replace("0.2", "0.3").replace('wiki/xacro">', 'wiki/xacro"><!-- mine -->'))


def test_robot_edits_and_text_edits_share_undo_history(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    page.get_by_role("tab", name="Links").click()
    page.get_by_text("left", exact=True).locator("visible=true").first.click()
    page.get_by_role("button", name="Move and rotate the joint").click()
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "0")
    type_in(page, "xyz2", "0.4")
    page.get_by_role("button", name="Write", exact=True).click()
    leg = file.parent / "leg.xacro"
    wait_until_equal(lambda: "0.4" in leg.read_text(), True)
    page.locator(".panel-tab", has_text="Source").first.click()
    wait_for_text(page, "0.4")
    page.mouse.move(0, 0)  # the tooltip of an element below the pointer could cover the tab
    text.focus()
    text.press("Control+z")
    text.press("Control+s")
    wait_until_equal(leg.read_text, LEG)

    page.locator(".panel-tab", has_text="Edit robot").first.click()
    undo = page.get_by_role("button", name="Undo the last written edit")
    undo.click()
    wait_until_equal(lambda: "0.4" in leg.read_text(), True)
    undo.click()
    wait_until_equal(leg.read_text, LEG)


def test_findings_completion_hover_definition_and_rename(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 4, 9)  # in xacro:leg
    text.press("F12")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.cursor === 2")
    text.press("Control+Home")
    move_cursor(text, 2, 23)  # in the name of the macro
    text.press("F2")
    name = page.get_by_role("textbox", name="New name")
    name.fill("limb")
    name.press("Enter")
    page.get_by_role("dialog", name="Rename leg to limb").get_by_role("button", name="Rename", exact=True).click()
    page.get_by_text("Renamed to limb in 2 files, not saved yet").wait_for()
    page.get_by_role("button", name="Save 2 files").click()
    wait_until_equal(file.read_text, ROBOT.replace("xacro:leg", "xacro:limb"))
    wait_until_equal((file.parent / "leg.xacro").read_text, LEG.replace('"leg"', '"limb"'))

    move_cursor(text, 3)
    text.press("End")
    page.keyboard.type("\n<in", delay=20)
    page.locator(".cm-tooltip-autocomplete li").filter(has_text="inertial").first.wait_for()
    text.press("Escape")
    for _ in range(3):
        text.press("Backspace")
    page.keyboard.insert_text('<link name="${nam}"/>')
    until(page, f"{EDITOR}.findings.includes('XAC201')")
    page.locator(".cm-lintRange").first.wait_for()
    text.press("Control+Home")
    text.press("F8")
    until(page, f"{EDITOR}.cursor === 4 && {EDITOR}.scene === 'errors'")
    page.locator(".cm-line").nth(1).get_by_text("macro", exact=False).first.hover()
    page.locator(".cm-lsp-hover-tooltip").wait_for()


def test_file_is_created_in_tree_and_escape_leaves_editor(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    page.get_by_role("button", name="Files", exact=True).click()
    page.get_by_role("treeitem", name="leg.xacro").click()
    until(page, f"{EDITOR}.file.endsWith('leg.xacro')")
    page.get_by_role("button", name="New file").click()
    name = page.get_by_role("textbox", name="Path of the new file")
    name.fill("config/legs.yaml")
    name.press("Enter")
    until(page, f"{EDITOR}.file.endsWith('config/legs.yaml')")
    page.get_by_role("treeitem", name="legs.yaml").wait_for()
    text.click(position={"x": 30, "y": 8})
    page.keyboard.insert_text("legs: 2\n")
    text.press("Control+s")
    wait_until_equal((file.parent / "config" / "legs.yaml").read_text, "legs: 2\n")

    text.press("Tab")
    wait_for_text(page, "legs: 2\n  ")
    text.press("Escape")
    text.press("Tab")
    page.wait_for_function("!document.activeElement.closest('.cm-editor')")


def test_source_editor_passes_axe(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    page.get_by_role("button", name="Files", exact=True).click()
    move_cursor(text, 3)
    text.press("End")
    page.keyboard.insert_text('<link name="${nam}"/>')
    until(page, f"{EDITOR}.findings.includes('XAC201')")
    page.locator(".editor-bar").get_by_role("button", name="1 finding").click()
    text.press("Control+f")
    page.locator(".cm-search").wait_for()
    assert find_violations(page, ".source-panel") == []
    assert page.evaluate("document.body.scrollHeight <= document.body.clientHeight")


def choose_menu_entry(page, label: str) -> None:
    """Choose an entry of the open menu with the keyboard."""
    page.get_by_role("menuitem").first.wait_for()
    labels = page.get_by_role("menuitem").all_inner_texts()
    for _ in range(labels.index(label)):
        page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")


def test_code_actions_fix_findings_and_extract_values(start, open_page, file):
    leg = file.parent / "leg.xacro"
    continuous_leg = LEG.replace('type="fixed">', 'type="continuous"><axis xyz="0 0 2"/>')
    leg.write_text(continuous_leg)
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 2)
    text.press("Control+.")
    page.get_by_text("There is no fix or refactoring here.").wait_for()

    move_cursor(text, 4, 9)
    text.press("F12")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.findings.includes('LW221')")
    page.get_by_text("= left_joint").wait_for()  # the line is redrawn when its values arrive
    page.locator(".cm-lintRange").first.hover()
    page.get_by_role("button", name="Fix…").click()
    choose_menu_entry(page, "apply all safe fixes in this file")
    wait_for_text(page, 'xyz="0 0 1"')
    page.get_by_text("changed 1 file, not saved yet").wait_for()
    until(page, "document.activeElement.matches('.cm-content')")
    text.press("Control+z")
    wait_for_text(page, 'xyz="0 0 2"')
    until(page, f"{EDITOR}.findings.includes('LW221')")

    text.press("Control+Home")
    text.press("F8")
    text.press("Control+.")
    choose_menu_entry(page, "extract '0 0 2' to a property")
    wait_for_text(page, "<xacro:property")
    assert leg.read_text() == continuous_leg


def test_urdf_is_converted_to_new_xacro_file(start, open_page, file):
    urdf = file.parent / "plain.urdf"
    urdf.write_text('<robot name="r">\n  <link name="base"/>\n</robot>\n')
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    page.get_by_role("button", name="Files", exact=True).click()
    page.get_by_role("treeitem", name="plain.urdf").click()
    until(page, f"{EDITOR}.file.endsWith('plain.urdf')")
    move_cursor(text, 1, 2)
    page.locator(".editor-bar").get_by_role("button", name="Actions").click()
    page.get_by_role("menuitem", name="xacro").first.wait_for()
    page.get_by_role("menuitem", name="xacro").first.click()
    until(page, f"{EDITOR}.file.endsWith('plain.urdf.xacro')")
    wait_for_text(page, "xmlns:xacro")
    text.press("Control+s")
    wait_until_equal(lambda: "xmlns:xacro" in (file.parent / "plain.urdf.xacro").read_text(), True)


def test_definitions_and_references_navigate_across_files(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 4, 9)  # in xacro:leg
    text.press("F12")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.cursor === 2")
    move_cursor(text, 2, 23)  # in the name of the macro
    text.press("Shift+F12")
    page.get_by_role("listbox", name="2 references").wait_for()
    locations = page.locator(".place-list-place")
    assert [" ".join(line.split()) for line in locations.all_inner_texts()] == [
        '2 <xacro:macro name="leg" params="name">',
        '4 <xacro:leg name="left"/>',
    ]
    assert find_violations(page, ".source-panel") == []
    page.keyboard.press("ArrowDown")
    page.keyboard.press("End")
    page.keyboard.press("Enter")
    until(page, f"{EDITOR}.file.endsWith('robot.urdf.xacro') && {EDITOR}.cursor === 4")
    text.press("Control+Home")
    page.keyboard.insert_text("\n")  # the following locations move with the text
    text.press("Alt+ArrowLeft")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.cursor === 2")
    text.press("Alt+ArrowLeft")
    until(page, f"{EDITOR}.file.endsWith('robot.urdf.xacro') && {EDITOR}.cursor === 5")
    text.press("Alt+ArrowRight")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro')")
    locations.last.click()
    until(page, f"{EDITOR}.file.endsWith('robot.urdf.xacro') && {EDITOR}.cursor === 5")
    locations.first.focus()
    page.keyboard.press("Escape")
    until(page, "document.activeElement.matches('.cm-content')")
    page.locator(".cm-line").nth(4).get_by_text("leg").first.click(modifiers=["Control"])
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.cursor === 2")
    move_cursor(text, 1)
    text.press("F12")
    page.get_by_text("There is no definition of this.").wait_for()


def test_scene_follows_unsaved_text_and_keeps_last_valid_robot(start, open_page, file):
    program = start("view", str(file))
    page = open_page(program)
    text = open_editor(page)
    move_cursor(text, 3, 10)
    until(page, "lw.description.focus?.name === 'base'")  # the link at the cursor is selected in the scene
    text.press("End")
    page.keyboard.insert_text('\n  <xacro:leg name="right"/>')
    until(page, f"lw.frames.right !== undefined && {EDITOR}.scene === 'shown'")
    page.get_by_text("The scene shows the unsaved text").wait_for()
    until(page, "lw.description.links === 3")
    page.keyboard.insert_text("<link name=")
    until(page, f"{EDITOR}.scene === 'errors'")
    page.get_by_text("The scene shows the last robot without errors").wait_for()
    assert page.evaluate("window.linkwright.frames.right !== undefined")
    wait_for_text(page, '<xacro:leg name="right"/><link name=')  # the cursor did not move
    assert file.read_text() == ROBOT
    assert "error[" not in "".join(program.output)

    for _ in range(len("<link name=")):
        text.press("Backspace")
    until(page, f"{EDITOR}.scene === 'shown'")
    text.press("Control+s")
    wait_until_equal(lambda: "right" in file.read_text(), True)
    until(page, f"{EDITOR}.scene === null && lw.frames.right !== undefined")
    move_cursor(text, 4)
    text.press("Shift+ArrowDown")
    text.press("Delete")
    until(page, "lw.frames.right === undefined")
    assert "right" in file.read_text()


def test_scene_edit_changes_unsaved_text_and_shares_undo(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 3)
    text.press("End")
    page.keyboard.insert_text(
        '<link name="tip"/><joint name="j" type="fixed"><parent link="base"/><child link="tip"/></joint>'
    )
    until(page, "lw.frames.tip !== undefined")
    page.get_by_role("tab", name="Links").click()
    page.get_by_text("tip", exact=True).locator("visible=true").first.click()
    page.get_by_role("button", name="Move and rotate the joint").click()
    wait_until_equal(lambda: locate_number(page, "xyz2").input_value(), "0")
    type_in(page, "xyz2", "0.4")
    page.get_by_role("button", name="Write", exact=True).click()
    page.get_by_text("Changed in the editor, not saved yet").wait_for()
    until(page, "Math.abs(lw.frames.tip?.position[2] - 0.4) < 1e-6")
    assert file.read_text() == ROBOT
    undo = page.get_by_role("button", name="Undo the last written edit")
    undo.click()
    until(page, "Math.abs(lw.frames.tip?.position[2]) < 1e-6")
    page.get_by_role("button", name="Redo the edit").click()
    until(page, "Math.abs(lw.frames.tip?.position[2] - 0.4) < 1e-6")

    page.locator(".panel-tab", has_text="Source").first.click()
    wait_for_text(page, "0.4")
    text.click(position={"x": 30, "y": 8})
    text.press("Control+z")
    until(page, f"Math.abs(lw.frames.tip?.position[2]) < 1e-6 && {EDITOR}.unsaved.length === 1")
    text.press("Control+z")
    until(page, f"lw.frames.tip === undefined && {EDITOR}.unsaved.length === 0")


def test_rename_preview_lists_changed_and_unchanged_places(start, open_page, file):
    launch = file.parent / "config" / "arm.yaml"
    launch.parent.mkdir()
    launch.write_text("arm:\n  ros__parameters:\n    base: base\n    base_frame: base\n")
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 3, 15)  # in the name of the link
    text.press("F2")
    name = page.get_by_role("textbox", name="New name")
    name.fill("chassis")
    name.press("Enter")
    preview = page.get_by_role("dialog", name="Rename base to chassis")
    preview.wait_for()
    preview.get_by_text("4 places in 3 files will change.").wait_for()
    preview.get_by_text("these texts are not renamed, because their meaning is uncertain: arm.yaml:3 (base)").wait_for()
    lines = [" ".join(line.split()) for line in preview.locator("li").all_inner_texts()]
    assert lines[0].startswith('3 <link name="basechassis">')
    assert find_violations(page, ".rename-preview") == []
    page.keyboard.press("Escape")
    page.get_by_text("Nothing was renamed.").wait_for()
    until(page, f"document.activeElement.matches('.cm-content') && {EDITOR}.unsaved.length === 0")

    text.press("F2")
    name.fill("chassis")
    name.press("Enter")
    preview.wait_for()
    page.keyboard.press("Enter")
    page.get_by_text("Renamed to chassis in 3 files, not saved yet").wait_for()
    until(page, f"document.activeElement.matches('.cm-content') && {EDITOR}.unsaved.length === 3")
    text.press("F2")
    name.fill("left")
    name.press("Enter")
    page.get_by_text("'chassis' is not renamed: two links would have the same name").wait_for()
    assert preview.count() == 0


def test_inlay_values_hover_and_colors_are_shown_in_text(start, open_page, file):
    leg = file.parent / "leg.xacro"
    text_of_leg = LEG.replace("0.1 0.1 0.6", "${2 * 0.05} 0.1 0.6").replace(
        "</visual>", '<material name="m"><color rgba="0.2 0.6 1 0.5"/></material></visual>'
    )
    leg.write_text(text_of_leg)
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    move_cursor(text, 4, 9)
    text.press("F12")
    hint = page.locator(".cm-inlay-hint")
    hint.first.wait_for()
    assert hint.all_inner_texts() == ["= left", "= 0.1 0.1 0.6", "= left_joint", "= left"]
    assert page.locator(".cm-token-macro.cm-token-definition").inner_text() == "leg"
    assert page.locator(".cm-color > i").evaluate("element => element.style.background") == "rgba(51, 153, 255, 0.5)"

    move_cursor(text, 3)
    text.press("Control+.")
    choose_menu_entry(page, "Choose the color…")
    field = page.locator("input[type=color]")
    field.evaluate("element => { element.value = '#ff0000'; element.dispatchEvent(new Event('change')); }")
    wait_for_text(page, 'rgba="1 0 0 0.5"')
    until(page, f"{EDITOR}.scene === 'shown' && document.activeElement.matches('.cm-content')")
    assert leg.read_text() == text_of_leg
    assert find_violations(page, ".source-panel") == []


def test_symbols_are_searched_in_file_and_workspace(start, open_page, file):
    page = open_page(start("view", str(file)))
    text = open_editor(page)
    text.press("Control+Shift+O")
    search = page.get_by_role("combobox", name="Name")
    names = page.locator(".symbol-search [role=option]")
    names.filter(has_text="base").first.wait_for()
    assert names.all_inner_texts() == ["robot r", "xacro:include leg.xacro", "link base", "xacro:leg left"]
    search.fill("bas")
    wait_until_equal(names.count, 1)
    assert find_violations(page, ".symbol-search") == []
    page.keyboard.press("Control+Shift+O")
    search.fill("name")
    names.filter(has_text="${name}_joint").first.wait_for()
    search.fill("leg")
    names.filter(has_text="leg.xacro:2").first.wait_for()
    page.keyboard.press("Enter")
    until(page, f"{EDITOR}.file.endsWith('leg.xacro') && {EDITOR}.cursor === 2")
    until(page, "document.activeElement.matches('.cm-content')")
