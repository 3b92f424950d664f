"""Worlds as MuJoCo specifications."""

from __future__ import annotations

import struct

import mujoco
import numpy as np
import pytest
from PIL import Image

from linkwright.diagnostics import LinkwrightError
from linkwright.images.heights import read_heights
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.shapes import Heightmap
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.scene import Scene
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import GROUND, box, finder, make_simulation, world

ROOM = """solid room
{facets}
endsolid room
"""


def quad_facets(*corners: tuple[float, float, float]) -> str:
    """Return the two triangles of a quad."""
    a, b, c, d = (" ".join(map(str, corner)) for corner in corners)
    return "".join(
        f"facet normal 0 0 0\nouter loop\nvertex {p}\nvertex {q}\nvertex {r}\nendloop\nendfacet\n"
        for p, q, r in ((a, b, c), (a, c, d))
    )


@pytest.fixture
def room(tmp_path):
    """Return the mesh file of a room of 4 m by 4 m without a ceiling, whose walls face inward."""
    walls = [
        quad_facets((2, -2, 0), (2, 2, 0), (2, 2, 1), (2, -2, 1)),
        quad_facets((-2, 2, 0), (-2, -2, 0), (-2, -2, 1), (-2, 2, 1)),
        quad_facets((2, 2, 0), (-2, 2, 0), (-2, 2, 1), (2, 2, 1)),
        quad_facets((-2, -2, 0), (2, -2, 0), (2, -2, 1), (-2, -2, 1)),
    ]
    path = tmp_path / "room.stl"
    path.write_text(ROOM.format(facets="".join(walls)))
    return path


def fixed_model(shape: str) -> str:
    """Return a fixed model."""
    collision = f'<collision name="c">{shape}</collision>'
    return f'<model name="g"><static>true</static><link name="l">{collision}</link></model>'


def mesh_model(path, *, static: bool = True, pose: str = "0 0 0 0 0 0", scale: str = "1 1 1") -> str:
    shape = f"<geometry><mesh><uri>{path.as_uri()}</uri><scale>{scale}</scale></mesh></geometry>"
    return (
        f'<model name="mesh"><static>{str(static).lower()}</static><pose>{pose}</pose><link name="link">'
        f'<collision name="c">{shape}</collision><visual name="v">{shape}</visual></link></model>'
    )


def test_static_concave_mesh_is_hollow(room):
    simulation = make_simulation(GROUND, mesh_model(room), box("box", "0 0 0.1 0 0 0", "0.2 0.2 0.2"))
    simulation.push("box::link", (15.0, 0.0, 0.0))
    simulation.advance(3 * NANOSECONDS_PER_SECOND)
    x, y, z, *_ = simulation.model_pose("box")
    assert 1.5 < x < 1.95
    assert abs(y) < 0.1
    assert z > 0.05


