"""Datasets in the YOLO folder layout, which `linkwright dataset` writes.

A YAML file in the folder names the classes and the image folders. Next to ``images`` is ``labels`` with a text file
for each image. Each line of that file describes an object: its class, and the center, width and height of its box as
fractions of the image. An image without a text file has no objects.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Span,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
    quoted_names,
)

IMAGE_SUFFIXES = frozenset({".bmp", ".jpeg", ".jpg", ".png", ".ppm", ".webp"})


@dataclass(frozen=True, slots=True)
class LabeledFile:
    """A labeled image.

    Attributes:
        path: the path of the image.
        classes: shape ``(n,)``, indices into the dataset's names.
        boxes: shape ``(n, 4)``: left, top, right, bottom, as fractions of the image's width and height.
        ignored: shape ``(n,)``, whether the object does not count, because the COCO file marks it with ``iscrowd``.
    """

    path: Path
    classes: NDArray[np.int32]
    boxes: NDArray[np.float32]
    ignored: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Dataset:
    """A dataset divided into splits for training and evaluation.

    Attributes:
        folder: the folder of the dataset.
        names: the names of the classes.
        splits: the image folders of each split: ``train``, ``val`` and ``test``, of which some may be missing.
    """

    folder: Path
    names: tuple[str, ...]
    splits: Mapping[str, tuple[Path, ...]]

    def read(self, split: str) -> list[LabeledFile]:
        """Return the images of a split with their labels, in the order of their paths.

        Raises:
            LinkwrightError: VISION303, the split does not exist or has no images; VISION304, a label is invalid.
        """
        if split not in self.splits:
            splits = quoted_names(sorted(self.splits), " and ")
            message = phrase(
                "the dataset '{folder}' has no split '{split}'", folder=display_path(self.folder), split=split
            )
            raise LinkwrightError(Diagnostic("VISION303", message, hint=phrase("use one of {names}", names=splits)))
        paths = [
            path
            for folder in self.splits[split]
            if folder.is_dir()
            for path in sorted(folder.rglob("*"))
            if path.suffix.lower() in IMAGE_SUFFIXES
        ]
        if not paths:
            folder_name = display_path(self.splits[split][0])
            message = phrase(
                "there are no images of the split '{split}' in '{folder}'", split=split, folder=folder_name
            )
            raise LinkwrightError(Diagnostic("VISION303", message))
        ignored_boxes = _read_ignored_boxes(self.folder / "annotations" / f"instances_{split}.json", self.names)
        return [_read_labeled(path, len(self.names), ignored_boxes.get(path.name, ())) for path in paths]


def open_dataset(folder: Path) -> Dataset:
    """Open a dataset in the YOLO layout.

    Args:
        folder: the folder, or its YAML file.

    Raises:
        LinkwrightError: VISION302, the folder is not a dataset.
    """
    file = folder if folder.suffix in {".yaml", ".yml"} else _find_description_file(folder)
    try:
        content = yaml.safe_load(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise _dataset_error(file, phrase("it does not exist"), missing_file_hint(file)) from None
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise _dataset_error(file, foreign(error)) from None
    if not isinstance(content, dict):
        raise _dataset_error(file, phrase("it is not a mapping of names to values"))
    names = _parse_class_names(file, content.get("names"))
    base = file.parent
    if isinstance(content.get("path"), str):
        base = next((candidate for candidate in (file.parent / content["path"],) if candidate.is_dir()), file.parent)
    splits = {
        split: tuple(
            base / folder_name
            for folder_name in ([content[split]] if isinstance(content[split], str) else content[split])
        )
        for split in ("train", "val", "test")
        if isinstance(content.get(split), str)
        or (isinstance(content.get(split), list) and all(isinstance(part, str) for part in content[split]))
    }
    if not splits:
        raise _dataset_error(file, phrase("neither 'train' nor 'val' names a folder of images"))
    return Dataset(file.parent, names, splits)


def _find_description_file(folder: Path) -> Path:
    """Return the path of a dataset's YAML file, preferably ``data.yaml`` or ``dataset.yaml``."""
    if not folder.is_dir():
        raise _dataset_error(folder, phrase("it does not exist"), missing_file_hint(folder))
    files = sorted(folder.glob("*.y*ml"))
    preferred = [file for file in files if file.stem in {"data", "dataset"}]
    if not files:
        hint = phrase("pass a folder that `linkwright dataset` created, or one with a data.yaml")
        raise _dataset_error(folder, phrase("it contains no YAML file"), hint)
    return (preferred or files)[0]


