"""The positions of objects in boxes."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.vision.places.camera import make_camera_model
from linkwright.vision.places.positions import position_from_depth, position_on_ground

CAMERA = make_camera_model(640, 480, [500.0, 0.0, 319.5, 0.0, 500.0, 239.5, 0.0, 0.0, 1.0])
SMALL_CAMERA = make_camera_model(320, 240, [250.0, 0.0, 159.5, 0.0, 250.0, 119.5, 0.0, 0.0, 1.0])
UP_DIRECTION = np.array([0.0, -1.0, 0.0])


def ball_depth_image(center, radius, background_depth=4.0, camera=CAMERA):
    """Return the depth image of a ball in front of a wall, and its box."""
    size = camera.width, camera.height
    columns, rows = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    rays = camera.rays_from_pixels(np.stack([columns.ravel(), rows.ravel()], axis=1))
    center_point = np.asarray(center, np.float64)
    a, b, c = (rays**2).sum(axis=1), rays @ center_point, center_point @ center_point - radius**2
    root = b**2 - a * c
    depths = np.where(root > 0, (b - np.sqrt(np.maximum(root, 0))) / a, background_depth).reshape(size[1], size[0])
    hit = (root > 0).reshape(depths.shape)
    hit_rows, hit_columns = np.flatnonzero(hit.any(axis=1)), np.flatnonzero(hit.any(axis=0))
    scale = 640 / size[0]
    return depths, np.array([hit_columns[0], hit_rows[0], hit_columns[-1] + 1, hit_rows[-1] + 1]) * scale


@pytest.mark.parametrize("center", [(0.0, 0.0, 1.5), (0.5, 0.2, 2.0), (-0.9, -0.3, 3.0)])
def test_position_of_ball_before_wall_is_found(center):
    depths, box = ball_depth_image(center, 0.15)
    place = position_from_depth(box, depths, CAMERA)
    assert place.center == pytest.approx(center, abs=0.04)
    assert (place.width, place.height, place.depth) == pytest.approx((0.3, 0.3, 0.3), abs=0.04)


def test_depth_image_may_have_other_size():
    depths, box = ball_depth_image((0.3, 0.1, 2.0), 0.2, camera=SMALL_CAMERA)
    place = position_from_depth(box, depths, CAMERA)
    assert place.center == pytest.approx((0.3, 0.1, 2.0), abs=0.05)


def test_invalid_depths_are_ignored():
    depths, box = ball_depth_image((0.0, 0.0, 1.5), 0.15)
    holes = np.random.default_rng(1).random(depths.shape) < 0.5
    depths[holes] = np.random.default_rng(2).choice([np.nan, np.inf, 0.0], holes.sum())
    assert position_from_depth(box, depths, CAMERA).center == pytest.approx((0.0, 0.0, 1.5), abs=0.04)


def test_box_without_depths_has_no_position():
    depths, box = ball_depth_image((0.0, 0.0, 1.5), 0.15)
    assert position_from_depth(box, np.full_like(depths, np.nan), CAMERA) is None
    assert position_from_depth(box, depths, CAMERA, max_depth=1.0) is None
    assert position_from_depth(np.array([-50.0, -50.0, -10.0, -10.0]), depths, CAMERA) is None
    assert position_from_depth(np.array([630.0, 100.0, 690.0, 140.0]), depths, CAMERA) is None


def test_nearest_surface_determines_position():
    depths = np.full((480, 640), 5.0)
    depths[200:280, 310:330] = 1.0
    place = position_from_depth(np.array([290.0, 200.0, 350.0, 280.0]), depths, CAMERA)
    assert place.center[2] == pytest.approx(1.0, abs=0.01)
    assert place.depth < 0.01, "a flat object has no depth"


def test_few_near_depths_are_ignored_as_noise():
    depths = np.full((480, 640), 2.0)
    depths[200:280:7, 300:340:7] = 0.3
    assert position_from_depth(np.array([290.0, 190.0, 350.0, 290.0]), depths, CAMERA).center[2] == pytest.approx(
        2.0, 0.02
    )


def drum_box(x, z, radius, height, above):
    """Return the box of an upright drum on the ground, for a camera that looks along z."""
    turns = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([x + radius * np.cos(turns), np.zeros(200), z + radius * np.sin(turns)], axis=1)
    points = np.concatenate([circle + np.array([0, above, 0]), circle + np.array([0, above - height, 0])])
    pixels = CAMERA.pixels_from_points(points)
    return np.concatenate([pixels.min(axis=0), pixels.max(axis=0)])


@pytest.mark.parametrize(("x", "z"), [(0.0, 2.0), (0.8, 3.0), (-0.5, 1.6)])
def test_position_of_drum_on_ground_is_found(x, z):
    box = drum_box(x, z, 0.15, 0.6, 0.5)
    place = position_on_ground(box, CAMERA, UP_DIRECTION, 0.5)
    assert (place.center[0], place.center[2]) == pytest.approx((x, z), abs=0.06)
    assert place.width == pytest.approx(0.3, abs=0.05)
    assert place.center[1] == pytest.approx(0.2, abs=0.06), "the center is at half the height"


def test_position_of_ball_on_ground_is_found():
    _, box = ball_depth_image((0.4, 0.05, 2.0), 0.15)
    place = position_on_ground(box, CAMERA, UP_DIRECTION, 0.2)
    assert place.center == pytest.approx((0.4, 0.05, 2.0), abs=0.06)
    assert place.width == pytest.approx(0.3, abs=0.03)


def test_position_on_ground_with_tilted_camera():
    tilt = np.radians(20.0)
    up_direction = np.array([0.0, -np.cos(tilt), -np.sin(tilt)])
    place = position_on_ground(np.array([300.0, 200.0, 340.0, 240.0]), CAMERA, up_direction, 1.0)
    assert place.center[2] == pytest.approx(1.0 / np.sin(tilt), rel=0.05)


def test_object_without_visible_ground_contact_has_no_position():
    assert position_on_ground(np.array([300.0, 100.0, 340.0, 200.0]), CAMERA, UP_DIRECTION, 0.5) is None, (
        "above the horizon"
    )
    assert position_on_ground(np.array([300.0, 100.0, 340.0, 480.0]), CAMERA, UP_DIRECTION, 0.5) is None, (
        "cut by the edge"
    )
    assert (
        position_on_ground(np.array([300.0, 200.0, 340.0, 260.0]), CAMERA, UP_DIRECTION, 0.5, max_distance=3.0) is None
    )
