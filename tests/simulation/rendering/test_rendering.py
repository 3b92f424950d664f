"""Images of all renderers: colors, distances, and the positions of objects in the image."""

from __future__ import annotations

from dataclasses import replace
from math import pi, tan

import numpy as np
import pytest
from PIL import Image

from linkwright.geometry.single import IDENTITY
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.cameras import Camera, Clip, Distortion, ImageFormat, Intrinsics
from linkwright.sdf.optics import Optics, distort, make_optics, undistort
from linkwright.simulation.rendering import opengl
from linkwright.simulation.rendering.factory import METHODS, make_renderer
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.simulation import Simulation
from tests.simulation.sensors.rooms import block
from tests.simulation.worlds import make_simulation, model

CAMERA = Camera(horizontal_fov=pi / 2, image=ImageFormat(160, 120), clip=Clip(0.05, 50.0))
LENS = Distortion(-0.25, 0.12, -0.01, 0.001, -0.002)
FLOOR = """
<model name="floor"><static>true</static><link name="link"><visual name="visual">
  <geometry><plane><normal>0 0 1</normal></plane></geometry>
</visual></link></model>"""


def make_renderer_or_skip(simulation: Simulation, method: str):
    """Return a renderer of one method; skip the test if this machine cannot create it."""
    try:
        return make_renderer(simulation, method)
    except Exception as error:  # noqa: BLE001 - missing libraries raise many types of errors
        pytest.skip(f"{method} does not work here: {error}")


@pytest.fixture(params=METHODS)
def make_renderer_of_method(request: pytest.FixtureRequest):
    """Return a function that creates a renderer of one method.

    Methods that fail here are skipped.
    """
    renderers = []

    def renderer(simulation: Simulation):
        new_renderer = make_renderer_or_skip(simulation, request.param)
        renderers.append(new_renderer)
        return new_renderer

    yield renderer
    for open_renderer in renderers:
        open_renderer.close()


def test_depth_of_walls_is_exact(make_renderer_of_method):
    simulation = make_simulation(
        block("wall", "3.5 0 0 0 0 0", "1 20 20"), block("box", "2 0.5 0 0 0 0", "0.5 0.5 0.5")
    )
    depth = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.DEPTH).depth
    assert depth.shape == (120, 160)
    assert depth.dtype == np.float32
    assert depth[60, 60] == pytest.approx(1.75, abs=1e-3)
    assert np.abs(depth[:, 100:] - 3.0).max() < 1e-3


def test_depth_is_same_with_and_without_color(make_renderer_of_method):
    simulation = make_simulation(FLOOR, block("box", "2 0.5 0 0 0 0", "0.5 0.5 0.5", color="1 0 0 1"))
    renderer, optics, pose = (
        make_renderer_of_method(simulation),
        make_optics(CAMERA),
        (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    )
    depth_and_color = renderer.render(optics, pose, Channels.DEPTH | Channels.COLOR)
    depth_only = renderer.render(optics, pose, Channels.DEPTH)
    repeated = renderer.render(optics, pose, Channels.DEPTH | Channels.COLOR)
    assert (depth_only.depth == depth_and_color.depth).all()
    assert depth_only.color is None
    assert (repeated.color == depth_and_color.color).all()


def test_floor_extends_to_horizon(make_renderer_of_method):
    pose = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    optics = make_optics(CAMERA)
    depth = make_renderer_of_method(make_simulation(FLOOR)).render(optics, pose, Channels.DEPTH).depth
    rows = np.arange(65, 120)
    expected = optics.fy / (rows + 0.5 - optics.cy)
    assert depth[65:, 80] == pytest.approx(expected, abs=1e-3)
    assert np.isinf(depth[:59]).all()


def test_floor_depth_does_not_depend_on_light(make_renderer_of_method):
    pose, optics = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), make_optics(CAMERA)
    lamp = '<light name="lamp" type="point"><pose>3 0 2 0 0 0</pose><diffuse>1 1 1 1</diffuse></light>'
    under_the_sun = make_renderer_of_method(make_simulation(FLOOR)).render(
        optics, pose, Channels.DEPTH | Channels.GEOMS
    )
    under_a_lamp = make_renderer_of_method(make_simulation(FLOOR, lamp)).render(
        optics, pose, Channels.DEPTH | Channels.GEOMS
    )
    assert under_a_lamp.depth[65:] == pytest.approx(under_the_sun.depth[65:], abs=1e-3)
    assert (under_a_lamp.geoms[65:] == under_the_sun.geoms[65:]).all()


