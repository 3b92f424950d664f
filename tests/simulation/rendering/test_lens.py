"""Images of lenses are pinhole images, sampled at the positions that the optics give."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.sdf.cameras import Camera, Distortion, ImageFormat
from linkwright.sdf.optics import make_optics
from linkwright.simulation.rendering.lens import Lens

BARREL = Distortion(-0.25, 0.12, -0.01, 0.001, -0.002)
PINCUSHION = Distortion(0.1, 0.1, 0.1, 0.1, 0.1)


@pytest.fixture(params=[BARREL, PINCUSHION], ids=["barrel", "pincushion"])
def optics(request: pytest.FixtureRequest):
    """A camera with more pixels than are interpolated at a time."""
    return make_optics(Camera(horizontal_fov=pi / 2, image=ImageFormat(240, 180), distortion=request.param))


def ramps(height: int, width: int):
    """Return an image whose red rises with the column, whose green falls with the row, and whose blue is full."""
    columns, rows = np.meshgrid(np.linspace(0, 255, width), np.linspace(255, 0, height))
    return np.round(np.stack([columns, rows, np.full_like(rows, 255)], axis=-1)).astype(np.uint8)


def test_colors_are_those_between_the_pixels(optics):
    pinhole = optics.pinhole
    colors = Lens(optics).resample_colors(ramps(pinhole.height, pinhole.width)).reshape(-1, 3)
    column = np.clip(optics.sources[0], 0, pinhole.width - 1) / (pinhole.width - 1)
    row = np.clip(optics.sources[1], 0, pinhole.height - 1) / (pinhole.height - 1)
    assert colors[:, 0] == pytest.approx(255 * column, abs=1.05)  # the ramp and the result are rounded
    assert colors[:, 1] == pytest.approx(255 * (1 - row), abs=1.05)
    assert (colors[:, 2] == 255).all()
    assert np.ptp(colors[:, 0].astype(int)) > 100


def test_a_black_and_a_white_image_stay_so(optics):
    lens, shape = Lens(optics), (optics.pinhole.height, optics.pinhole.width, 3)
    for shade in (0, 255):
        assert (lens.resample_colors(np.full(shape, shade, np.uint8)) == shade).all()


def test_numbers_are_those_of_the_nearest_pixel(optics):
    pinhole = optics.pinhole
    numbers = np.arange(pinhole.height * pinhole.width, dtype=np.int32).reshape(pinhole.height, pinhole.width)
    rows, columns = np.divmod(Lens(optics).resample_nearest(numbers), pinhole.width)
    assert rows.shape == (optics.height, optics.width)
    assert columns.ravel() == pytest.approx(np.clip(optics.sources[0], 0, pinhole.width - 1), abs=0.5)
    assert rows.ravel() == pytest.approx(np.clip(optics.sources[1], 0, pinhole.height - 1), abs=0.5)
