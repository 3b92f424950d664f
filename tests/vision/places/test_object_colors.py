"""Colors in words."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.vision.places.object_colors import COLORS, classify_colors, find_object_color

SAMPLES = {
    "red": [(200, 13, 15), (120, 10, 10), (230, 60, 50)],
    "orange": [(240, 130, 20), (255, 110, 0)],
    "yellow": [(242, 204, 26), (200, 190, 40)],
    "green": [(26, 140, 51), (40, 90, 40), (120, 220, 60)],
    "cyan": [(20, 200, 210)],
    "blue": [(26, 64, 178), (20, 40, 90), (60, 110, 220)],
    "purple": [(120, 40, 180)],
    "pink": [(250, 120, 180), (240, 160, 170)],
    "brown": [(120, 70, 30), (110, 75, 45)],
    "white": [(250, 250, 250), (200, 205, 200)],
    "grey": [(128, 128, 130)],
    "black": [(10, 10, 12), (40, 40, 40)],
}


@pytest.mark.parametrize("name", COLORS)
def test_colors_have_common_names(name):
    pixels = np.array(SAMPLES[name], np.uint8)
    assert [COLORS[named_color] for named_color in classify_colors(pixels)] == [name] * len(pixels)


def disc_image(color, ground=(180, 180, 180), shade=1.0):
    image = np.full((120, 160, 3), ground, np.uint8)
    rows, columns = np.mgrid[:120, :160]
    inside = (rows - 60) ** 2 + (columns - 80) ** 2 <= 30**2
    light = np.where(rows > 60, shade, 1.0)[inside][:, None]
    image[inside] = (np.array(color) * light).astype(np.uint8)
    return image, np.array([50.0, 30.0, 110.0, 90.0])


@pytest.mark.parametrize("shade", [1.0, 0.4])
def test_color_of_shaded_ball_on_gray_ground_is_found(shade):
    assert find_object_color(*disc_image((200, 20, 20), shade=shade)) == "red"
    assert find_object_color(*disc_image((30, 60, 180), shade=shade)) == "blue"


def test_white_ball_with_black_spots_is_white():
    image, box = disc_image((245, 245, 245))
    image[50:60, 70:80] = 5
    assert find_object_color(image, box) == "white"


def test_ambiguous_color_is_none():
    image, box = disc_image((200, 20, 20))
    assert find_object_color(image, box + 500) is None
    stripes = np.zeros((60, 60, 3), np.uint8)
    for row, color in enumerate([(200, 10, 10), (20, 150, 30), (20, 40, 190), (240, 200, 20)] * 15):
        stripes[row] = color
    assert find_object_color(stripes, np.array([0.0, 0.0, 60.0, 60.0])) is None
