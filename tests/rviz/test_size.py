"""The size of a robot, which sets the scale of the scene."""

from __future__ import annotations

import pytest

from linkwright.packages import PackageFinder
from linkwright.rviz import estimate_size, has_visuals
from linkwright.urdf import read
from linkwright.xmltree import parse


def measure_robot(text: str):
    reading = read(parse(f'<robot name="r">{text}</robot>', "<text>"))
    assert reading.robot is not None, reading.diagnostics
    return estimate_size(reading.robot)


def joint_element(parent: str, child: str, xyz: str) -> str:
    return (
        f'<joint name="{child}_joint" type="fixed"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/></joint>'
    )


def test_size_includes_frames_and_primitive_shapes():
    box = '<visual><origin xyz="0 0 0.5"/><geometry><box size="2 2 1"/></geometry></visual>'
    ball = '<collision><geometry><sphere radius="0.5"/></geometry></collision>'
    links = f'<link name="a">{box}</link><link name="b">{ball}</link><link name="c"/>'
    size = measure_robot(links + joint_element("a", "b", "0 0 1.5") + joint_element("b", "c", "0 0 0.1"))
    assert size is not None
    assert size.diagonal == pytest.approx((4 + 4 + 4) ** 0.5)
    assert size.spacing == pytest.approx(0.8)


def test_size_ignores_meshes():
    mesh = '<visual><geometry><mesh filename="file:///nowhere.stl"/></geometry></visual>'
    size = measure_robot(f'<link name="a">{mesh}</link><link name="b"/>' + joint_element("a", "b", "0.3 0.4 0"))
    assert size is not None
    assert (size.diagonal, size.spacing) == pytest.approx((0.5, 0.5))


def test_single_point_has_no_size():
    assert measure_robot('<link name="a"/><link name="b"/>' + joint_element("a", "b", "0 0 0")) is None


def test_has_visuals_requires_drawable_visual(tmp_path):
    (tmp_path / "a.stl").write_text("solid")
    shapes = {
        "visual": '<visual><geometry><sphere radius="1"/></geometry></visual>',
        "collision": '<collision><geometry><sphere radius="1"/></geometry></collision>',
        "mesh": f'<visual><geometry><mesh filename="file://{tmp_path}/a.stl"/></geometry></visual>',
        "mesh that is gone": f'<visual><geometry><mesh filename="file://{tmp_path}/b.stl"/></geometry></visual>',
    }
    seen = {}
    for name, shape in shapes.items():
        robot = read(parse(f'<robot name="r"><link name="a">{shape}</link></robot>', "<text>")).robot
        assert robot is not None
        seen[name] = has_visuals(robot, PackageFinder(start=[tmp_path]))
    assert seen == {"visual": True, "collision": False, "mesh": True, "mesh that is gone": False}
