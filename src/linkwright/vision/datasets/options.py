"""The options of a dataset."""

from __future__ import annotations

from dataclasses import dataclass

SPLITS = ("train", "val", "test")
FORMATS = ("coco", "yolo")
"""The formats of the labels."""


@dataclass(frozen=True, slots=True)
class Options:
    """The settings of the images of a dataset.

    Attributes:
        width, height: the size of images, in pixels.
        seed: the random seed; the same seed gives the same bytes.
        splits: the fractions of train, val and test.
        copies: the minimum number of objects of each class.
        distractors: the number of objects without a label in each world.
        max_objects: the maximum number of objects placed in an image.
        fixed_properties: what is not randomized: any of ``lights``, ``colors`` (with patterns) and ``lens`` (with
            sensor).
        min_size: the minimum length in pixels of a box's shorter side; smaller objects are ignored. For an object's
        largest geom, half of this length is enough.
        min_visible: the minimum visible fraction of an object and of its largest geom; a less visible object is
            ignored.
        image_format: the image format, ``jpg`` or ``png``.
    """

    width: int = 640
    height: int = 480
    seed: int = 0
    splits: tuple[float, float, float] = (0.8, 0.1, 0.1)
    copies: int = 3
    distractors: int = 6
    max_objects: int = 8
    fixed_properties: tuple[str, ...] = ()
    min_size: int = 12
    min_visible: float = 0.5
    image_format: str = "jpg"
