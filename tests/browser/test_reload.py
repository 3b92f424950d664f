"""Changes of the model's file while it is shown.

The tests cover changes, errors and repairs; joint positions and camera stay.
"""

from __future__ import annotations

import shutil

import pytest

from tests.browser.conftest import state, until
from tests.places import PACKAGE

pytestmark = pytest.mark.browser


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "mbot.xacro"
    shutil.copy(PACKAGE / "urdf" / "mbot_base.xacro", path)
    return path


def replace_in_file(path, old, new):
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_model_reloads_after_change_error_and_fix(start_fresh, open_page, model):
    program = start_fresh("launch", "my_robot_description", "display_xacro.launch.py", f"model:={model}")
    page = open_page(program)
    page.locator('[data-joint="left_wheel_joint"] input[type=range]').fill("1.2")
    until(page, "lw.joints.left_wheel_joint > 1")
    joint = state(page, "joints.left_wheel_joint")
    page.keyboard.press("Escape")
    page.mouse.move(600, 400)
    page.mouse.wheel(0, -120)
    until(page, "lw.view.distance < 1.7")
    distance = state(page, "view.distance")

    replace_in_file(model, 'name="wheel_joint_y" value="0.19"', 'name="wheel_joint_y" value="0.25"')
    until(page, "Math.abs(lw.frames.left_wheel_link.position[1] - 0.25) < 1e-6")
    assert state(page, "joints.left_wheel_joint") == joint
    assert state(page, "view.distance") == distance
    until(page, "lw.robot.visuals === 12")

    replace_in_file(model, "<xacro:wheel ", "<xacro:whel ")
    page.get_by_text("there is no macro", exact=False).first.wait_for()
    program.wait_for(r"there is no macro .whel.")
    program.wait_for(r"did you mean")
    assert state(page, "robot.links") == 12
    assert state(page, "frames.left_wheel_link.position[1]") == pytest.approx(0.25)
    line = next(i for i, text in enumerate(model.read_text().splitlines(), 1) if "<xacro:whel" in text)
    page.get_by_text(f"mbot.xacro:{line}", exact=False).first.wait_for()

    replace_in_file(model, "<xacro:whel ", "<xacro:wheel ")
    page.get_by_text("there is no macro", exact=False).first.wait_for(state="hidden")
    assert state(page, "joints.left_wheel_joint") == joint
    page.close()  # an open page would report in the console that the server is gone
    assert program.interrupt() == 130


def test_removed_link_leaves_no_visual(start_fresh, open_page, model):
    page = open_page(start_fresh("view", str(model)))
    assert state(page, "robot.links") == 12
    replace_in_file(model, "<xacro:laser ", "<!-- <xacro:laser ")
    replace_in_file(model, '"${laser_joint_z}"/>', '"${laser_joint_z}"/> -->')
    until(page, "lw.robot.links === 11")
    until(page, "!('laser_link' in lw.frames)")


def test_model_broken_at_start_is_shown_once_fixed(start_fresh, open_page, model):
    replace_in_file(model, "</robot>", "</robott>")
    program = start_fresh("view", str(model))
    page = open_page(program, wait=False)
    page.get_by_text("</robott>", exact=False).first.wait_for()
    replace_in_file(model, "</robott>", "</robot>")
    until(page, "lw.robot !== null && lw.robot.links === 12 && lw.ready")
