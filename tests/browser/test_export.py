"""Exported pages opened from disk, and the entries of the Share menu."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.golden import link_element, mesh_visual, robot_of
from tests.browser.live import configuration
from tests.browser.mesh_writers import make_png, write_dae, write_obj, write_stl_binary
from tests.panels.export.robots import GRIPPER
from tests.panels.export.test_glb import make_textured_dae

pytestmark = pytest.mark.browser

ROBOT = configuration(
    """
- Class: rviz_default_plugins/RobotModel
  Description Topic:
    Value: /robot_description
  Enabled: true
  Name: Robot
""",
    distance=4.0,
)


@pytest.fixture
def open_file(browser):
    """Return a function that opens a file from disk.

    Any request or error of the page fails the test.
    """
    contexts, errors = [], []

    def open_path(path: Path, locale: str = "en-US"):
        context = browser.new_context(viewport={"width": 1000, "height": 700}, locale=locale, offline=True)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)

        def on_request(request) -> None:
            if request.url != path.as_uri() and not request.url.startswith(("data:", "blob:")):
                errors.append(request.url)

        page.on("request", on_request)
        page.goto(path.as_uri())
        # The page's policy forbids the evaluation of text, which wait_for_function needs.
        wait_until_equal(lambda: page.evaluate("() => window.linkwright?.ready === true"), True)
        return page

    yield open_path
    for context in contexts:
        context.close()
    assert errors == []


def export_page(target: Path, model: Path, *values: str) -> None:
    subprocess.run([sys.executable, "-m", "linkwright", "export", str(target), str(model), *values], check=True)


def drawn_visuals(page) -> dict:
    """Return each visual as it is drawn, by link."""
    robot = next(display for display in state(page, "displays") if display["class"].endswith("RobotModel"))["drawn"]
    return {name: text["visuals"] for name, text in robot["links"].items()}


def assert_alike(first: dict, second: dict) -> None:
    """Assert that two drawings are equal up to rounding.

    Joint positions are computed from transforms.
    """
    assert first.keys() == second.keys()
    for name, shapes in first.items():
        for a, b in zip(shapes, second[name], strict=True):
            assert a["materials"] == b["materials"]
            for corner in ("min", "max"):
                assert a["bounds"][corner] == pytest.approx(b["bounds"][corner], abs=1e-5)


def robot_with_meshes(folder: Path) -> str:
    (folder / "skin.png").write_bytes(make_png(255, 255, 0))
    (folder / "skin.dae").write_text(make_textured_dae())
    (folder / "inches.dae").write_bytes(write_dae(unit=0.0254, diffuse="<color>0 0 1 1</color>"))
    (folder / "own.obj").write_bytes(write_obj("own.mtl", "paint"))
    (folder / "own.mtl").write_text("newmtl paint\nKd 1 0.5 0\n")
    (folder / "plain.stl").write_bytes(write_stl_binary())
    return robot_of(
        "".join(
            link_element(path.stem, mesh_visual(path, "")) for path in sorted(folder.iterdir()) if path.suffix in MESHES
        )
    )


MESHES = (".dae", ".obj", ".stl")


def test_exported_page_draws_the_same_as_viewer(start_viewer, open_page, open_file, tmp_path):
    folder = tmp_path / "meshes"
    folder.mkdir()
    text = robot_with_meshes(folder)
    (tmp_path / "robot.urdf").write_text(text)
    export_page(tmp_path / "robot.html", tmp_path / "robot.urdf")
    viewer = start_viewer(ROBOT)
    for name in ("skin", "inches", "own", "plain"):
        viewer.place(name, 0.0, 0.0, 0.0)
    viewer.publish("/robot_description", String(data=text), DESCRIPTION_QOS)
    exported_visuals = drawn_visuals(open_file(tmp_path / "robot.html"))
    assert exported_visuals == drawn_visuals(open_page(viewer))
    assert exported_visuals["skin"][0]["materials"][0]["textured"]


def test_exported_sliders_move_joints_and_mimic_joints(open_file, tmp_path):
    (tmp_path / "gripper.urdf").write_text(GRIPPER)
    export_page(tmp_path / "gripper.html", tmp_path / "gripper.urdf")
    page = open_file(tmp_path / "gripper.html")
    assert state(page, "joints") == pytest.approx({"turn": 0.0, "open": 0.25, "open_too": -0.45})
    slider = page.get_by_role("slider", name="open", exact=True)
    slider.focus()
    slider.fill("0.4")
    until(page, "lw.joints.open > 0.39")  # the positions change in the next frame
    assert state(page, "joints") == pytest.approx({"turn": 0.0, "open": 0.4, "open_too": -0.75})
    assert state(page, "frames")["right"]["position"] == pytest.approx([0.95, 0, 1.25], abs=1e-5)
    field = page.get_by_role("textbox").first
    field.fill("1.2")
    field.press("Enter")
    until(page, "lw.joints.turn > 1.19")
    assert state(page, "joints")["turn"] == pytest.approx(1.2)
    page.get_by_role("button", name="Reset").click()
    until(page, "lw.joints.turn < 0.01")
    assert state(page, "frames")["base"]["position"] == pytest.approx([0, 0, 0])


def test_exported_page_has_visual_switches_views_and_translation(open_file, tmp_path):
    (tmp_path / "gripper.urdf").write_text(GRIPPER)
    export_page(tmp_path / "gripper.html", tmp_path / "gripper.urdf")
    page = open_file(tmp_path / "gripper.html")
    page.get_by_label("Collision").check()
    page.get_by_label("Visual").uncheck()
    wait_until_equal(lambda: state(page, "robot")["visuals"], 0)
    robot = next(display for display in state(page, "displays") if display["class"].endswith("RobotModel"))
    assert robot["drawn"]["links"]["arm"]["collisions"]
    page.get_by_role("button", name="Top").click()
    wait_until_equal(lambda: state(page, "view")["pitch"], pytest.approx(1.57, abs=0.01))
    chinese = open_file(tmp_path / "gripper.html", locale="zh-CN")
    assert chinese.get_by_label("碰撞").count() == 1


WHEELED = """\
<robot name="cart">
  <link name="body"><visual><geometry><box size="0.6 0.4 0.2"/></geometry></visual></link>
  <link name="wheel"><visual><origin rpy="1.5708 0 0"/>
    <geometry><cylinder radius="0.25" length="0.05"/></geometry></visual></link>
  <joint name="turn" type="continuous"><parent link="body"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