def test_floor_is_invisible_from_below(make_renderer_of_method):
    image = make_renderer_of_method(make_simulation(FLOOR)).render(
        make_optics(CAMERA), (0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0), Channels.DEPTH
    )
    assert np.isinf(image.depth).all()


@pytest.mark.parametrize("position", ["2 2.2 0", "2 -2.2 0", "2 0 1.7", "2 0 -1.7"])
def test_partly_visible_object_is_rendered(make_renderer_of_method, position):
    simulation = make_simulation(block("thing", f"{position} 0 0 0", "0.9 0.9 0.9"))
    geoms = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.GEOMS).geoms
    assert (geoms >= 0).any()


def test_objects_outside_clip_range_are_not_rendered(make_renderer_of_method):
    simulation = make_simulation(
        block("near", "0.3 0.1 0 0 0 0", "0.1 0.1 0.1"), block("far", "60 0 0 0 0 0", "1 90 90")
    )
    optics = replace(make_optics(CAMERA), near=0.5)
    rendered = make_renderer_of_method(simulation).render(optics, IDENTITY, Channels.DEPTH | Channels.COLOR)
    assert np.isinf(rendered.depth).all()
    assert (rendered.color == round(0.7 * 255)).all()


def test_colors_match_objects(make_renderer_of_method):
    simulation = make_simulation(
        block("left", "2 1 0 0 0 0", "0.1 1 1", color="1 0 0 1"),
        block("right", "2 -1 0 0 0 0", "0.1 1 1", color="0 1 0 1"),
    )
    renderer = make_renderer_of_method(simulation)
    color = renderer.render(make_optics(CAMERA), IDENTITY, Channels.COLOR).color
    red, green = color[60, 40].astype(int), color[60, 120].astype(int)
    assert red[0] > 50
    assert red[1] == red[2] == 0
    assert green[1] > 50
    assert green[0] == green[2] == 0


QUAD_OBJ = """v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0 -1 1
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 2/2\nf 1/1 3/3 4/4\nf 1/1 4/4 3/3\n"""
PANEL = """<model name="panel"><static>true</static><pose>2 0 0 0 0 0</pose><link name="link"><visual name="v">
<geometry><mesh><uri>file://{folder}/quad.obj</uri></mesh></geometry><material><pbr><metal><{kind}_map>file://{folder}/{image}</{kind}_map>
</metal></pbr></material></visual></link></model>"""


@pytest.mark.parametrize("kind", ["albedo", "emissive"])
def test_meshes_are_textured(make_renderer_of_method, tmp_path, kind, request):
    (tmp_path / "quad.obj").write_text(QUAD_OBJ)
    image = Image.new("RGB", (64, 64), (255, 0, 0))
    image.paste((0, 0, 255), (32, 0, 64, 64))  # the right half of the image, which the camera sees on the left
    image.save(tmp_path / "halves.png")
    simulation = make_simulation(PANEL.format(folder=tmp_path, kind=kind, image="halves.png"))
    assert not simulation.scene.diagnostics
    color = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.COLOR).color.astype(int)
    left, right = color[60, 60], color[60, 100]
    assert left[1] == right[1] == 0
    if request.node.callspec.params["make_renderer_of_method"] in (
        "embree",
        "mujoco",
    ):  # these renderers draw each shape in one color
        assert left[0] == left[2] > 50
        return
    assert left[2] > 50
    assert left[0] == 0
    assert right[0] > 50
    assert right[2] == 0
    if kind == "emissive":
        assert left[2] >= 250


def test_missing_texture_is_reported_once(tmp_path):
    (tmp_path / "quad.obj").write_text(QUAD_OBJ)
    panel = PANEL.format(folder=tmp_path, kind="albedo", image="none.png")
    simulation = make_simulation(panel, panel.replace('name="panel"', 'name="other"'))
    (finding,) = simulation.scene.diagnostics
    assert finding.code == "SIM112"
    assert str(finding.message).startswith("an image is left out: ")


QUARTER_COLORS = ((255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0))
"""The colors of an image: top left, top right, bottom left, bottom right."""
TEXTURED = """<model name="thing"><static>true</static><pose>2 0 0 0 0 0</pose><link name="link"><visual name="v">
<geometry>{shape}</geometry><material><pbr><metal><albedo_map>file://{image}</albedo_map></metal></pbr></material></visual></link></model>"""