def test_moving_mesh_collides_as_convex_hull(room):
    simulation = make_simulation(GROUND, mesh_model(room, static=False, pose="0 0 1 0 0 0", scale="0.1 0.1 0.1"))
    assert sum(geom.type == mujoco.mjtGeom.mjGEOM_MESH for geom in simulation.scene.spec.geoms) == 2
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert simulation.model_pose("mesh")[2] == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("static", [True, False])
@pytest.mark.parametrize("scale", ["1 0 0", "0 0 0"])
def test_mesh_that_its_scale_makes_line_or_point_collides_with_nothing(room, static, scale):
    text = mesh_model(room, static=static, scale=scale)
    simulation = make_simulation(GROUND, text.replace(f"<scale>{scale}", "<scale>1 1 1", 2).replace("1 1 1", scale, 1))
    assert not simulation.scene.diagnostics
    geoms = [geom for geom in simulation.scene.spec.geoms if geom.type == mujoco.mjtGeom.mjGEOM_MESH]
    assert len(geoms) == 1, "the visual remains"
    simulation.advance(NANOSECONDS_PER_SECOND // 10)


def test_missing_mesh_is_reported_once(tmp_path):
    simulation = make_simulation(GROUND, mesh_model(tmp_path / "none.stl"))
    (diagnostic,) = simulation.scene.diagnostics
    assert diagnostic.code == "SIM112"
    assert "none.stl" in diagnostic.message
    assert diagnostic.span is not None
    simulation.advance(NANOSECONDS_PER_SECOND // 10)


def test_mesh_with_too_many_triangles_is_omitted(room, monkeypatch):
    monkeypatch.setattr("linkwright.simulation.scene.meshes._MAX_TRIANGLES", 7)
    simulation = make_simulation(GROUND, mesh_model(room))
    (diagnostic,) = simulation.scene.diagnostics
    assert diagnostic.code == "SIM115"
    assert "has 8 triangles, but the maximum is 7" in diagnostic.message
    simulation.advance(NANOSECONDS_PER_SECOND // 10)


def test_heightmap_supports_models(tmp_path):
    path = tmp_path / "heights.png"
    values = np.zeros((33, 33), dtype=np.uint8)
    values[:, 16:] = 255  # the half where x is positive is high
    Image.fromarray(values).save(path)
    shape = (
        f"<geometry><heightmap><uri>{path.as_uri()}</uri><size>8 8 2</size><pos>0 0 0.5</pos></heightmap></geometry>"
    )
    ground = (
        f'<model name="g"><static>true</static><link name="l"><collision name="c">{shape}</collision></link></model>'
    )
    simulation = make_simulation(
        ground, box("high", "2 0 4 0 0 0", "0.2 0.2 0.2"), box("low", "-2 0 4 0 0 0", "0.2 0.2 0.2")
    )
    simulation.advance(3 * NANOSECONDS_PER_SECOND)
    assert simulation.model_pose("high")[2] == pytest.approx(2.6, abs=0.01)
    assert simulation.model_pose("low")[2] == pytest.approx(0.6, abs=0.01)
    assert read_heights(path).values.max() == 1.0


def test_unreadable_heightmap_image_is_reported(tmp_path):
    path = tmp_path / "heights.png"
    path.write_text("no image")
    library = MeshLibrary(finder())
    library.spec = mujoco.MjSpec()
    assert (
        library.collisions(library.spec.worldbody, Heightmap(path.as_uri()), (0, 0, 0, 0, 0, 0, 1), None, fixed=True)
        == []
    )
    (diagnostic,) = library.diagnostics
    assert diagnostic.code == "SIM113"


def test_polyline_is_extruded():
    shape = (
        "<geometry><polyline><point>-1 -1</point><point>1 -1</point><point>1 1</point><point>0 0</point>"
        "<point>-1 1</point><height>0.5</height></polyline></geometry>"
    )
    ground = (
        f'<model name="g"><static>true</static><link name="l"><collision name="c">{shape}</collision></link></model>'
    )
    simulation = make_simulation(
        GROUND, ground, box("on", "0 -0.5 1 0 0 0", "0.1 0.1 0.1"), box("in", "0 0.6 1 0 0 0", "0.1 0.1 0.1")
    )
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert simulation.model_pose("on")[2] == pytest.approx(0.55, abs=1e-3)
    assert simulation.model_pose("in")[2] == pytest.approx(0.05, abs=1e-3)


def test_auto_inertial_computes_mass():
    model = """<model name="m"><link name="l"><inertial auto="true"><density>500</density></inertial>
    <collision name="c"><pose>0 0 1 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry></collision>
    </link></model>"""
    body = make_simulation(model).model.body("m::l")
    assert body.mass[0] == pytest.approx(3000.0)
    assert body.ipos == pytest.approx([0, 0, 1])
    assert sorted(body.inertia) == pytest.approx([250 * 5, 250 * 10, 250 * 13])


def test_invalid_mass_and_inertia_are_reported():
    model = """<model name="m"><link name="l"><inertial><mass>-1</mass><inertia><ixx>-1</ixx></inertia></inertial>
    </link></model>"""
    simulation = make_simulation(model)
    assert [diagnostic.code for diagnostic in simulation.scene.diagnostics] == ["SIM110", "SIM111"]
    simulation.advance(NANOSECONDS_PER_SECOND)


def inertia_element(ixx: float, iyy: float, izz: float) -> Simulation:
    inertia = f"<inertia><ixx>{ixx!r}</ixx><iyy>{iyy!r}</iyy><izz>{izz!r}</izz></inertia>"
    return make_simulation(
        f'<model name="m"><link name="l"><inertial><mass>1</mass>{inertia}</inertial></link></model>'
    )


def test_inertia_violating_triangle_inequality_is_reported():
    simulation = inertia_element(1.0, 1.0, 9.0)
    (diagnostic,) = simulation.scene.diagnostics
    assert (diagnostic.code, "the mean of its moments is used" in diagnostic.message) == ("SIM111", True)
    assert simulation.model.body("m::l").inertia == pytest.approx([11 / 3] * 3)


@pytest.mark.parametrize("izz", [2.0, 2.0000000000000004, 1.9999999999999998, 2.000001])
def test_flat_bodies_keep_their_inertia(izz):
    simulation = inertia_element(1.0, 1.0, izz)
    assert simulation.scene.diagnostics == []
    assert sorted(simulation.model.body("m::l").inertia) == pytest.approx([1.0, 1.0, 2.0], rel=1e-5)


def arm_model(second: str) -> str:
    link = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
    return f"""<model name="arm"><link name="base">{link}</link>
    <link name="one">{link}</link><link name="two">{link}</link>
    <joint name="hold" type="fixed"><parent>world</parent><child>base</child></joint>
    <joint name="a" type="revolute"><parent>base</parent><child>one</child><axis><xyz>0 0 1</xyz></axis></joint>
    <joint name="b" type="revolute"><parent>base</parent><child>two</child><axis><xyz>0 0 1</xyz>{second}</axis></joint>
    </model>"""


def test_mimic_joint_follows_other_joint():
    mimic = '<mimic joint="a"><multiplier>-2</multiplier><offset>0.5</offset><reference>0</reference></mimic>'
    simulation = make_simulation(arm_model(mimic))
    simulation.push("arm::one", (0.0, 0.0, 0.0), (0.0, 0.0, 0.1))
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    leader, follower = (simulation.joint_state(f"arm::{name}")[0] for name in ("a", "b"))
    assert leader > 0.05
    assert follower == pytest.approx(0.5 - 2 * leader, abs=0.02)


def test_links_of_model_collide_only_with_self_collide():
    shape = "<collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>"
    text = f"""<model name="m"><self_collide>{{}}</self_collide><link name="a">{shape}</link>
    <link name="b"><pose>0 0 0.15 0 0 0</pose>{shape}</link></model>"""
    distances = {}
    for self_collide in ("false", "true"):
        simulation = make_simulation(text.format(self_collide), gravity="0 0 0")
        simulation.advance(NANOSECONDS_PER_SECOND)
        distances[self_collide] = simulation.link_pose("m::b")[2] - simulation.link_pose("m::a")[2]
    assert distances["false"] == pytest.approx(0.15)
    assert distances["true"] > 0.17


def test_mesh_wheel_has_single_contact_point(tmp_path):
    angles = np.linspace(0, 2 * np.pi, 25)[:-1]
    rim = [(0.1 * np.cos(angle), y, 0.1 * np.sin(angle)) for angle in angles for y in (-0.02, 0.02)]
    facets = "".join(quad_facets(rim[i], rim[i + 1], rim[(i + 3) % 48], rim[(i + 2) % 48]) for i in range(0, 48, 2))
    path = tmp_path / "wheel.stl"
    path.write_text(ROOM.format(facets=facets))
    text = f"""<model name="m"><link name="base"/><link name="wheel"><collision name="c"><geometry><mesh>
    <uri>{path.as_uri()}</uri></mesh></geometry></collision></link>
    <joint name="j" type="continuous"><parent>base</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>
    </model>"""
    scene = Scene(world(text), MeshLibrary(finder()))
    scene.add_velocity_motor("m::j", 1.0, 5.0)
    scene.set_wheel_surfaces()
    (geom,) = scene.bodies["m::wheel"].geoms
    assert geom.type == mujoco.mjtGeom.mjGEOM_ELLIPSOID
    assert geom.size == pytest.approx([0.1, 0.1, 0.02], rel=1e-4)
    scene.spec.compile()


@pytest.mark.parametrize(("order", "magic"), [("<", b"II*\0"), (">", b"MM\0*")])
def test_elevation_model_supports_64_bit_heights(tmp_path, order, magic):
    heights = np.array([[10.0, 20.0, 30.0], [30.0, 50.0, 10.0]])
    tags = {256: 3, 257: 2, 258: 64, 259: 1, 273: 8, 277: 1, 279: 48, 339: 3}
    entries = b"".join(struct.pack(f"{order}HHII", tag, 4, 1, value) for tag, value in tags.items())
    table = struct.pack(f"{order}H", len(tags)) + entries + bytes(4)
    path = tmp_path / "hill.tif"
    path.write_bytes(magic + struct.pack(f"{order}I", 56) + heights.astype(f"{order}f8").tobytes() + table)
    assert read_heights(path).values.tolist() == [[0.5, 1.0, 0.0], [0.0, 0.25, 0.5]]


@pytest.mark.parametrize("text", [b"II*\0", b"MM\0*" + bytes(20), b"II*\0\x08\0\0\0\x01\0" + bytes(12)])
def test_malformed_elevation_model_is_rejected(tmp_path, text):
    path = tmp_path / "hill.tif"
    path.write_bytes(text)
    with pytest.raises(LinkwrightError, match="cannot read the image"):
        read_heights(path)


def test_degenerate_mesh_parts_do_not_omit_model(tmp_path):
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
    parts = "usemtl a\nf 1 2 3\nusemtl b\nf 4 5 6\nf 4 6 5\nf 1 2 5\nusemtl c\nf 1 2 2\n"
    (tmp_path / "parts.obj").write_text(f"mtllib parts.mtl\n{corners}{parts}")
    colors = enumerate(("1 0 0", "0 1 0", "0 0 1"))
    (tmp_path / "parts.mtl").write_text("".join(f"newmtl {'abc'[number]}\nKd {color}\n" for number, color in colors))
    visual = f'<visual name="v"><geometry><mesh><uri>file://{tmp_path}/parts.obj</uri></mesh></geometry></visual>'
    simulation = make_simulation(f'<model name="m"><static>true</static><link name="l">{visual}</link></model>')
    assert not simulation.scene.diagnostics
    model = simulation.model
    geometry_colors = [model.mat_rgba[model.geom_matid[geom], :3].tolist() for geom in range(model.ngeom)]
    assert sorted(geometry_colors) == [[0, 1, 0], [1, 0, 0]]


def test_meshes_with_same_image_share_texture(tmp_path):
    Image.new("RGB", (4, 4), "red").save(tmp_path / "i.png")
    (tmp_path / "m.mtl").write_text("newmtl m\nmap_Kd i.png\n")
    shapes = []
    for name in ("one", "two"):
        path = tmp_path / f"{name}.obj"
        path.write_text("mtllib m.mtl\nvt 0 0\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n")
        shapes.append(f"<visual name='{name}'><geometry><mesh><uri>{path}</uri></mesh></geometry></visual>")
    model = make_simulation(f"<model name='m'><static>1</static><link name='l'>{''.join(shapes)}</link></model>").model
    assert (model.nmesh, model.nmat, model.ntex) == (2, 2, 1)
