"""Prepare images as training samples: one size, with random augmentation."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.vision.detectors.letterbox import GREY, letterboxed
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.training.options import View
from linkwright.vision.training.reading import Labelled

_FEWEST_PIXELS = 3.0  # an object narrower than this after augmentation is ignored
_LEAST_SHARE = 0.3  # an object with a smaller share of its box left in the image is ignored


@dataclass(frozen=True, slots=True)
class Lesson:
    """Images of one size with their labels.

    Attributes:
        images: shape ``(n, height, width, 3)``, RGB.
        objects: for each image an array of shape ``(m, 5)``: class, left, top, right and bottom in pixels. An ignored
            object has class -2 instead of 0, -3 instead of 1, and so on.
    """

    images: NDArray[np.uint8]
    objects: tuple[NDArray[np.float32], ...]


def read_image(labelled: Labelled) -> NDArray[np.uint8]:
    """Return the pixels of a labelled image: shape ``(height, width, 3)``, RGB.

    Raises:
        LinkwrightError: VISION305, the file is not an image.
    """
    cv2 = load_opencv()
    data: NDArray[np.uint8] = np.fromfile(labelled.path, np.uint8)
    pixels: Any = cv2.imdecode(data, cv2.IMREAD_COLOR) if data.size else None
    if pixels is None:
        message = phrase("'{path}' is not an image, or is broken", path=display_path(labelled.path))
        raise LinkwrightError(Diagnostic("VISION305", message))
    read: NDArray[np.uint8] = np.ascontiguousarray(pixels[..., ::-1])
    return read


def read_lesson(labelled: Sequence[Labelled], width: int, height: int) -> Lesson:
    """Read images into memory, letterboxed to one size with grey borders, as detectors do.

    Raises:
        LinkwrightError: VISION305, one of the files is not an image.
    """
    images: NDArray[np.uint8] = np.zeros((len(labelled), height, width, 3), np.uint8)
    objects: list[NDArray[np.float32]] = [np.zeros((0, 5), np.float32)] * len(labelled)

    def read(number: int) -> None:
        pixels = read_image(labelled[number])
        images[number], place = letterboxed(pixels, (height, width), None)
        sides = np.array((place.width, place.height) * 2, np.float32) * np.array(place.scale * 2, np.float32)
        boxes: NDArray[np.float32] = labelled[number].boxes * sides
        boxes += np.array((place.left, place.top) * 2, np.float32)
        kinds = np.where(labelled[number].ignored, -2 - labelled[number].classes, labelled[number].classes)
        objects[number] = np.concatenate((kinds[:, None].astype(np.float32), boxes), 1)

    with ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(read, number) for number in range(len(labelled))]:
            done.result()
    return Lesson(images, tuple(objects))


def repeats(lesson: Lesson, classes: int) -> NDArray[np.float64]:
    """Return how often each image is used in an epoch: once, or more often if it shows a rare class.

    A class that is in a share f of the images counts as rare below the median m of these shares; its images are
    seen sqrt(m / f) times, as with the repeat factors of LVIS (Gupta and others 2019).

    Returns:
        Shape ``(n,)``, 1 or more.
    """
    there: NDArray[np.bool_] = np.zeros((len(lesson.objects), classes), np.bool_)
    for row, objects in zip(there, lesson.objects, strict=True):
        row[objects[objects[:, 0] >= 0, 0].astype(np.int64)] = True
    images = there.sum(0)
    usual = float(np.median(images[images > 0])) if images.any() else 1.0
    factors = np.maximum(1.0, np.sqrt(usual / np.maximum(images, 1)))
    found: NDArray[np.float64] = np.where(there, factors, 1.0).max(1, initial=1.0)
    return found


def repeated(times: NDArray[np.float64], chance: np.random.Generator) -> NDArray[np.int64]:
    """Return image indices, each repeated the given number of times; fractions are rounded randomly."""
    whole: NDArray[np.int64] = np.floor(times + chance.random(len(times))).astype(np.int64)
    return np.repeat(np.arange(len(times)), whole)


def changed(
    lesson: Lesson, place: int, view: View, chance: np.random.Generator
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return a sample with random augmentation: a random part, moved, with other light and colours.

    It is mirrored and scaled; brightness, contrast, colours and sharpness change, and noise is added.

    Args:
        lesson: the images.
        place: the index of the image in it.
        view: the size of the part, and the scale of images.
        chance: the random generator.

    Returns:
        The part, shape ``(height, width, 3)``, and the objects in it, see `Lesson`.
    """
    cv2 = load_opencv()
    image, objects = lesson.images[place], lesson.objects[place]
    height, width = image.shape[:2]
    size = view.size
    smallest, largest = np.log(view.scales)
    scale = float(np.exp(chance.uniform(smallest, largest)))
    mirror = -1.0 if chance.random() < 0.5 else 1.0
    aspect = float(np.exp(chance.uniform(-0.1, 0.1)))
    across, down = scale * aspect, scale / aspect
    middle = chance.uniform(0, 1, 2) * (width, height)
    asked = objects[objects[:, 0] >= 0]
    if len(asked) and chance.random() < 0.7:  # centre the crop near an object
        some = asked[int(chance.integers(len(asked)))]
        middle = (some[1:3] + some[3:5]) / 2 + chance.uniform(-0.4, 0.4, 2) * size / np.array((across, down))
    # Keep the crop within the image; an image smaller than the crop is padded with grey.
    room = np.array((width, height)) - np.array(size) / (across, down)
    corner = np.clip(middle - np.array(size) / (across, down) / 2, np.minimum(room, 0), np.maximum(room, 0))
    left, top = corner
    shift = -left * across if mirror > 0 else size[0] + left * across
    turn: NDArray[np.float32] = np.array([[across * mirror, 0, shift], [0, down, -top * down]], np.float32)
    moved = cv2.warpAffine(image, turn, size, flags=cv2.INTER_LINEAR, borderValue=(GREY, GREY, GREY))
    return _in_other_light(moved, chance), _moved(objects, turn, *size)