@pytest.mark.parametrize(
    ("shape", "distance", "order"),
    [
        ("<box><size>1 1 1</size></box>", 1.5, (0, 1, 2, 3)),
        ("<plane><normal>-1 0 0</normal><size>1 1</size></plane>", 2.0, None),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", 1.5, None),
        ("<sphere><radius>0.6</radius></sphere>", 1.4, None),
    ],
)
def test_primitive_shapes_are_textured(make_renderer_of_method, tmp_path, shape, distance, order, request):
    texture = Image.new("RGB", (64, 64))
    for index, quarter in enumerate(QUARTER_COLORS):
        column, row = 32 * (index % 2), 32 * (index // 2)
        texture.paste(quarter, (column, row, column + 32, row + 32))
    texture.save(tmp_path / "quarters.png")
    text = TEXTURED.format(shape=shape, image=tmp_path / "quarters.png")
    simulation = make_simulation(text)
    assert not simulation.scene.diagnostics
    image = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.COLOR | Channels.DEPTH)
    assert image.depth[60, 80] == pytest.approx(distance, abs=2e-3)
    if request.node.callspec.params["make_renderer_of_method"] in (
        "embree",
        "mujoco",
    ):  # these renderers draw each shape in one color
        red, green, blue = image.color[60, 80].astype(int)
        assert red == green > 0
        assert blue == pytest.approx(red / 2, abs=2)
        return
    color = image.color.astype(int)
    corners = [tuple(color[row, column] > 40) for row in (50, 70) for column in (70, 90)]
    expected_quarters = [tuple(np.array(quarter) > 0) for quarter in QUARTER_COLORS]
    assert set(corners) <= set(expected_quarters)
    assert len(set(corners)) >= 2
    if order is not None:
        assert corners == [expected_quarters[index] for index in order]


def test_box_with_missing_texture_is_reported(tmp_path):
    simulation = make_simulation(TEXTURED.format(shape="<box><size>1 1 1</size></box>", image=tmp_path / "none.png"))
    assert [diagnostic.code for diagnostic in simulation.scene.diagnostics] == ["SIM112"]
    assert simulation.model.nmesh == 0


@pytest.mark.parametrize("point", [(2.0, 0.5, 0.3), (2.0, -1.2, -0.6), (3.0, 2.0, 1.5)])
def test_positions_match_pinhole_model(make_renderer_of_method, point):
    x, y, z = point
    size = 0.2
    simulation = make_simulation(block("thing", f"{x} {y} {z} 0 0 0", f"0.001 {size} {size}"))
    optics = make_optics(CAMERA)
    geoms = make_renderer_of_method(simulation).render(optics, IDENTITY, Channels.GEOMS).geoms
    rows, columns = np.nonzero(geoms >= 0)
    assert len(rows) > 10
    focal = 160 / (2 * tan(pi / 4))
    before_edge = x - 0.0005
    assert columns.min() == pytest.approx(80 - focal * (y + size / 2) / before_edge, abs=0.5 + 1e-6)
    assert columns.max() + 1 == pytest.approx(80 - focal * (y - size / 2) / before_edge, abs=0.5 + 1e-6)
    assert rows.min() == pytest.approx(60 - focal * (z + size / 2) / before_edge, abs=0.5 + 1e-6)
    assert rows.max() + 1 == pytest.approx(60 - focal * (z - size / 2) / before_edge, abs=0.5 + 1e-6)


def test_positions_match_lens_distortion_model(make_renderer_of_method):
    size, x, y, z = 0.2, 2.0, 1.2, 0.8
    simulation = make_simulation(block("thing", f"{x} {y} {z} 0 0 0", f"0.001 {size} {size}"))
    optics = make_optics(Camera(horizontal_fov=pi / 2, image=ImageFormat(160, 120), distortion=LENS))
    geoms = make_renderer_of_method(simulation).render(optics, IDENTITY, Channels.GEOMS).geoms
    rows, columns = np.nonzero(geoms >= 0)
    (pixel,) = optics.project(np.array([[-y, -z, x]]))
    assert columns.mean() + 0.5 == pytest.approx(pixel[0], abs=0.5)
    assert rows.mean() + 0.5 == pytest.approx(pixel[1], abs=0.5)


def test_shapes_have_correct_extent(make_renderer_of_method):
    shapes = (
        "<sphere><radius>0.5</radius></sphere>",
        "<cylinder><radius>0.5</radius><length>1</length></cylinder>",
        "<capsule><radius>0.5</radius><length>1</length></capsule>",
        "<ellipsoid><radii>0.5 0.4 0.3</radii></ellipsoid>",
        "<cone><radius>0.5</radius><length>1</length></cone>",
    )
    for shape in shapes:
        text = (
            '<model name="thing"><static>true</static><pose>2 0 0 0 0 0</pose><link name="link"><visual name="visual">'
            f"<geometry>{shape}</geometry></visual></link></model>"
        )
        depth = (
            make_renderer_of_method(make_simulation(text)).render(make_optics(CAMERA), IDENTITY, Channels.DEPTH).depth
        )
        assert 1.4 < depth[60, 80] < 2.0, shape
        assert np.isinf(depth[0, 0]), shape


