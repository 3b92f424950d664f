"""Statistics of a dataset by class: numbers, sizes, positions and visible fractions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import Any

_SIZE_LIMITS = (("small", 32), ("medium", 96), ("large", 1 << 30))
"""COCO's size ranges of objects, each with the square root of the range's maximum area in pixels."""
_MIN_VISIBLE = 0.75
"""The visible fraction below which an object counts as hidden."""


@dataclass
class ClassStatistics:
    """The statistics of a class.

    Attributes:
        objects: the number of labeled objects.
        images: the number of images with at least one labeled object.
        ignored: the number of objects that are too small or too hidden for a label.
        small, medium, large: the number of objects by COCO's size ranges.
        hidden: the number of objects that are less than three quarters visible.
        truncated: the number of objects that reach beyond their image.
        thirds: the number of objects whose center is in each cell of a 3 x 3 grid over the image, row by row.
    """

    objects: int = 0
    images: int = 0
    ignored: int = 0
    small: int = 0
    medium: int = 0
    large: int = 0
    hidden: int = 0
    truncated: int = 0
    thirds: list[int] = field(default_factory=lambda: [0] * 9)


def compute_statistics(
    classes: Sequence[str], image_size: tuple[int, int], annotations: Iterable[Mapping[str, Any]]
) -> dict[str, ClassStatistics]:
    """Return the statistics of each class.

    Args:
        classes: the names of the classes.
        image_size: width and height of images in pixels.
        annotations: the annotations of all images, in COCO's format.
    """
    statistics = {name: ClassStatistics() for name in classes}
    image_ids: dict[str, set[int]] = {name: set() for name in classes}
    for annotation in annotations:
        name = classes[annotation["category_id"] - 1]
        class_statistics = statistics[name]
        if annotation["iscrowd"]:
            class_statistics.ignored += 1
            continue
        image_ids[name].add(annotation["image_id"])
        class_statistics.objects += 1
        size_class = next(label for label, limit in _SIZE_LIMITS if sqrt(annotation["area"]) < limit)
        setattr(class_statistics, size_class, getattr(class_statistics, size_class) + 1)
        class_statistics.hidden += annotation["visibility"] < _MIN_VISIBLE
        class_statistics.truncated += bool(annotation["truncated"])
        left, top, width, height = annotation["bbox"]
        column = min(int(3 * (left + width / 2) / image_size[0]), 2)
        row = min(int(3 * (top + height / 2) / image_size[1]), 2)
        class_statistics.thirds[3 * row + column] += 1
    for name, class_image_ids in image_ids.items():
        statistics[name].images = len(class_image_ids)
    return statistics


def format_table(statistics: Mapping[str, ClassStatistics]) -> str:
    """Format statistics as a table with one line for each class."""
    titles = ("class", "objects", "images", "small", "medium", "large", "hidden", "truncated", "ignored")
    rows: list[tuple[str, ...]] = [titles]
    for name, class_statistics in statistics.items():
        rows.append((name, *(str(getattr(class_statistics, title)) for title in titles[1:])))
    widths = [max(len(row[column]) for row in rows) for column in range(len(titles))]
    lines = [
        "  ".join(
            [row[0].ljust(widths[0]), *(text.rjust(width) for text, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]
    return "\n".join(lines) + "\n"
