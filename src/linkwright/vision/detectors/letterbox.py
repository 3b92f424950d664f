"""Letterboxing: scale an image into the input of a network, with gray borders.

It works as in Ultralytics (`LetterBox`, `scale_boxes`): one scale for both directions, linear interpolation, the image
in the middle, and `GRAY` around it. If the network takes any size, the input is only as large as its stride requires.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detectors.library import load_opencv

GRAY = 114
"""The level of the border in all three channels, as in the training of networks."""


@dataclass(frozen=True, slots=True)
class Letterbox:
    """The position of an image in the input of a network.

    Attributes:
        width: the width of the image, in pixels.
        height: the height of the image, in pixels.
        scale: input pixels per image pixel, horizontally and vertically; they differ only by rounding.
        left: the left edge of the image in the input, in input pixels.
        top: the top edge of the image in the input, in input pixels.
    """

    width: int
    height: int
    scale: tuple[float, float]
    left: int
    top: int

    def to_image_boxes(self, boxes: NDArray[np.float32]) -> NDArray[np.float32]:
        """Convert boxes from input to image pixels, shape ``(n, 4)``, clipped to the image."""
        offset = np.array([self.left, self.top, self.left, self.top], np.float32)
        in_image = (boxes - offset) / np.array(self.scale * 2, np.float32)
        limits = np.array([self.width, self.height, self.width, self.height], np.float32)
        clipped: NDArray[np.float32] = np.clip(in_image, np.float32(0), limits)
        return clipped


def letterbox_image(
    image: NDArray[np.uint8], size: tuple[int, int], multiple: int | None
) -> tuple[NDArray[np.uint8], Letterbox]:
    """Scale an image into the input of a network.

    Args:
        image: shape ``(height, width, 3)``.
        size: height and width of the input.
        multiple: None for an input of exactly `size`; with a number, the borders are as small as possible, and each
            side differs from `size` by a multiple of it.

    Returns:
        The network's input, shape ``(rows, columns, 3)``, and the position of the image in it.
    """
    cv2 = load_opencv()
    height, width = image.shape[:2]
    scale = min(size[0] / height, size[1] / width)
    rows, columns = max(1, round(height * scale)), max(1, round(width * scale))
    vertical_border, horizontal_border = size[0] - rows, size[1] - columns
    if multiple is not None:
        vertical_border, horizontal_border = vertical_border % multiple, horizontal_border % multiple
    top, left = round(vertical_border / 2 - 0.1), round(horizontal_border / 2 - 0.1)
    scaled = image
    if (rows, columns) != (height, width):
        scaled = cv2.resize(image, (columns, rows), interpolation=cv2.INTER_LINEAR)
    canvas = np.full((rows + vertical_border, columns + horizontal_border, 3), GRAY, np.uint8)
    canvas[top : top + rows, left : left + columns] = scaled
    return canvas, Letterbox(width, height, (columns / width, rows / height), left, top)


def to_tensor(pixels: NDArray[np.uint8], kind: type[np.floating]) -> NDArray[np.floating]:
    """Convert ``(rows, columns, 3)`` pixels to floats from 0 to 1, ``(1, 3, rows, columns)``."""
    cv2 = load_opencv()
    planes = np.empty((1, 3, *pixels.shape[:2]), np.float32)
    for plane, channel in zip(planes[0], cv2.split(pixels), strict=True):
        np.divide(channel, np.float32(255.0), out=plane, dtype=np.float32)
    return planes.astype(kind, copy=False)