def _parse_class_names(file: Path, names: Any) -> tuple[str, ...]:
    if isinstance(names, dict) and sorted(names) == list(range(len(names))):
        names = [names[index] for index in range(len(names))]
    if isinstance(names, list) and names and all(isinstance(name, (str, int)) for name in names):
        return tuple(str(name) for name in names)
    raise _dataset_error(file, phrase("'names' must be a list of names, or a mapping from 0, 1, ... to names"))


def _dataset_error(path: Path, reason: Phrase | Any, hint: Phrase | None = None) -> LinkwrightError:
    message = phrase("'{path}' is not a dataset: {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION302", message, hint=hint))


def _read_ignored_boxes(file: Path, names: tuple[str, ...]) -> dict[str, list[list[float]]]:
    """Return the ignored boxes (``iscrowd``) of a split from its COCO file.

    YOLO label files cannot contain them.

    Returns:
        For each image file name, rows of class, left, top, right, bottom as fractions; empty if there is no COCO file.
    """
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        images = {entry["id"]: entry for entry in content["images"]}
        class_numbers = {entry["id"]: names.index(entry["name"]) for entry in content["categories"]}
        boxes: dict[str, list[list[float]]] = {}
        for entry in content["annotations"]:
            if entry["iscrowd"]:
                image = images[entry["image_id"]]
                left, top, width, height = entry["bbox"]
                image_width, image_height = image["width"], image["height"]
                box = [
                    left / image_width,
                    top / image_height,
                    (left + width) / image_width,
                    (top + height) / image_height,
                ]
                boxes.setdefault(image["file_name"], []).append([class_numbers[entry["category_id"]], *box])
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, KeyError, TypeError, ZeroDivisionError) as error:
        message = phrase("cannot read '{path}': {reason}", path=display_path(file), reason=foreign(error))
        raise LinkwrightError(Diagnostic("VISION304", message)) from None
    return boxes


def _read_labeled(path: Path, classes: int, hidden: Sequence[list[float]]) -> LabeledFile:
    """Read the labels of an image, and append its ignored boxes.

    Raises:
        LinkwrightError: VISION304, the label file has an invalid label.
    """
    label_file = find_label_path(path)
    try:
        lines = label_file.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        lines = []
    except (OSError, UnicodeDecodeError) as error:
        message = phrase("cannot read '{path}': {reason}", path=display_path(label_file), reason=foreign(error))
        raise LinkwrightError(Diagnostic("VISION304", message)) from None
    rows = [_parse_label(label_file, number, line, classes) for number, line in enumerate(lines, 1) if line.strip()]
    table: NDArray[np.float32] = np.array(rows, np.float32).reshape(-1, 5)
    half_sizes: NDArray[np.float32] = table[:, 3:5] * np.float32(0.5)
    boxes: NDArray[np.float32] = np.concatenate((table[:, 1:3] - half_sizes, table[:, 1:3] + half_sizes), 1)
    ignored_rows: NDArray[np.float32] = np.array(hidden, np.float32).reshape(-1, 5)
    class_indices: NDArray[np.int32] = np.concatenate((table[:, 0], ignored_rows[:, 0])).astype(np.int32)
    ignored: NDArray[np.bool_] = np.arange(len(class_indices)) >= len(table)
    return LabeledFile(path, class_indices, np.concatenate((boxes, ignored_rows[:, 1:])), ignored)


def find_label_path(image: Path) -> Path:
    """Return the path of an image's label file.

    The last folder ``images`` of the path becomes ``labels``, and the suffix becomes ``.txt``.
    """
    parts = list(image.parts)
    for index in range(len(parts) - 2, -1, -1):
        if parts[index] == "images":
            parts[index] = "labels"
            break
    return Path(*parts).with_suffix(".txt")


def _parse_label(text: Path, line_number: int, line: str, classes: int) -> list[float]:
    fields = line.split()
    try:
        row = [float(field) for field in fields]
    except ValueError:
        row = []
    problem: Phrase | None = None
    if len(row) != 5:
        problem = phrase("a label must have five numbers: class, x, y, width, height")
    elif row[0] not in range(classes):
        problem = phrase("the class {number} is not one of the {count} in 'names'", number=fields[0], count=classes)
    elif not all(0 <= value <= 1 for value in row[1:]):
        problem = phrase("x, y, width and height must be fractions of the image, between 0 and 1")
    if problem is None:
        return row
    span = Span(display_path(text), line_number, 1, line_number, len(line) + 1)
    message = phrase("'{line}' is not a label: {reason}", line=line.strip()[:60], reason=problem)
    raise LinkwrightError(Diagnostic("VISION304", message, span))
