"""The folder of a dataset: images, labels for COCO and YOLO, and the card.

The formats follow "Data format" of cocodataset.org, and the chapter "Object detection datasets" of Ultralytics.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.vision.datasets.options import SPLITS
from linkwright.vision.datasets.rendering import LabeledImage
from linkwright.vision.datasets.statistics import ClassStatistics, compute_statistics

CARD_FILE = "dataset.json"
SHEET_FILE = "contact_sheet.jpg"
_FORMAT_VERSION = 2
"""The version of the card's format."""
_FOLDERS = ("images", "labels", "annotations")
_FILES = (CARD_FILE, "data.yaml", SHEET_FILE)


class DatasetFolder:
    """A dataset on disk.

    The dataset is complete after `finish`, even after an interruption.

    Args:
        path: the folder.
        classes: the names of the classes.
        size: width and height of images in pixels.
        formats: the label formats, ``coco`` and ``yolo``.
        image_format: the image format, ``jpg`` or ``png``.

    Attributes:
        path: the folder.
        first_number: the number of the first image of this run.
        count: the number of images in all splits.
    """

    def __init__(
        self, path: Path, classes: Sequence[str], size: tuple[int, int], formats: Sequence[str], image_format: str
    ) -> None:
        self.path = path
        self.first_number = 0
        self._classes, self._size, self._formats, self._image_format = (
            tuple(classes),
            size,
            tuple(formats),
            image_format,
        )
        self._images: dict[str, list[dict[str, Any]]] = {split: [] for split in SPLITS}
        self._annotations: dict[str, list[dict[str, Any]]] = {split: [] for split in SPLITS}
        self._runs: list[Any] = []

    @property
    def count(self) -> int:
        """The number of images."""
        return sum(map(len, self._images.values()))

    def statistics(self) -> dict[str, ClassStatistics]:
        """Return the statistics of each class over all splits."""
        annotations = [annotation for split in SPLITS for annotation in self._annotations[split]]
        return compute_statistics(self._classes, self._size, annotations)

    def open(self, *, force: bool = False, append: bool = False) -> None:
        """Create the folder, or replace or continue the dataset in it.

        Args:
            force: replace the dataset in it.
            append: add to the dataset in it.

        Raises:
            LinkwrightError: VISION205, the folder is not empty; VISION206, the dataset to append to is missing, or has
                other classes, sizes or formats; VISION207, the folder cannot be created.
        """
        try:
            is_occupied = self.path.exists() and (not self.path.is_dir() or any(self.path.iterdir()))
            if is_occupied and append:
                self._read_existing()
            elif is_occupied and not (force and (self.path / CARD_FILE).is_file()):
                raise _occupied_folder_error(self.path, is_dataset=(self.path / CARD_FILE).is_file())
            elif is_occupied:
                self._remove_dataset()
            for subfolder in ("images", *(["labels"] if "yolo" in self._formats else [])):
                for split in SPLITS:
                    (self.path / subfolder / split).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise write_error(self.path, error) from None

    def add(self, sample: LabeledImage) -> None:
        """Write an image and its labels, either both or neither.

        Raises:
            OSError: the files cannot be written.
        """
        name = f"{sample.index:06d}"
        image = self.path / "images" / sample.split / f"{name}.{self._image_format}"
        text = self.path / "labels" / sample.split / f"{name}.txt"
        width, height = self._size
        try:
            image.write_bytes(sample.data)
            if "yolo" in self._formats:
                text.write_text(_format_yolo_labels(sample, width, height), encoding="utf-8")
        except BaseException:
            _remove_files([image, text])
            raise
        self._images[sample.split].append(
            {"id": sample.index, "file_name": image.name, "width": width, "height": height}
        )
        self._annotations[sample.split] += _make_coco_annotations(sample, width, height)

    def finish(self, card: Mapping[str, Any]) -> None:
        """Write the COCO annotations of all images, and the card.

        If the disk is full, the last images are dropped until the rest can be written.

        Args:
            card: how the images of this run were made.

        Raises:
            LinkwrightError: VISION207, the card cannot be written.
        """
        error = self._try_to_write(card)
        while error is not None and self.count:
            self._drop_last_images(-(-self.count // 4))
            error = self._try_to_write(card)
        if error is not None:
            self._remove_dataset()
            raise write_error(self.path, error)

    def _try_to_write(self, card: Mapping[str, Any]) -> OSError | None:
        try:
            self._write(card)
        except OSError as error:
            return error
        return None

    def _write(self, card: Mapping[str, Any]) -> None:
        current_run = {
            **card,
            "first": self.first_number,
            "images": self.count - sum(run["images"] for run in self._runs),
        }
        splits = {split: len(images) for split, images in self._images.items()}
        content = {
            "form": _FORMAT_VERSION,
            "classes": list(self._classes),
            "width": self._size[0],
            "height": self._size[1],
            "images": self.count,
            "splits": splits,
            "formats": list(self._formats),
            "made": [*self._runs, current_run],
            "statistics": {name: asdict(class_statistics) for name, class_statistics in self.statistics().items()},
        }
        if "coco" in self._formats:
            (self.path / "annotations").mkdir(exist_ok=True)
            for split in SPLITS:
                self._write_json(Path("annotations") / f"instances_{split}.json", self._make_coco_document(split, card))
        if "yolo" in self._formats:
            write_whole_file(self.path / "data.yaml", self._format_data_yaml(splits))
        self._write_json(Path(CARD_FILE), content)

    def _write_json(self, name: Path, content: Any) -> None:
        indent = 1 if name.name == CARD_FILE else None
        separators = None if indent else (",", ":")
        text = json.dumps(content, indent=indent, separators=separators, ensure_ascii=False)
        write_whole_file(self.path / name, text + "\n")

    def _make_coco_document(self, split: str, card: Mapping[str, Any]) -> dict[str, Any]:
        annotations = sorted(self._annotations[split], key=lambda entry: int(entry["image_id"]))
        return {
            "info": {"description": "made by linkwright dataset", "version": card["version"]},
            "licenses": [],
            "images": sorted(self._images[split], key=lambda entry: int(entry["id"])),
            "annotations": [{"id": number, **entry} for number, entry in enumerate(annotations, start=1)],
            "categories": [
                {"id": number, "name": name, "supercategory": "object"}
                for number, name in enumerate(self._classes, start=1)
            ],
        }

    def _format_data_yaml(self, splits: Mapping[str, int]) -> str:
        lines = ["# Made by linkwright dataset. Paths are relative to the folder of this file."]
        lines += [f"{split}: images/{split}" for split in SPLITS if splits[split]]
        lines += ["names:", *(f"  {index}: {json.dumps(name)}" for index, name in enumerate(self._classes))]
        return "\n".join(lines) + "\n"

    def _read_existing(self) -> None:
        """Load the card and the labels of an existing dataset."""
        folder = display_path(self.path)
        try:
            card = json.loads((self.path / CARD_FILE).read_text(encoding="utf-8"))
            lists = {
                split: json.loads((self.path / "annotations" / f"instances_{split}.json").read_text(encoding="utf-8"))
                for split in SPLITS
            }
        except (OSError, ValueError):
            message = phrase("'{folder}' has no dataset in COCO format to append to", folder=folder)
            raise LinkwrightError(Diagnostic("VISION206", message)) from None
        expected = (_FORMAT_VERSION, list(self._classes), *self._size, list(self._formats))
        if (
            card.get("form"),
            card.get("classes"),
            card.get("width"),
            card.get("height"),
            card.get("formats"),
        ) != expected:
            message = phrase("the dataset in '{folder}' differs in classes, image size or label formats", folder=folder)
            hint = phrase("its classes are {names}", names=", ".join(map(str, card.get("classes") or ())))
            raise LinkwrightError(Diagnostic("VISION206", message, hint=hint))
        for split, content in lists.items():
            self._images[split] = content["images"]
            self._annotations[split] = [
                {key: value for key, value in annotation.items() if key != "id"}
                for annotation in content["annotations"]
            ]
        self._runs = card["made"]
        numbers = [image["id"] for images in self._images.values() for image in images]
        self.first_number = max(numbers, default=-1) + 1

    def _drop_last_images(self, count: int) -> None:
        """Remove the last images and their labels."""
        last_ids = sorted(image["id"] for images in self._images.values() for image in images)[-count:]
        dropped_ids = set(last_ids)
        for split in SPLITS:
            files = [entry["file_name"] for entry in self._images[split] if entry["id"] in dropped_ids]
            for name in files:
                text = self.path / "labels" / split / f"{Path(name).stem}.txt"
                _remove_files([self.path / "images" / split / name, text])
            self._images[split] = [entry for entry in self._images[split] if entry["id"] not in dropped_ids]
            self._annotations[split] = [
                entry for entry in self._annotations[split] if entry["image_id"] not in dropped_ids
            ]

    def _remove_dataset(self) -> None:
        """Remove the files of the dataset, and keep all other files."""
        for subfolder in _FOLDERS:
            shutil.rmtree(self.path / subfolder, ignore_errors=True)
        _remove_files([self.path / name for name in _FILES])


def _format_yolo_labels(sample: LabeledImage, width: int, height: int) -> str:
    lines = []
    for label in sample.labels:
        if not label.is_ignored:
            left, top, right, bottom = label.box
            center = (left + right) / 2 / width, (top + bottom) / 2 / height
            size = (right - left) / width, (bottom - top) / height
            lines.append(" ".join([str(label.label), *(f"{value:.6f}" for value in (*center, *size))]) + "\n")
    return "".join(lines)


def _make_coco_annotations(sample: LabeledImage, width: int, height: int) -> list[dict[str, Any]]:
    annotations = []
    for label in sample.labels:
        left, top, right, bottom = label.box
        full_box = label.full_box
        annotations.append(
            {
                "image_id": sample.index,
                "category_id": label.label + 1,
                "bbox": [left, top, right - left, bottom - top],
                "area": label.area,
                "segmentation": {"size": [height, width], "counts": list(label.run_lengths)},
                "iscrowd": int(label.is_ignored),
                "visibility": round(label.visibility, 4),
                "truncated": label.is_truncated,
                "amodal_bbox": [full_box[0], full_box[1], full_box[2] - full_box[0], full_box[3] - full_box[1]],
            }
        )
    return annotations


def _remove_files(files: Sequence[Path]) -> None:
    for path in files:
        with suppress(OSError):
            path.unlink(missing_ok=True)


def _occupied_folder_error(path: Path, *, is_dataset: bool) -> LinkwrightError:
    folder = display_path(path)
    if is_dataset:
        message = phrase("'{folder}' already contains a dataset", folder=folder)
        hint = phrase("use --append to add to it, or --force to replace it")
    else:
        message = phrase("'{folder}' already exists and is not a dataset", folder=folder)
        hint = phrase("pass an empty or new folder")
    return LinkwrightError(Diagnostic("VISION205", message, hint=hint))


def write_error(path: Path, error: OSError) -> LinkwrightError:
    """Return the error for a file of a dataset that cannot be written (VISION207)."""
    reason = foreign(error.strerror or error)
    message = phrase("the dataset '{folder}' cannot be written: {reason}", folder=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION207", message))
