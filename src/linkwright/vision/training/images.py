"""Training samples of one size, with random augmentation."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.vision.detectors.letterbox import GRAY, letterbox_image
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.training.options import CropSettings
from linkwright.vision.training.yolo_dataset import LabeledFile

_MIN_SIDE_PIXELS = 3.0  # an object narrower than this after augmentation is ignored
_MIN_VISIBLE_FRACTION = 0.3  # an object with a smaller share of its box left in the image is ignored


@dataclass(frozen=True, slots=True)
class LabeledImages:
    """Images of one size, with the labels of each.

    Attributes:
        images: shape ``(n, height, width, 3)``, RGB.
        objects: for each image an array of shape ``(m, 5)``: class, left, top, right and bottom in pixels. An ignored
            object has class -2 instead of 0, -3 instead of 1, and so on.
    """

    images: NDArray[np.uint8]
    objects: tuple[NDArray[np.float32], ...]


def read_image(labeled: LabeledFile) -> NDArray[np.uint8]:
    """Return the pixels of a labeled image: shape ``(height, width, 3)``, RGB.

    Raises:
        LinkwrightError: VISION305, the file is not an image.
    """
    cv2 = load_opencv()
    data: NDArray[np.uint8] = np.fromfile(labeled.path, np.uint8)
    pixels: Any = cv2.imdecode(data, cv2.IMREAD_COLOR) if data.size else None
    if pixels is None:
        message = phrase("'{path}' is damaged or is not an image", path=display_path(labeled.path))
        raise LinkwrightError(Diagnostic("VISION305", message))
    rgb: NDArray[np.uint8] = np.ascontiguousarray(pixels[..., ::-1])
    return rgb


def read_labeled_images(labeled: Sequence[LabeledFile], width: int, height: int) -> LabeledImages:
    """Read images into memory, letterboxed to one size with gray borders, as detectors do.

    Raises:
        LinkwrightError: VISION305, one of the files is not an image.
    """
    images: NDArray[np.uint8] = np.zeros((len(labeled), height, width, 3), np.uint8)
    objects: list[NDArray[np.float32]] = [np.zeros((0, 5), np.float32)] * len(labeled)

    def read(index: int) -> None:
        pixels = read_image(labeled[index])
        images[index], letterbox = letterbox_image(pixels, (height, width), None)
        scaled_size = np.array((letterbox.width, letterbox.height) * 2, np.float32) * np.array(
            letterbox.scale * 2, np.float32
        )
        boxes: NDArray[np.float32] = labeled[index].boxes * scaled_size
        boxes += np.array((letterbox.left, letterbox.top) * 2, np.float32)
        signed_classes = np.where(labeled[index].ignored, -2 - labeled[index].classes, labeled[index].classes)
        objects[index] = np.concatenate((signed_classes[:, None].astype(np.float32), boxes), 1)

    with ThreadPoolExecutor(2) as pool:
        for future in [pool.submit(read, index) for index in range(len(labeled))]:
            future.result()
    return LabeledImages(images, tuple(objects))


def compute_repeat_factors(labeled_images: LabeledImages, classes: int) -> NDArray[np.float64]:
    """Return how often an epoch uses each image: once, or more often if it shows a rare class.

    A class is rare if the fraction f of images that show it is below the median m of these fractions. Its images are
    used sqrt(m / f) times, as with the repeat factors of LVIS (Gupta and others 2019).

    Returns:
        Shape ``(n,)``, 1 or more.
    """
    has_class: NDArray[np.bool_] = np.zeros((len(labeled_images.objects), classes), np.bool_)
    for row, objects in zip(has_class, labeled_images.objects, strict=True):
        row[objects[objects[:, 0] >= 0, 0].astype(np.int64)] = True
    image_counts = has_class.sum(0)
    median_count = float(np.median(image_counts[image_counts > 0])) if image_counts.any() else 1.0
    factors = np.maximum(1.0, np.sqrt(median_count / np.maximum(image_counts, 1)))
    repeat_counts: NDArray[np.float64] = np.where(has_class, factors, 1.0).max(1, initial=1.0)
    return repeat_counts


def draw_repeated_indices(factors: NDArray[np.float64], generator: np.random.Generator) -> NDArray[np.int64]:
    """Return image indices, each repeated by its factor, where fractions are rounded randomly."""
    counts: NDArray[np.int64] = np.floor(factors + generator.random(len(factors))).astype(np.int64)
    return np.repeat(np.arange(len(factors)), counts)


def augment(
    labeled_images: LabeledImages, index: int, crop: CropSettings, generator: np.random.Generator
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return a randomly augmented part of an image, with its objects.

    The part is mirrored and scaled at random; light, contrast, colors and sharpness change, and noise is added.

    Args:
        labeled_images: the images.
        index: the index of the image in `labeled_images`.
        crop: the size of the part in pixels, and the range of scales.
        generator: the random generator.

    Returns:
        The part, shape ``(height, width, 3)``, and its objects as in `LabeledImages`.
    """
    cv2 = load_opencv()
    image, objects = labeled_images.images[index], labeled_images.objects[index]
    height, width = image.shape[:2]
    size = crop.size
    min_log_scale, max_log_scale = np.log(crop.scales)
    scale = float(np.exp(generator.uniform(min_log_scale, max_log_scale)))
    x_sign = -1.0 if generator.random() < 0.5 else 1.0
    aspect = float(np.exp(generator.uniform(-0.1, 0.1)))
    scale_x, scale_y = scale * aspect, scale / aspect
    center = generator.uniform(0, 1, 2) * (width, height)
    labeled_objects = objects[objects[:, 0] >= 0]
    if len(labeled_objects) and generator.random() < 0.7:  # center the crop near an object
        chosen_object = labeled_objects[int(generator.integers(len(labeled_objects)))]
        center = (chosen_object[1:3] + chosen_object[3:5]) / 2 + generator.uniform(-0.4, 0.4, 2) * size / np.array(
            (scale_x, scale_y)
        )
    # Keep the crop within the image; an image smaller than the crop is padded with gray.
    max_corner = np.array((width, height)) - np.array(size) / (scale_x, scale_y)
    corner = np.clip(
        center - np.array(size) / (scale_x, scale_y) / 2, np.minimum(max_corner, 0), np.maximum(max_corner, 0)
    )
    left, top = corner
    shift = -left * scale_x if x_sign > 0 else size[0] + left * scale_x
    transform: NDArray[np.float32] = np.array([[scale_x * x_sign, 0, shift], [0, scale_y, -top * scale_y]], np.float32)
    transformed = cv2.warpAffine(image, transform, size, flags=cv2.INTER_LINEAR, borderValue=(GRAY, GRAY, GRAY))
    return _augment_pixels(transformed, generator), _transform_objects(objects, transform, *size)