</robot>
"""


def grid_drawing(page) -> dict:
    return next(display for display in state(page, "displays") if display["class"].endswith("/Grid"))["drawn"]


def test_exported_grid_is_at_wheel_contact_height(open_file, tmp_path):
    (tmp_path / "cart.urdf").write_text(WHEELED)
    export_page(tmp_path / "cart.html", tmp_path / "cart.urdf")
    page = open_file(tmp_path / "cart.html")
    wait_until_equal(lambda: grid_drawing(page)["offset"][2], pytest.approx(-0.25, abs=0.005))


def test_exported_grid_fits_small_mesh_robot(open_file, tmp_path):
    (tmp_path / "small.stl").write_bytes(write_stl_binary())
    visual = '<visual><geometry><mesh filename="small.stl" scale="0.1 0.1 0.1"/></geometry></visual>'
    (tmp_path / "small.urdf").write_text(f'<robot name="small"><link name="base">{visual}</link></robot>')
    export_page(tmp_path / "small.html", tmp_path / "small.urdf")
    page = open_file(tmp_path / "small.html")
    wait_until_equal(lambda: grid_drawing(page)["cell"], pytest.approx(0.01))


def open_gripper(start_viewer, open_page):
    viewer = start_viewer(ROBOT)
    viewer.place("arm", 0.0, 0.0, 0.25, 0.0, 0.0, 0.70710678, 0.70710678)
    viewer.place("left", 0.0, 0.5, 1.0, parent="arm")
    viewer.place("right", 0.0, -0.75, 1.0, parent="arm")
    viewer.publish("/robot_description", String(data=GRIPPER), DESCRIPTION_QOS)
    return viewer, open_page(viewer)


def open_share_menu_entry(page, entry: str) -> None:
    page.get_by_role("button", name="Share", exact=True).click()
    page.get_by_role("menuitem", name=entry, exact=True).click()


def save_from_menu(page, entry: str, folder: Path) -> Path:
    with page.expect_download() as download:
        open_share_menu_entry(page, entry)
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    return path


def test_viewer_exports_current_joints_and_view(start_viewer, open_page, open_file, tmp_path):
    _, page = open_gripper(start_viewer, open_page)
    path = save_from_menu(page, "Export HTML…", tmp_path)
    assert path.name == "gripper.html"
    exported_page = open_file(path)
    # The current positions of the joints, not the initial positions of the sliders.
    assert state(exported_page, "joints") == pytest.approx({"turn": 0.0, "open": 0.3, "open_too": -0.55}, abs=1e-5)
    assert state(exported_page, "view")["distance"] == pytest.approx(state(page, "view")["distance"])
    assert_alike(drawn_visuals(exported_page), drawn_visuals(page))


def test_exported_glb_shows_the_same_robot(start_viewer, open_page, tmp_path):
    _, page = open_gripper(start_viewer, open_page)
    path = save_from_menu(page, "Export glb…", tmp_path)
    visuals = drawn_visuals(page)
    viewer = start_viewer(ROBOT)
    robot = f'<robot name="again"><link name="base">{mesh_visual(path, "")}</link></robot>'
    viewer.publish("/robot_description", String(data=robot), DESCRIPTION_QOS)
    (drawn_model,) = drawn_visuals(open_page(viewer))["base"]
    bounds = [shape["bounds"] for shapes in visuals.values() for shape in shapes]
    for corner, choose in (("min", min), ("max", max)):
        expected = [choose(bound[corner][axis] for bound in bounds) for axis in range(3)]
        assert drawn_model["bounds"][corner] == pytest.approx(expected, abs=1e-4)
    assert len(drawn_model["materials"]) == 4


def test_files_outside_package_are_listed_before_export(start, open_page, tmp_path):
    share, other_folder = tmp_path / "robot", tmp_path / "elsewhere"
    share.mkdir()
    other_folder.mkdir()
    (share / "package.xml").write_text("<package><name>robot</name></package>")
    (other_folder / "part.urdf").write_text('<robot><link name="base"/></robot>')
    (share / "robot.xacro").write_text(
        f"""<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro">
        <xacro:include filename="{other_folder}/part.urdf"/></robot>"""
    )
    page = open_page(start("view", str(share / "robot.xacro")))
    assert save_from_menu(page, "Export glb…", tmp_path).name == "robot.glb"
    dialog = page.get_by_role("dialog", name="The export contains files from outside the packages")
    dialog.wait_for()
    wait_until_equal(dialog.get_by_role("listitem").all_inner_texts, ["elsewhere/part.urdf"])


def test_screenshots_and_videos_are_saved(start_viewer, open_page, tmp_path):
    from PIL import Image

    _, page = open_gripper(start_viewer, open_page)
    canvas = page.locator(".canvas-box canvas").bounding_box()
    with Image.open(save_from_menu(page, "Screenshot, 2 times as large", tmp_path)) as image:
        assert image.format == "PNG"
        assert image.size == pytest.approx((2 * canvas["width"], 2 * canvas["height"]), abs=2)
        colors = {pixel for _, pixel in image.convert("RGB").resize((200, 150)).getcolors(30_000)}
    assert len(colors) > 3
    assert page.locator(".canvas-box canvas").bounding_box() == canvas
    open_share_menu_entry(page, "Record a video")
    until(page, "document.querySelector('.recorder:not([hidden])') !== null")
    for step in range(10):
        frame_count = state(page, "framesDrawn")
        page.mouse.move(600 + 8 * step, 400)
        page.mouse.down()
        page.mouse.move(620 + 8 * step, 410)
        page.mouse.up()
        until(page, f"lw.framesDrawn > {frame_count}")
    with page.expect_download() as download:
        page.locator(".recorder button").click()
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    assert path.suffix == ".webm"
    assert path.read_bytes().startswith(b"\x1aE\xdf\xa3")
    assert path.stat().st_size > 2000
    assert page.locator(".recorder").is_hidden()
