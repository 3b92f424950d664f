"""Mesh files of every kind that RViz reads, and what a broken one looks like."""

from __future__ import annotations

import shutil

import pytest
import trimesh

from tests.browser.conftest import becomes, state
from tests.places import PACKAGE

pytestmark = pytest.mark.browser

KINDS = ("stl", "obj", "glb", "dae")


def link(name: str, mesh: str, y: float) -> str:
    return (
        f'<link name="{name}"><visual><geometry><mesh filename="{mesh}"/></geometry>'
        '<material name="green"><color rgba="0 0.8 0.2 1"/></material></visual></link>'
        f'<joint name="{name}_joint" type="fixed"><parent link="base"/><child link="{name}"/>'
        f'<origin xyz="0 {y} 0"/></joint>'
    )


@pytest.fixture
def robot(tmp_path):
    box = trimesh.creation.box((0.2, 0.1, 0.3))
    for kind in ("stl", "obj", "glb"):
        box.export(tmp_path / f"box.{kind}")
    shutil.copy(PACKAGE / "meshes" / "kinect.dae", tmp_path / "box.dae")

    def write(*more: str) -> str:
        links = [link(kind, f"file://{tmp_path}/box.{kind}", 0.4 * n) for n, kind in enumerate(KINDS)]
        path = tmp_path / "robot.urdf"
        path.write_text(f'<robot name="r"><link name="base"/>{"".join(links)}{"".join(more)}</robot>')
        return str(path)

    return write


def rows(page):
    display = next(each for each in state(page, "displays") if each["name"] == "RobotModel")
    return {row["name"]: (row["level"], row["text"]) for row in display["status"]}


def test_every_kind_is_drawn(start, open_page, robot):
    page = open_page(start("view", robot()))
    assert state(page, "robot.visuals") == len(KINDS)
    becomes(lambda: [rows(page).get(kind, ("", ""))[0] for kind in KINDS], ["ok"] * len(KINDS))


def test_a_mesh_that_cannot_be_read_is_an_error_of_its_link_alone(start, open_page, robot, tmp_path):
    (tmp_path / "broken.stl").write_bytes(b"solid nothing\n")
    (tmp_path / "broken.glb").write_bytes(b"glTF\x02\0\0\0")
    program = start("view", robot(link("broken", f"file://{tmp_path}/broken.glb", -0.4)))
    page = open_page(program)
    page.wait_for_function(
        "() => window.linkwright.displays[1].status.some((row) => row.name === 'broken' && row.level === 'error')"
    )
    level, text = rows(page)["broken"]
    assert level == "error"
    assert "broken.glb" in text
    becomes(lambda: [rows(page).get(kind, ("", ""))[0] for kind in KINDS], ["ok"] * len(KINDS))
    assert state(page, "robot.visuals") == len(KINDS)
