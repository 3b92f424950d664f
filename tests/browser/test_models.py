"""All models of the package through their two launch files, as in RViz."""

from __future__ import annotations

from pathlib import Path

import pytest
import trimesh

from tests.browser.conftest import state, until, wait_until_equal
from tests.places import PACKAGE, TUTORIAL_PACKAGES, without_meshes
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

MODELS = {
    "mbot_base.urdf": 5,
    "mbot_with_camera.urdf": 6,
    "mbot_with_kinect.urdf": 6,
    "mbot_with_laser.urdf": 6,
    "mbot_base.xacro": 12,
}

TOWER = """
<robot name="tower">
  <link name="base">
    <visual>
      <origin xyz="0 0 {middle}"/>
      <geometry><box size="{width} {width} {height}"/></geometry>
    </visual>
  </link>
</robot>
"""


def launch_arguments(model: str, package: Path = PACKAGE) -> list[str]:
    launch = "display_xacro.launch.py" if model.endswith(".xacro") else "display.launch.py"
    return ["launch", str(package / "launch" / launch), f"model:={package / 'urdf' / model}"]


@pytest.mark.parametrize(("model", "links"), MODELS.items())
def test_model_is_shown(start, open_page, model, links):
    page = open_page(start(*launch_arguments(model)))
    assert state(page, "robot.name") == "mbot"
    assert state(page, "robot.links") == links
    assert state(page, "robot.visuals") == links
    position = state(page, "frames.left_wheel_link.position")
    assert position == pytest.approx([0, 0.19, -0.05], abs=1e-6)
    view = state(page, "view")
    assert (view["distance"], view["pitch"], view["yaw"]) == pytest.approx((1.7, 0.33, 5.5))
    assert [display["name"] for display in state(page, "displays")] == ["Grid", "RobotModel", "TF"]
    wait_until_equal(lambda: {display["level"] for display in state(page, "displays")}, {"ok"})


@pytest.mark.parametrize("size", [0.05, 20.0])
def test_view_fits_model_without_configuration(start, open_page, tmp_path, size):
    model = tmp_path / "tower.urdf"
    model.write_text(TOWER.format(width=size / 5, height=size, middle=size / 2))
    page = open_page(start("view", str(model)))
    view = state(page, "view")
    assert view["focalPoint"] == pytest.approx([0, 0, size / 2], rel=1e-3, abs=size / 100)
    assert 1.2 * size < view["distance"] < 2.5 * size
    page.mouse.move(640, 400)
    page.mouse.wheel(0, 120)
    until(page, f"lw.view.distance !== {view['distance']}")
    page.keyboard.press("Shift+Z")
    until(page, f"Math.abs(lw.view.distance - {view['distance']}) < {size / 100}")


def test_grid_fits_single_mesh_model_unless_user_changed_it(start, open_page, tmp_path):
    trimesh.creation.box((100.0, 20.0, 15.0)).export(tmp_path / "hull.stl")
    model_file = tmp_path / "ship.urdf"
    visual = f'<visual><geometry><mesh filename="file://{tmp_path}/hull.stl"/></geometry></visual>'
    model_file.write_text(f'<robot name="ship"><link name="hull">{visual}</link></robot>', encoding="utf-8")
    program = start("view", str(model_file))
    page = open_page(program)
    cell = page.locator('[data-key="display-1/Cell Size"] input')
    page.locator('[data-key="display-1"] .twist').click()
    wait_until_equal(cell.input_value, "100")
    cell.fill("20")
    page.keyboard.press("Enter")
    second_page = open_page(program)
    second_page.locator('[data-key="display-1"] .twist').click()
    until(second_page, "lw.settled")
    assert second_page.locator('[data-key="display-1/Cell Size"] input').input_value() == "20"


@pytest.mark.parametrize("package", TUTORIAL_PACKAGES, ids=lambda package: package.parent.name)
@pytest.mark.parametrize(("launch", "links"), [("display.launch.py", 5), ("display_xacro.launch.py", 12)])
def test_launch_files_run_from_package_folder(start, open_page, package, launch, links, tmp_path):
    share = without_meshes(package, tmp_path)
    program = start("launch", "my_robot_description", launch, cwd=share.parent)
    page = open_page(program)
    assert state(page, "robot.links") == links
    assert state(page, "frames.left_wheel_link.position") == pytest.approx([0, 0.19, -0.05], abs=1e-6)
    robot_model = "lw.displays.find(({ name }) => name === 'RobotModel')"
    if links == 12:
        # Readers have no mesh at first: the robot is shown, and the row names the path of the missing file.
        until(page, f"{robot_model}.status.some(({{ name, level }}) => name === 'kinect_link' && level === 'error')")
        status = next(display["status"] for display in state(page, "displays") if display["name"] == "RobotModel")
        row = next(row for row in status if row["name"] == "kinect_link")
        assert str(share / "meshes" / "kinect.dae") in row["text"]
        wait_until(lambda: any("meshes/kinect.dae" in line for line in program.output))
    else:
        until(page, f"{robot_model}.level === 'ok'")


def test_top_plate_is_above_base(start, open_page):
    page = open_page(start(*launch_arguments("mbot_base.xacro")))
    # Its visual's center is another 0.16 m above its frame, so 0.32 m above base_link; tests/viewer tests the shape.
    assert state(page, "frames.base_link_upper.position") == pytest.approx([0, 0, 0.16], abs=1e-6)
