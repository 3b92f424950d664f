"""Options of a dataset."""

from __future__ import annotations

from dataclasses import dataclass

SPLITS = ("train", "val", "test")
FORMATS = ("coco", "yolo")
"""The formats in which labels are written."""


@dataclass(frozen=True, slots=True)
class Options:
    """Options of making images.

    Attributes:
        width, height: the size of images, in pixels.
        seed: the random seed; the same seed gives the same bytes.
        splits: the shares of train, val and test.
        copies: the least number of objects of each class.
        distractors: the number of objects without a label.
        most: the largest number of objects placed in an image.
        kept: which of ``lights``, ``colours`` (with patterns) and ``lens`` (with sensor) stay as the world has them.
        least_size: the shorter side of a box in pixels, below which an object is ignored; half of it for its largest
            shape.
        least_visible: the share of an object that is visible, and that of its largest shape, below which it is to be
            ignored.
        form: the image format, ``jpg`` or ``png``.
    """

    width: int = 640
    height: int = 480
    seed: int = 0
    splits: tuple[float, float, float] = (0.8, 0.1, 0.1)
    copies: int = 3
    distractors: int = 6
    most: int = 8
    kept: tuple[str, ...] = ()
    least_size: int = 12
    least_visible: float = 0.5
    form: str = "jpg"
