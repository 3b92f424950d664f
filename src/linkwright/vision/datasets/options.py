"""Options of a dataset."""

from __future__ import annotations

from dataclasses import dataclass

SPLITS = ("train", "val", "test")
FORMATS = ("coco", "yolo")
PICTURE_FORMATS = ("jpg", "png")
VARIED = ("lights", "colours", "lens")
"""What differs from picture to picture, unless it is kept: what lights things, colours and patterns,
and what a lens and a sensor do."""


@dataclass(frozen=True, slots=True)
class Options:
    """Options of making pictures.

    Attributes:
        width, height: of pictures, in pixels.
        seed: what chance follows from; the same seed gives the same bytes.
        splits: the shares of train, val and test.
        copies: how many things there are of each class at least.
        distractors: how many things without a label there are.
        most: how many things are put into a picture at most.
        kept: which of `VARIED` stay as the world has them.
        least_size: the shorter side of a box in pixels, below which a thing is to be ignored; half of it for what is
            seen of its largest shape.
        least_visible: the share of a thing that is visible, and that of its largest shape, below which it is to be
            ignored.
        form: of pictures, one of `PICTURE_FORMATS`.
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