def test_spawned_and_moved_models_are_rendered(make_renderer_of_method):
    simulation = make_simulation(FLOOR)
    renderer, optics = make_renderer_of_method(simulation), make_optics(CAMERA)
    high = (0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 1.0)
    assert np.isinf(renderer.render(optics, high, Channels.DEPTH).depth[60, 80])
    geometry = "<geometry><box><size>1 1 1</size></box></geometry>"
    box = model(f'<model name="box"><link name="link"><visual name="v">{geometry}</visual></link></model>')
    simulation.spawn(box, "box", (3.0, 0.0, 5.0, 0.0, 0.0, 0.0, 1.0))
    assert renderer.render(optics, high, Channels.DEPTH).depth[60, 80] == pytest.approx(2.5, abs=1e-3)
    simulation.advance(10**9)
    assert np.isinf(renderer.render(optics, high, Channels.DEPTH).depth[60, 80])


def test_camera_does_not_see_its_own_housing(make_renderer_of_method):
    housing = "<geometry><box><size>0.06 0.06 0.06</size></box></geometry>"
    camera_housing = f'<model name="camera"><link name="link"><visual name="v">{housing}</visual></link></model>'
    simulation = make_simulation(block("wall", "3 0 0 0 0 0", "1 20 20"), camera_housing)
    depth = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.DEPTH).depth
    assert np.abs(depth - 2.5).max() < 1e-3


def test_renderers_produce_same_image(make_renderer_of_method):
    wall = block("wall", "4 0 1 0 0 0", "0.1 3 2", color="0 0 1 1")
    simulation = make_simulation(FLOOR, block("box", "2 0.4 0.3 0 0 0.5", "0.5 0.5 0.6"), wall)
    pose, optics = (0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0), make_optics(CAMERA)
    exact = make_renderer(simulation, "mujoco").render(optics, pose, Channels.COLOR | Channels.GEOMS)
    image = make_renderer_of_method(simulation).render(optics, pose, Channels.COLOR | Channels.GEOMS)
    assert (exact.geoms != image.geoms).mean() < 0.01
    difference = np.abs(exact.color.astype(int) - image.color.astype(int)).max(axis=-1)
    assert np.median(difference) <= 3
    assert (difference > 20).mean() < 0.02


ROUND_SHAPES = "".join(
    f'<model name="{name}"><static>true</static><pose>{pose}</pose><link name="link"><visual name="visual"><geometry>'
    f"<{name}><radius>0.3</radius>{extra}</{name}></geometry></visual></link></model>"
    for name, extra, pose in (
        ("cylinder", "<length>0.8</length>", "1.5 0.7 0 0.5 0.4 0"),
        ("capsule", "<length>0.8</length>", "1.5 -0.7 0 0.5 -0.4 0"),
        ("sphere", "", "1.5 0 0 0.5 0.6 0.7"),
    )
)


@pytest.fixture(params=opengl.BACKENDS)
def draw_with_opengl(request: pytest.FixtureRequest):
    """Return a function that draws a world with OpenGL, and counts the triangles and quads."""

    def draw(simulation: Simulation):
        from OpenGL import GL

        renderer = make_renderer_or_skip(simulation, request.param)
        try:
            renderer.render(make_optics(CAMERA), IDENTITY, Channels.COLOR)
            (query,) = GL.glGenQueries(1, np.zeros(1, np.uint32))
            GL.glBeginQuery(GL.GL_PRIMITIVES_GENERATED, query)
            image = renderer.render(make_optics(CAMERA), IDENTITY, Channels.COLOR | Channels.DEPTH)
            GL.glEndQuery(GL.GL_PRIMITIVES_GENERATED)
            return image, int(GL.glGetQueryObjectuiv(query, GL.GL_QUERY_RESULT))
        finally:
            renderer.close()

    return draw


