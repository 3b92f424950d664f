"""Inference: decisions of the user, facts from meshes, and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from linkwright.descriptions import load
from linkwright.diagnostics import LinkwrightError
from linkwright.inertia import MeshLibrary
from linkwright.inference import infer
from linkwright.packages import PackageFinder

pytestmark = pytest.mark.extra("mesh")

BASE = '<link name="base_link"><collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>'
WHEEL = (
    '<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="{radius}" length="0.03"/></geometry></collision>'
)


def wheel(name: str, x: float, y: float, radius: float = 0.08, shapes: str = WHEEL) -> str:
    """Return a wheel, and a joint with the name of the link and _joint."""
    z = radius - 0.08
    return (
        f'<link name="{name}">{shapes.format(radius=radius)}</link><joint name="{name}_joint" type="continuous">'
        f'<origin xyz="{x} {y} {z}"/><parent link="base_link"/><child link="{name}"/><axis xyz="0 1 0"/></joint>'
    )


def robot(*parts: str):
    return load(f'<robot name="r">{BASE}{"".join(parts)}</robot>')


def inferred(description, folder: Path = Path(), **options):
    return infer(description, MeshLibrary(PackageFinder(start=folder), folder), **options)


FOUR = (wheel("a", 0.2, 0.2), wheel("b", 0.2, -0.2), wheel("c", -0.2, 0.2), wheel("d", -0.2, -0.2))


def test_named_wheels_drive_and_other_wheels_roll_freely():
    inference = inferred(robot(*FOUR), wheels=["c_joint", "d"])
    assert inference.drive is not None
    assert inference.drive.kind == "differential"
    assert [wheel.link for wheel in (*inference.drive.left, *inference.drive.right)] == ["c", "d"]
    assert inference.held_joints == ()


def test_requested_drive_kind_is_inferred():
    inference = inferred(robot(*FOUR), kind="mecanum")
    assert inference.drive is not None
    assert inference.drive.kind == "mecanum"


def test_requested_drive_kind_overrides_plugin_of_file():
    plugin = '<gazebo><plugin name="d" filename="libgazebo_ros_planar_move.so"/></gazebo>'
    by_default = inferred(robot(*FOUR, plugin))
    assert by_default.drive is None
    skid_steered = inferred(robot(*FOUR, plugin), kind="skid")
    assert skid_steered.drive is not None
    assert skid_steered.drive.kind == "skid"


def test_kind_joints_gives_joint_drive_without_fixed_base():
    inference = inferred(robot(*FOUR), kind="joints")
    assert inference.drive is not None
    assert inference.drive.kind == "joints"
    assert not inference.fixed_base


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ({"kind": "differential"}, "DRIVE211", "needs one pair of driven wheels, but there are 2"),
        ({"kind": "ackermann"}, "DRIVE211", "steered by vertical joints, but there are 0"),
        ({"wheels": ["a", "zzz"]}, "DRIVE210", "no joint 'zzz'"),
        ({"wheels": ["a", "c"]}, "DRIVE211", "no wheel is opposite 'a_joint', 'c_joint'"),
        ({"wheels": ["a", "b"], "kind": "skid"}, "DRIVE211", "needs 2 pairs of wheels"),
    ],
)
def test_impossible_drive_options_are_rejected(options, code, words):
    with pytest.raises(LinkwrightError, match=words) as error:
        inferred(robot(*FOUR), **options)
    assert error.value.diagnostics[0].code == code


def test_joint_without_wheel_is_reported_with_location():
    square = '<collision><geometry><box size="0.1 0.03 0.1"/></geometry></collision>'
    with pytest.raises(LinkwrightError, match="'b_joint' does not turn a wheel") as error:
        inferred(robot(FOUR[0], wheel("b", 0.2, -0.2, shapes=square)), wheels=["a", "b"])
    assert error.value.diagnostics[0].span is not None


@pytest.fixture
def tyre(tmp_path):
    """Write an STL file tyre.stl with a wheel that turns about y."""
    body = trimesh.creation.cylinder(radius=0.08, height=0.04, sections=24)
    body.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    body.apply_translation((0, 0.01, 0))
    body.export(tmp_path / "tyre.stl")
    return tmp_path


MESH = '<visual><geometry><mesh filename="tyre.stl"/></geometry></visual>'


def _saved(folder: Path, *parts: str):
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{BASE}{"".join(parts)}</robot>')
    return load(path)


def test_round_mesh_becomes_wheel_with_cylinder_collision(tyre):
    description = _saved(tyre, wheel("a", 0, 0.2, shapes=MESH), wheel("b", 0, -0.2, shapes=MESH))
    inference = inferred(description, tyre)
    assert inference.drive is not None
    assert inference.drive.radius == pytest.approx(0.08, rel=1e-6)
    assert inference.drive.left[0].width == pytest.approx(0.04, rel=1e-6)
    collision = next(finding for finding in inference.findings if finding.diagnostic.code == "DRIVE101").added[0]
    shape = next(collision.first("geometry").elements())
    assert shape.tag == "cylinder"
    assert float(shape.attributes["radius"]) == pytest.approx(0.08)
    assert [float(part) for part in collision.first("origin").attributes["xyz"].split()] == pytest.approx([0, 0.01, 0])


def test_square_mesh_is_not_a_wheel(tmp_path):
    trimesh.creation.box((0.16, 0.04, 0.16)).export(tmp_path / "tyre.stl")
    description = _saved(tmp_path, wheel("a", 0, 0.2, shapes=MESH), wheel("b", 0, -0.2, shapes=MESH))
    assert inferred(description, tmp_path).drive is None


def test_missing_wheel_mesh_is_reported(tmp_path):
    description = _saved(tmp_path, wheel("a", 0, 0.2, shapes=MESH), wheel("b", 0, -0.2, shapes=MESH))
    inference = inferred(description, tmp_path)
    assert inference.drive is None
    assert "mesh 'tyre.stl' of link 'a', which may be a wheel, cannot be read" in inference.diagnostics[-1].message


def test_mesh_with_many_vertices_becomes_box(tmp_path):
    trimesh.creation.icosphere(subdivisions=6, radius=0.1).export(tmp_path / "ball.stl")
    path = tmp_path / "r.urdf"
    path.write_text(
        '<robot name="r"><link name="base_link"><visual><geometry><mesh filename="ball.stl" scale="2 1 1"/></geometry>'
        "</visual></link></robot>"
    )
    finding = inferred(load(path), tmp_path).findings[0]
    box = next(finding.added[0].first("geometry").elements())
    assert box.tag == "box"
    assert [float(part) for part in box.attributes["size"].split()] == pytest.approx([0.4, 0.2, 0.2], rel=1e-3)


def test_inferred_mass_is_limited():
    box = (
        '<robot name="r"><link name="a"><visual><geometry><box size="{0} {0} {0}"/></geometry></visual></link></robot>'
    )
    tiny_robot = load(box.format(1e-3))
    huge_robot = load(box.format(90))
    assert inferred(tiny_robot).masses["a"] == pytest.approx(0.01)
    assert inferred(huge_robot).masses["a"] == pytest.approx(1000.0)