def _augment_pixels(image: NDArray[np.uint8], generator: np.random.Generator) -> NDArray[np.uint8]:
    cv2 = load_opencv()
    gain = float(np.exp(generator.uniform(-0.5, 0.35)))
    tint: NDArray[np.float32] = np.exp(generator.normal(0, 0.08, 3)).astype(np.float32) * np.float32(gain)
    brightness = float(generator.uniform(-20, 20))
    steps: NDArray[np.float32] = np.arange(256, dtype=np.float32)[:, None]
    curve = (steps / 255) ** float(np.exp(generator.uniform(-0.25, 0.25)))
    lookup_table: NDArray[np.uint8] = np.clip(curve * 255 * tint + brightness, 0, 255).astype(np.uint8)
    pixels: Any = cv2.LUT(image, lookup_table[None])
    if generator.random() < 0.3:
        hsv: Any = cv2.cvtColor(pixels, cv2.COLOR_RGB2HSV)
        hsv[..., 0] = (hsv[..., 0].astype(np.int16) + int(generator.integers(-12, 13))) % 180
        pixels = cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB)
    if generator.random() < 0.15:
        pixels = cv2.GaussianBlur(pixels, (3, 3), 0)
    if generator.random() < 0.25:
        noise = generator.normal(0, generator.uniform(2, 10), pixels.shape[:2])[..., None]
        pixels = np.clip(pixels + noise, 0, 255).astype(np.uint8)
    result: NDArray[np.uint8] = pixels
    return result


def _transform_objects(
    objects: NDArray[np.float32], transform: NDArray[np.float32], width: int, height: int
) -> NDArray[np.float32]:
    """Transform objects with an image, and mark those that are mostly outside as ignored."""
    x = objects[:, 1::2] * transform[0, 0] + transform[0, 2]
    y = objects[:, 2::2] * transform[1, 1] + transform[1, 2]
    full_boxes = np.stack((x.min(1), y.min(1), x.max(1), y.max(1)), 1) if len(objects) else np.zeros((0, 4), np.float32)
    visible_boxes = full_boxes.copy()
    visible_boxes[:, 0::2] = np.clip(visible_boxes[:, 0::2], 0, width)
    visible_boxes[:, 1::2] = np.clip(visible_boxes[:, 1::2], 0, height)
    visible_sizes, full_sizes = visible_boxes[:, 2:] - visible_boxes[:, :2], full_boxes[:, 2:] - full_boxes[:, :2]
    is_labeled = (visible_sizes.min(1, initial=np.inf) >= _MIN_SIDE_PIXELS) & (
        visible_sizes.prod(1) >= _MIN_VISIBLE_FRACTION * np.maximum(full_sizes.prod(1), 1e-6)
    )
    signed_classes = np.where(is_labeled | (objects[:, 0] < 0), objects[:, 0], -2 - objects[:, 0])
    result: NDArray[np.float32] = np.concatenate((signed_classes[:, None], visible_boxes), 1)[
        visible_sizes.min(1, initial=np.inf) > 0
    ]
    return result.astype(np.float32)