@pytest.mark.parametrize("light", ["", '<light name="lamp" type="point"><pose>0 1 1 0 0 0</pose></light>'])
def test_round_shapes_match_mujoco(draw_with_opengl, monkeypatch, light):
    simulation = make_simulation(ROUND_SHAPES, light)
    linkwright_image, linkwright_count = draw_with_opengl(simulation)
    monkeypatch.setattr(opengl, "_BUILT_IN", 0)
    mujoco_image, mujoco_count = draw_with_opengl(simulation)
    difference = np.abs(linkwright_image.color.astype(int) - mujoco_image.color).max(axis=-1)
    assert (mujoco_image.color != mujoco_image.color[0, 0]).any(axis=-1).mean() > 0.1
    assert (difference > 1).mean() < 1e-3
    is_visible = np.isfinite(linkwright_image.depth) & np.isfinite(mujoco_image.depth)
    assert linkwright_image.depth[is_visible] == pytest.approx(mujoco_image.depth[is_visible], abs=1e-3)
    assert (np.isfinite(linkwright_image.depth) != is_visible).sum() < 20
    # MuJoCo draws quads, and Linkwright draws triangles.
    assert linkwright_count < mujoco_count if not light else linkwright_count != mujoco_count


def test_point_light_lights_nearby_objects(make_renderer_of_method):
    lamp = (
        '<light name="lamp" type="point"><pose>1.5 1 0 0 0 0</pose><attenuation><range>9</range></attenuation></light>'
    )
    simulation = make_simulation(
        block("one", "2 1 0 0 0 0", "0.1 1 1"), block("other", "2 -1 0 0 0 0", "0.1 1 1"), lamp
    )
    color = make_renderer_of_method(simulation).render(make_optics(CAMERA), IDENTITY, Channels.COLOR).color
    assert color[60, 40, 0] > color[60, 120, 0] + 20


def test_undistort_inverts_distort():
    points = np.linspace(-0.6, 0.6, 13), np.linspace(-0.4, 0.5, 13)
    assert undistort(LENS, *distort(LENS, *points)) == pytest.approx(np.array(points), abs=1e-9)


def test_intrinsics_replace_field_of_view():
    optics = make_optics(Camera(image=ImageFormat(640, 480), intrinsics=Intrinsics(500.0, 520.0, 310.0, 250.0)))
    assert (optics.fx, optics.fy, optics.cx, optics.cy) == (500.0, 520.0, 310.0, 250.0)
    assert not optics.is_pinhole
    assert make_optics(CAMERA) == Optics(160, 120, pytest.approx(80.0), pytest.approx(80.0), 80.0, 60.0, 0.05, 50.0)


def floating_box(name: str, pose: str, size: float = 0.5) -> str:
    """Return a box without gravity: it rests until its pose is set."""
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="link"><gravity>false</gravity>'
        f'<visual name="v"><geometry><box><size>{size} {size} {size}</size></box></geometry></visual></link></model>'
    )


def test_resting_and_moving_models_are_rendered_at_current_pose(make_renderer_of_method):
    simulation = make_simulation(floating_box("one", "2 0 0 0 0 0"), floating_box("two", "3 1 0 0 0 0"))
    renderer, optics = make_renderer_of_method(simulation), make_optics(CAMERA)

    def depths():
        """Return the depth images of the existing renderer and of a new renderer."""
        return tuple(
            candidate.render(optics, IDENTITY, Channels.DEPTH).depth
            for candidate in (renderer, make_renderer_of_method(simulation))
        )

    for pose in (None, (2.5, -0.5, 0.3, 0.0, 0.0, 0.0, 1.0), (-2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)):
        if pose is not None:
            simulation.set_model_pose("one", pose)
        for _ in range(3):
            depth, new_depth = depths()
            assert (depth == new_depth).all()
            simulation.advance(NANOSECONDS_PER_SECOND // 5)
    assert np.isfinite(depth).any()
    simulation.reset()
    depth, new_depth = depths()
    assert depth[60, 80] == pytest.approx(1.75, abs=1e-3)
    assert (depth == new_depth).all()


def test_resting_housing_does_not_hide_camera_view(make_renderer_of_method):
    simulation = make_simulation(
        floating_box("housing", "0 0 0 0 0 0", 0.06), block("wall", "3.5 0 0 0 0 0", "1 20 20")
    )
    renderer, optics = make_renderer_of_method(simulation), make_optics(CAMERA)
    behind_housing = (-2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    for _ in range(3):
        assert renderer.render(optics, IDENTITY, Channels.DEPTH).depth[60, 80] == pytest.approx(3.0, abs=1e-3)
        assert renderer.render(optics, behind_housing, Channels.DEPTH).depth[60, 80] == pytest.approx(1.97, abs=1e-3)
        simulation.advance(NANOSECONDS_PER_SECOND // 5)