def _in_other_light(image: NDArray[np.uint8], chance: np.random.Generator) -> NDArray[np.uint8]:
    cv2 = load_opencv()
    gain = float(np.exp(chance.uniform(-0.5, 0.35)))
    tint: NDArray[np.float32] = np.exp(chance.normal(0, 0.08, 3)).astype(np.float32) * np.float32(gain)
    lift = float(chance.uniform(-20, 20))
    steps: NDArray[np.float32] = np.arange(256, dtype=np.float32)[:, None]
    bent = (steps / 255) ** float(np.exp(chance.uniform(-0.25, 0.25)))
    light: NDArray[np.uint8] = np.clip(bent * 255 * tint + lift, 0, 255).astype(np.uint8)
    pixels: Any = cv2.LUT(image, light[None])
    if chance.random() < 0.3:
        hue: Any = cv2.cvtColor(pixels, cv2.COLOR_RGB2HSV)
        hue[..., 0] = (hue[..., 0].astype(np.int16) + int(chance.integers(-12, 13))) % 180
        pixels = cv2.cvtColor(hue, cv2.COLOR_HSV2RGB)
    if chance.random() < 0.15:
        pixels = cv2.GaussianBlur(pixels, (3, 3), 0)
    if chance.random() < 0.25:
        noise = chance.normal(0, chance.uniform(2, 10), pixels.shape[:2])[..., None]
        pixels = np.clip(pixels + noise, 0, 255).astype(np.uint8)
    result: NDArray[np.uint8] = pixels
    return result


def _moved(objects: NDArray[np.float32], turn: NDArray[np.float32], width: int, height: int) -> NDArray[np.float32]:
    """Return the boxes in the transformed image, with those that are mostly outside marked as ignored."""
    x = objects[:, 1::2] * turn[0, 0] + turn[0, 2]
    y = objects[:, 2::2] * turn[1, 1] + turn[1, 2]
    whole = np.stack((x.min(1), y.min(1), x.max(1), y.max(1)), 1) if len(objects) else np.zeros((0, 4), np.float32)
    seen = whole.copy()
    seen[:, 0::2] = np.clip(seen[:, 0::2], 0, width)
    seen[:, 1::2] = np.clip(seen[:, 1::2], 0, height)
    sides, all_sides = seen[:, 2:] - seen[:, :2], whole[:, 2:] - whole[:, :2]
    asked = (sides.min(1, initial=np.inf) >= _FEWEST_PIXELS) & (
        sides.prod(1) >= _LEAST_SHARE * np.maximum(all_sides.prod(1), 1e-6)
    )
    kinds = np.where(asked | (objects[:, 0] < 0), objects[:, 0], -2 - objects[:, 0])
    result: NDArray[np.float32] = np.concatenate((kinds[:, None], seen), 1)[sides.min(1, initial=np.inf) > 0]
    return result.astype(np.float32)
