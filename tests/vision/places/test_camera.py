"""Projection from pixels into the world, and back."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.vision.places.camera import make_camera_model

K = [500.0, 0.0, 319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0]
P = [400.0, 0.0, 319.5, 0.0, 0.0, 400.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]


@pytest.mark.parametrize(
    "lens",
    [
        [],
        [-0.25, 0.08, 0.001, -0.002, -0.01],
        [0.3, -0.1, 0.0005, 0.0004, 0.02, 0.35, -0.05, 0.01],
    ],
)
def test_pixel_and_ray_conversion_round_trip(lens):
    camera = make_camera_model(
        640, 480, K, lens, distortion_model="rational_polynomial" if len(lens) > 5 else "plumb_bob"
    )
    pixels = np.array([[320.0, 240.0], [10.0, 20.0], [600.0, 30.0], [300.0, 470.0]])
    rays = camera.rays_from_pixels(pixels)
    assert rays[0] == pytest.approx([0, 0, 1], abs=1e-6)
    assert camera.pixels_from_points(rays * 3.0) == pytest.approx(pixels, abs=1e-3)


def test_projection_matrix_is_used_if_k_is_zero():
    camera = make_camera_model(640, 480, [0.0] * 9, [], P)
    assert camera.rays_from_pixels(np.array([[720.0, 240.0]])) == pytest.approx(np.array([[1.0, 0.0, 1.0]]))


def test_incomplete_camera_info_is_rejected():
    with pytest.raises(ValueError, match="no focal length"):
        make_camera_model(640, 480, [0.0] * 9)
    with pytest.raises(ValueError, match="0 x 480"):
        make_camera_model(0, 480, K)
    with pytest.raises(ValueError, match="equidistant"):
        make_camera_model(640, 480, K, [0.1, 0, 0, 0], distortion_model="equidistant")
