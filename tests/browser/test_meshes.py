"""Mesh files of all formats that RViz reads, and reports about broken ones."""

from __future__ import annotations

import math
import shutil
import struct

import pytest
import trimesh

from tests.browser.conftest import state, until, wait_until_equal
from tests.places import PACKAGE

pytestmark = pytest.mark.browser

FILE_FORMATS = ("stl", "obj", "glb", "dae")


def link_element(name: str, mesh: str, y: float) -> str:
    return (
        f'<link name="{name}"><visual><geometry><mesh filename="{mesh}"/></geometry>'
        '<material name="green"><color rgba="0 0.8 0.2 1"/></material></visual></link>'
        f'<joint name="{name}_joint" type="fixed"><parent link="base"/><child link="{name}"/>'
        f'<origin xyz="0 {y} 0"/></joint>'
    )


@pytest.fixture
def write_robot(tmp_path):
    box = trimesh.creation.box((0.2, 0.1, 0.3))
    for extension in ("stl", "obj", "glb"):
        box.export(tmp_path / f"box.{extension}")
    shutil.copy(PACKAGE / "meshes" / "kinect.dae", tmp_path / "box.dae")

    def write(*extra_links: str) -> str:
        links = [
            link_element(extension, f"file://{tmp_path}/box.{extension}", 0.4 * n)
            for n, extension in enumerate(FILE_FORMATS)
        ]
        path = tmp_path / "robot.urdf"
        path.write_text(f'<robot name="r"><link name="base"/>{"".join(links)}{"".join(extra_links)}</robot>')
        return str(path)

    return write


def mesh_rows(page):
    display = next(display for display in state(page, "displays") if display["name"] == "RobotModel")
    return {row["name"]: (row["level"], row["text"]) for row in display["status"]}


def test_all_mesh_formats_are_drawn(start, open_page, write_robot):
    page = open_page(start("view", write_robot()))
    assert state(page, "robot.visuals") == len(FILE_FORMATS)
    wait_until_equal(
        lambda: [mesh_rows(page).get(kind, ("", ""))[0] for kind in FILE_FORMATS], ["ok"] * len(FILE_FORMATS)
    )


def test_malformed_collada_is_read_as_leniently_as_by_rviz(start, open_page, write_robot, tmp_path):
    """Exporters write invalid XML: assimp names the nodes of an STL ``<STL_BINARY>``."""
    well_formed = (tmp_path / "box.dae").read_text()
    malformed = well_formed.replace('<node id="body"', '<!-- made -- by hand --><node id="<STL_BINARY>"', 1)
    assert malformed != well_formed
    (tmp_path / "loose.dae").write_text(malformed)
    page = open_page(start("view", write_robot(link_element("loose", f"file://{tmp_path}/loose.dae", 2))))
    wait_until_equal(lambda: mesh_rows(page).get("loose", ("", ""))[0], "ok")


STL_OF_NAN = b"\0" * 80 + struct.pack("<I12fH", 1, *[0.0] * 3, math.nan, *[0.0] * 8, 0)

BROKEN = {
    "short.stl": (b"\0" * 80 + struct.pack("<I", 40_000_000) + b"\0" * 600, "declares 40 000 000 triangles and has 12"),
    "text.stl": (b"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "broken at line 4: 'zero'"),
    "nothing.stl": (b"solid nothing\n", "has no triangles"),
    "nan.stl": (STL_OF_NAN, "1 vertices have coordinates that are not finite numbers"),
    "empty.dae": (b"", "the file is empty"),
    "cut.dae": (b"<?xml version='1.0'?>\n<COLLADA>\n<library_geometries>", "not valid XML, line 3"),
    "other.dae": (b"<robot name='r'/>", "its root is <robot>"),
    "points.obj": (b"v 0 0 0\nv 1 0 0\n", "has no faces"),
    "torn.glb": (b"glTF" + struct.pack("<II", 2, 1_000) + b"\0" * 12, "declares 1 000 bytes and has 24"),
    "zip.glb": (b"PK\x03\x04 and so on", "does not begin with 'glTF'"),
}
"""The contents of broken files, and the expected messages."""


def test_broken_mesh_is_reported_at_its_link(start, open_page, write_robot, tmp_path):
    for name, (data, _) in BROKEN.items():
        (tmp_path / name).write_bytes(data)
    links = [link_element(f"broken_{name[:-4]}", f"file://{tmp_path}/{name}", -0.4) for name in BROKEN]
    page = open_page(start("view", write_robot(*links)))
    files_by_link = {f"broken_{name[:-4]}": (name, message) for name, (_, message) in BROKEN.items()}
    wait_until_equal(
        lambda: {link: mesh_rows(page).get(link, ("", ""))[0] for link in files_by_link},
        dict.fromkeys(files_by_link, "error"),
    )
    for link_name, (name, message) in files_by_link.items():
        text = mesh_rows(page)[link_name][1]
        assert name in text
        assert message in text
    wait_until_equal(
        lambda: [mesh_rows(page).get(kind, ("", ""))[0] for kind in FILE_FORMATS], ["ok"] * len(FILE_FORMATS)
    )
    assert state(page, "robot.visuals") == len(FILE_FORMATS)


def test_slow_mesh_is_reported_until_loaded(start, open_page, write_robot):
    page = open_page(start("view", write_robot()))
    held_requests = []

    def hold(route) -> None:
        held_requests.append(route)

    page.route("**/box.stl*", hold)
    page.reload()
    notice = page.locator("[data-notice='meshes']")
    notice.wait_for()
    assert "box.stl" in notice.inner_text()
    page.get_by_text("Status: Loading", exact=True).wait_for()
    held_requests[0].continue_()
    notice.wait_for(state="hidden")
    page.locator(".row", has_text="Status: Ok").nth(1).wait_for()
    page.wait_for_function("window.linkwright?.ready === true")
    assert state(page, "robot.visuals") == len(FILE_FORMATS)


def test_robot_without_readable_meshes_is_reported_and_shown_by_frames(start, open_page, tmp_path):
    missing = '<visual><geometry><mesh filename="package://elsewhere/arm.stl"/></geometry></visual>'
    joint = '<joint name="j" type="fixed"><origin xyz="0 0 1"/><parent link="base"/><child link="arm"/></joint>'
    text = f'<robot name="r"><link name="base">{missing}</link><link name="arm">{missing}</link>{joint}</robot>'
    file = tmp_path / "robot.urdf"
    file.write_text(text)
    page = open_page(start("view", str(file)))
    banner = page.locator(".banner.warning")
    banner.get_by_text("robot 'r' is not visible: none of its meshes can be read").wait_for()
    until(page, "lw.displays.some((display) => display.class.endsWith('/TF') && display.enabled)")
    banner.get_by_role("button", name="Show").click()
    page.locator(".diagnostics").get_by_text("package 'elsewhere' not found").first.wait_for()
    banner.get_by_role("button", name="Close").click()
    assert banner.is_hidden()
    page.get_by_role("tab", name="Diagnostics (2)").wait_for()  # the display has an error too
    file.write_text(text.replace(missing, '<visual><geometry><box size="1 1 1"/></geometry></visual>', 1))
    page.get_by_role("tab", name="Diagnostics (1)").wait_for()  # one mesh is still missing
    file.write_text(text.replace(missing, ""))
    page.get_by_role("tab", name="Diagnostics", exact=True).wait_for()
