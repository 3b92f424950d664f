"""Scenes from descriptions: shapes, poses, colors and meshes."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.page.files import MeshIndex
from linkwright.rviz.robot import SceneBuilder, get_frame_name
from linkwright.urdf import read
from linkwright.xacro import expand
from linkwright.xmltree import parse
from tests.page.test_files import write_file, write_package


def build_scene_of(text: str, prefix: str = "", packages: dict[str, Path] | None = None, name: str = "<text>"):
    finder = PackageFinder(start=Path("/nonexistent"), environment={}, extra=packages or {})
    builder = SceneBuilder(MeshIndex(finder))
    reading = read(parse(text, name))
    assert reading.robot is not None, reading.diagnostics
    return {link.name: link for link in builder.links(reading.robot, prefix)}, builder


def robot_text(visuals: str, materials: str = "") -> str:
    return f'<robot name="r">{materials}<link name="base">{visuals}</link></robot>'


def visual_element(geometry: str, material: str = "", tag: str = "visual") -> str:
    return f"<{tag}><geometry>{geometry}</geometry>{material}</{tag}>"


@pytest.mark.parametrize(
    ("geometry", "kind", "size"),
    [
        ('<box size="1 2 3"/>', "box", [1, 2, 3]),
        ('<cylinder radius="0.5" length="2"/>', "cylinder", [0.5, 2]),
        ('<sphere radius="0.25"/>', "sphere", [0.25]),
    ],
)
def test_shapes_have_their_sizes(geometry, kind, size):
    links, _ = build_scene_of(robot_text(visual_element(geometry)))
    (shape,) = links["base"].visuals
    assert (shape.kind, shape.size) == (kind, size)


def test_capsule_of_urdf_1_1_is_built():
    text = robot_text(visual_element('<capsule radius="1" length="2"/>')).replace('name="r"', 'name="r" version="1.1"')
    (shape,) = build_scene_of(text)[0]["base"].visuals
    assert (shape.kind, shape.size) == ("capsule", [1, 2])


def test_visual_pose_matches_origin():
    links, _ = build_scene_of(
        robot_text(
            f'<visual><origin xyz="1 2 3" rpy="0 0 {math.pi / 2}"/><geometry><sphere radius="1"/></geometry></visual>'
        )
    )
    (shape,) = links["base"].visuals
    assert shape.position == [1, 2, 3]
    assert shape.quaternion == pytest.approx([0, 0, math.sqrt(0.5), math.sqrt(0.5)])


def test_visual_colors_follow_materials():
    box = '<box size="1 1 1"/>'
    links, _ = build_scene_of(
        robot_text(
            visual_element(box, '<material name="blue"/>')
            + visual_element(box, '<material name="own"><color rgba="1 0 0 0.5"/></material>')
            + visual_element(box)
            + visual_element(box, '<material name="undefined"/>')
            + visual_element(box, tag="collision"),
            '<material name="blue"><color rgba="0 0 1 1"/></material>',
        )
    )
    assert [shape.color for shape in links["base"].visuals] == [[0, 0, 1, 1], [1, 0, 0, 0.5], None, None]
    assert [shape.color for shape in links["base"].collisions] == [[0, 0, 1, 1]]  # the first visual's color, as in RViz


def test_links_have_frame_joint_and_source_location():
    text = """<robot name="r">
  <link name="base"/>
  <link name="tip"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="tip"/></joint>
</robot>"""
    links, _ = build_scene_of(text, prefix="one", name="/some/r.urdf")
    assert (links["base"].parent_joint, links["tip"].parent_joint) == (None, "j")
    assert (links["tip"].frame, get_frame_name("tip", "")) == ("one/tip", "tip")
    place = links["tip"].place
    assert (place.file, place.line, place.column, place.trail) == ("/some/r.urdf", 3, 3, [])


def test_links_from_macros_have_macro_call_locations(tmp_path):
    write_file(
        tmp_path / "wheel.xacro",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:macro name="wheel" params="side">\n    <link name="${side}_wheel"/>\n  </xacro:macro>\n</robot>\n',
    )
    main = write_file(
        tmp_path / "main.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:include filename="wheel.xacro"/>\n  <xacro:wheel side="left"/>\n</robot>\n',
    )
    reading = read(expand(main).document)
    finder = PackageFinder(start=tmp_path, environment={})
    (link,) = SceneBuilder(MeshIndex(finder)).links(reading.robot, "")
    assert (Path(link.place.file).name, link.place.line) == ("wheel.xacro", 3)
    assert any("macro 'wheel'" in step and "main.xacro:3:3" in step for step in link.place.trail)


def test_meshes_have_url_format_and_scale(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "meshes" / "arm.STL")
    links, builder = build_scene_of(
        robot_text(visual_element('<mesh filename="package://robot/meshes/arm.STL" scale="0.001 0.001 0.001"/>')),
        packages={"robot": share},
    )
    (shape,) = links["base"].visuals
    assert (shape.kind, shape.format, shape.size) == ("mesh", "stl", [0.001] * 3)
    assert shape.url.startswith("/mesh/robot-")
    assert builder.problems == {}
    assert [folder.root for folder in builder.index.folders.values()] == [share]


def test_relative_mesh_paths_are_resolved_from_naming_file(tmp_path):
    write_file(tmp_path / "meshes" / "arm.obj")
    text = robot_text(visual_element('<mesh filename="../meshes/arm.obj"/>'))
    links, _ = build_scene_of(text, name=str(tmp_path / "urdf" / "r.urdf"))
    assert links["base"].visuals[0].url


def test_missing_meshes_are_reported_with_searched_paths(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    links, builder = build_scene_of(
        robot_text(
            visual_element('<mesh filename="package://robot/meshes/gone.dae"/>')
            + visual_element('<mesh filename="package://nobody/a.dae"/>', tag="collision")
            + visual_element(
                '<box size="1 1 1"/>', '<material name="w"><texture filename="package://robot/wood.png"/></material>'
            )
        ),
        packages={"robot": share},
    )
    assert [shape.kind for shape in links["base"].visuals] == ["box"]
    mesh, texture, collision = sorted(builder.problems["base"], key=lambda text: ("nobody" in text, text))
    assert "'package://robot/meshes/gone.dae'" in mesh
    assert f"'{share / 'meshes' / 'gone.dae'}'" in mesh
    assert f"no file '{share / 'wood.png'}'" in texture
    assert "package 'nobody' not found" in collision


def test_textures_have_url(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "wood.png")
    material = '<material name="w"><color rgba="1 1 1 1"/><texture filename="package://robot/wood.png"/></material>'
    links, _ = build_scene_of(robot_text(visual_element('<box size="1 1 1"/>', material)), packages={"robot": share})
    assert "/wood.png?v=" in links["base"].visuals[0].texture
