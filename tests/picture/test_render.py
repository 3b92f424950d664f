"""The contents of rendered images."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.shapes import IDENTITY, Placement
from linkwright.picture.bodies import Axes, Color
from linkwright.picture.camera import VIEWS, View
from linkwright.picture.rendering import Style, render
from linkwright.picture.robots import GHOST_COLOR, OUTLINE_COLOR
from linkwright.picture.scene import Scene, camera_for
from tests.picture.robots import BLUE, GREEN, RED, joint, link, make_scene, render_image, strongest_channel, urdf

BOX = '<box size="1 1 1"/>'
ONE = urdf(link("base", BOX, RED))


def two_boxes(front: str, back: str) -> str:
    """Return two boxes, one in front of the other along x."""
    return urdf(link("base", BOX, front, "1 0 0"), link("other", BOX, back, "-1 0 0"), joint("j", "base", "other"))


def test_red_box_is_drawn_on_gray_background() -> None:
    pixels = render_image(ONE)
    assert pixels.shape == (90, 120, 4)
    assert strongest_channel(pixels[45, 60]) == "red"
    assert strongest_channel(pixels[2, 2]) == "grey"
    assert (pixels[:, :, 3] == 255).all()


def test_nearer_box_hides_other_from_each_side() -> None:
    assert strongest_channel(render_image(two_boxes(RED, BLUE), "front")[45, 60]) == "red"
    back = render(make_scene(two_boxes(RED, BLUE)), View(180.0, 0.0), (120, 90))
    assert strongest_channel(back[45, 60]) == "blue"


def test_link_order_does_not_affect_visibility() -> None:
    reordered = urdf(link("other", BOX, BLUE, "-1 0 0"), link("base", BOX, RED, "1 0 0"), joint("j", "other", "base"))
    assert strongest_channel(render_image(reordered)[45, 60]) == "red"


def test_coplanar_surfaces_do_not_flicker() -> None:
    """Two meshes contain the same face with different rounding.

    The first mesh is visible everywhere.
    """
    text = urdf(
        link("base", BOX, RED, rpy="0.3 0.2 0.4"),
        link("other", BOX, BLUE, rpy="0.3 0.2 0.4"),
        joint("j", "base", "other"),
    )
    pixels = render_image(text, "iso")
    assert not any(strongest_channel(pixel) == "blue" for pixel in pixels.reshape(-1, 4))


@pytest.mark.parametrize("view", ["front", "left", "top"])
def test_sphere_is_symmetrical(view: str) -> None:
    alpha = render_image(urdf(link("base", '<sphere radius="1"/>', RED)), view, (101, 101), transparent=True)[:, :, 3]
    covered = alpha > 127 if view != "top" else alpha == 255
    assert (covered == covered[:, ::-1]).all()
    assert (covered == covered[::-1]).all()


def test_left_and_up_match_rep_103() -> None:
    text = urdf(
        link("base", BOX, RED),
        link("left", BOX, GREEN, "0 2 0"),
        link("up", BOX, BLUE, "0 0 2"),
        joint("a", "base", "left"),
        joint("b", "base", "up"),
    )
    front = render_image(text)
    # A viewer in front of the robot sees the robot's left side on the right.
    assert strongest_channel(front[68, 94]) == "green"
    assert strongest_channel(front[22, 26]) == "blue" or strongest_channel(front[22, 35]) == "blue"
    top = render_image(text, "top")
    assert [strongest_channel(top[45, column]) for column in (25, 95)] == [
        "green",
        "blue",
    ]  # forward is up, left is left


@pytest.mark.parametrize("view", [*VIEWS.values(), View(-70.0, -35.0), View(10.0, 75.0, perspective=False)])
def test_robot_fits_and_fills_image(view: View) -> None:
    text = urdf(
        link("base", '<box size="3 0.2 0.1"/>', RED),
        link("mast", '<cylinder radius="0.05" length="2"/>', RED, "1 0 1"),
        joint("j", "base", "mast"),
    )
    camera = camera_for(view, (160, 120), make_scene(text))
    x, y, _ = camera.project(make_scene(text).points)
    assert x.min() > 0
    assert x.max() < 160
    assert y.min() > 0
    assert y.max() < 120
    assert max((x.max() - x.min()) / 160, (y.max() - y.min()) / 120) > 0.8


def test_two_robots_share_camera() -> None:
    small_scene, large_scene = make_scene(ONE), make_scene(urdf(link("base", '<box size="3 3 3"/>', RED)))
    camera = camera_for(VIEWS["front"], (480, 360), small_scene, large_scene)
    covered = [
        int((render(scene, style=Style(transparent=True), camera=camera)[:, :, 3] == 255).sum())
        for scene in (small_scene, large_scene)
    ]
    assert covered[1] == pytest.approx(9 * covered[0], rel=0.1)


def test_background_can_be_transparent() -> None:
    pixels = render_image(ONE, "iso", transparent=True)
    assert pixels[0, 0, 3] == 0
    assert pixels[45, 60, 3] == 255
    edge = pixels[(pixels[:, :, 3] > 0) & (pixels[:, :, 3] < 255)]
    assert len(edge) > 20  # smooth outlines, and a shadow


def test_transparent_material_shows_surface_behind() -> None:
    glass = two_boxes("0.9 0.1 0.1 0.4", BLUE)
    red, _, blue, alpha = (int(value) for value in render_image(glass)[45, 60])
    assert red > 80
    assert blue > 80
    assert alpha == 255
    assert strongest_channel(render_image(two_boxes("0.9 0.1 0.1 0", BLUE))[45, 60]) == "blue"


def test_ground_has_shadow_except_in_side_view() -> None:
    floating = urdf(link("base", '<sphere radius="0.5"/>', RED))
    below = render_image(floating, "iso")[86, 60, :3].astype(int)
    assert below.sum() < render_image(floating, "iso")[86, 2, :3].astype(int).sum() - 20
    alpha = render_image(floating, "front", transparent=True)[:, :, 3]
    assert alpha[:, :15].max() == 0


def test_box_edges_are_drawn_dark() -> None:
    pixels = render_image(urdf(link("base", BOX, "1 1 1 1")), "front", (200, 200)).astype(int)
    row = pixels[100, :, :3].sum(axis=1)
    left = int(np.argmax(np.abs(np.diff(row)) > 60))
    assert row[left : left + 4].min() < 530 < row[100]


def count_outline_pixels(view: str, **outlined: Color) -> int:
    """Return the number of pixels with the full color of the outline."""
    shown = render(make_scene(two_boxes(RED, BLUE), outlined=outlined), VIEWS[view], (240, 180))
    distance = np.abs(shown[:, :, :3].astype(int) - [round(value * 255) for value in OUTLINE_COLOR]).max(axis=2)
    return int((distance < 6).sum())


def test_outline_is_faint_behind_other_links() -> None:
    text = two_boxes(RED, BLUE)
    shown = render(make_scene(text, outlined={"other": OUTLINE_COLOR}), VIEWS["iso"], (240, 180))
    plain = render(make_scene(text), VIEWS["iso"], (240, 180))
    changed = np.abs(plain[:, :, :3].astype(int) - shown[:, :, :3]).max(axis=2) > 0
    assert changed.sum() > 150
    assert not changed[:5].any()
    hidden, in_front = (count_outline_pixels("front", **{name: OUTLINE_COLOR}) for name in ("other", "base"))
    assert hidden == 0
    assert in_front > 150


def test_outlined_bodies_that_touch_have_a_line_between_them() -> None:
    text = urdf(link("base", BOX, RED, "0 -0.5 0"), link("other", BOX, BLUE, "0 0.5 0"), joint("j", "base", "other"))

    def middle(**outlined: Color) -> list[int]:
        image = render(make_scene(text, outlined=outlined), VIEWS["front"], (241, 181), Style(transparent=True))
        return image[90, 120, :3].astype(int).tolist()

    expected = np.rint(np.array(OUTLINE_COLOR) * 255)
    assert np.abs(middle(base=OUTLINE_COLOR, other=OUTLINE_COLOR) - expected).max() < 6
    assert np.abs(middle() - expected).max() > 60


@pytest.mark.parametrize("color", ["0.05 0.05 0.05 1", "0.95 0.95 0.95 1"])
def test_tint_of_outlined_bodies_keeps_their_brightness(color: str) -> None:
    text = urdf(link("base", '<box size="1 1 1"/>', color))
    plain, tinted = (
        render(make_scene(text, outlined=outlined), VIEWS["front"], (120, 90))[45, 60, :3].astype(int)
        for outlined in ({}, {"base": OUTLINE_COLOR})
    )
    assert 5 < np.abs(plain - tinted).max() < 60


def test_axes_are_drawn_over_bodies() -> None:
    scene = make_scene(urdf(link("base", '<box size="1 1 1"/>', "0.5 0.5 0.5 1")))
    with_axes = Scene(scene.bodies, axes=[Axes(Placement(IDENTITY, (0.0, 0.0, 0.0)), 0.4)])
    camera = camera_for(VIEWS["iso"], (240, 180), scene)
    plain, shown = (render(each, camera=camera).astype(int) for each in (scene, with_axes))
    differences = shown[:, :, :3] - plain[:, :, :3]
    for channel in range(3):
        others = np.delete(differences, channel, axis=2).max(axis=2)
        assert (differences[:, :, channel] - others > 40).any()


def test_view_from_above_has_no_shadow_on_the_ground() -> None:
    tall = urdf(link("base", '<box size="0.1 0.1 3"/>', RED, "0 0 1.5"))
    image = render_image(tall, "top", (120, 90), transparent=True)
    alpha = image[:, :, 3]
    assert set(np.unique(alpha[:, :15])) == {0}
    assert alpha[45, 60] == 255


def test_ghost_is_translucent_without_shadow() -> None:
    moved = make_scene(urdf(link("base", BOX, RED, "0 1.5 0")), ghost=GHOST_COLOR)
    combined = Scene.__add__(make_scene(ONE), moved)
    camera = camera_for(VIEWS["front"], (200, 100), combined)
    pixels = render(combined, style=Style(transparent=True), camera=camera)
    x, y, _ = camera.project(np.array([(0.5, 1.5, 0.0), (0.5, 0.0, 0.0)]))
    ghost, solid = (pixels[int(row), int(column)] for row, column in zip(y, x, strict=True))
    assert 40 < ghost[3] < 200
    assert strongest_channel(solid) == "red"
    assert solid[3] == 255


def test_grid_is_drawn_on_ground_only_if_enabled() -> None:
    plain, with_grid = render_image(ONE, "iso", (240, 180)), render_image(ONE, "iso", (240, 180), grid=True)
    changed = np.abs(plain.astype(int) - with_grid).max(axis=2) > 8
    assert 500 < changed.sum() < plain.shape[0] * plain.shape[1] / 2
    assert not changed[85:95, 115:125].any()


@pytest.mark.parametrize("labels", ["links", "joints"])
def test_labels_are_dark_text_on_light_background(labels: str) -> None:
    text = urdf(link("base", BOX, RED), link("other", BOX, RED), joint("shoulder", "base", "other", xyz="0 1 0"))
    plain, labeled = render_image(text, size=(320, 240)), render_image(text, size=(320, 240), labels=labels)
    changed = labeled[np.abs(plain.astype(int) - labeled).max(axis=2) > 30][:, :3]
    assert (changed.max(axis=1) < 60).sum() > 10
    assert (changed.min(axis=1) > 200).sum() > 10


def test_large_image_is_identical_when_rendered_in_bands(monkeypatch: pytest.MonkeyPatch) -> None:
    text = two_boxes(RED, "0.1 0.1 0.9 0.5")
    expected = render_image(text, "iso", (160, 120), grid=True)
    monkeypatch.setattr("linkwright.picture.rendering._BAND_SAMPLES", 20_000)
    assert np.abs(render_image(text, "iso", (160, 120), grid=True).astype(int) - expected).max() <= 1


def test_robot_without_visuals_gives_empty_image() -> None:
    assert render_image(urdf('<link name="base"/>'), transparent=True)[:, :, 3].max() == 0


@pytest.mark.parametrize(
    "shape",
    [
        '<sphere radius="0"/>',
        '<box size="0 0 0"/>',
        '<box size="1 0 0"/>',
        '<cylinder radius="0" length="1"/>',
        '<cylinder radius="1e-300" length="1e-300"/>',
    ],
)
def test_shapes_without_size_are_ignored(shape: str) -> None:
    text = urdf(link("base", BOX, RED), link("other", shape, BLUE), joint("j", "base", "other"))
    assert strongest_channel(render_image(text)[45, 60]) == "red"


def test_out_of_range_link_is_omitted_with_finding() -> None:
    slide = '<axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
    text = urdf(
        link("base", BOX, RED), link("other", BOX, BLUE), joint("j", "base", "other", "prismatic", content=slide)
    )
    for broken, positions in (
        (text, {"j": 1e300}),
        (text.replace('<box size="1 1 1"/>', '<box size="1e300 1 1"/>', 1), {}),
        (text.replace('<origin xyz="0 0 0" rpy', '<origin xyz="0 1e12 0" rpy', 1), {}),
    ):
        shown = make_scene(broken, positions)
        assert [problem.code for problem in shown.problems] == ["PIC101"]
        assert strongest_channel(render(shown, VIEWS["front"], (120, 90))[45, 60]) in ("red", "blue")


def test_huge_joint_angle_is_accepted() -> None:
    text = urdf(link("base", BOX, RED), link("other", BOX, BLUE), joint("j", "base", "other", "continuous", "0 0 2"))
    assert make_scene(text, {"j": 1e300}).problems == ()


def test_bodies_cast_shadows_on_each_other() -> None:
    plate = link("base", '<box size="3 3 0.1"/>', "0.8 0.8 0.8 1")
    above = link("other", '<box size="0.5 0.5 0.5"/>', RED, "0 0 1")
    with_box = urdf(plate, above, joint("j", "base", "other"))
    camera = camera_for(View(0.0, 50.0), (240, 180), make_scene(with_box))
    unshaded, shaded = (
        render(make_scene(text), camera=camera)[:, :, :3].astype(int).sum(axis=2) for text in (urdf(plate), with_box)
    )
    x, y, _ = camera.project(
        np.stack(np.meshgrid(np.linspace(-1.4, 1.4, 57), np.linspace(-1.4, 1.4, 57), [0.05]), -1).reshape(-1, 3)
    )
    darker = [(unshaded - shaded)[int(row), int(column)] for row, column in zip(y, x, strict=True)]
    assert sum(40 < difference < 250 for difference in darker) > 20


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_points_at_inverts_projection(view: View) -> None:
    points = np.random.default_rng(4).uniform(-1, 1, (20, 3))
    camera = camera_for(view, (160, 120), make_scene(ONE))
    x, y, _ = camera.project(points)
    depth = points @ camera.toward - camera.center[2]
    np.testing.assert_allclose(camera.points_at(x, y, depth), points, atol=1e-9)
