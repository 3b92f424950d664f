"""The folder of a dataset: images, labels for COCO and YOLO, and the card.

Sources of the formats: "Data format" of cocodataset.org, and the chapter "Object detection datasets" of Ultralytics.
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
from linkwright.vision.datasets.making import LabelledImage
from linkwright.vision.datasets.options import SPLITS
from linkwright.vision.datasets.statistics import ClassStatistics, statistics_of

CARD = "dataset.json"
SHEET = "contact_sheet.jpg"
_FORM = 2
"""The number of this form of card."""
_PARTS = ("images", "labels", "annotations")
_FILES = (CARD, "data.yaml", SHEET)


class DatasetFolder:
    """A dataset on disk. It is complete after `finish`, even if it was interrupted.

    Args:
        path: the folder.
        classes: the names of the classes.
        size: width and height of images in pixels.
        formats: the label formats, ``coco`` and ``yolo``.
        form: the image format, ``jpg`` or ``png``.

    Attributes:
        path: the folder.
        first: the number of the first image to make.
        count: the number of images.
    """

    def __init__(
        self, path: Path, classes: Sequence[str], size: tuple[int, int], formats: Sequence[str], form: str
    ) -> None:
        self.path = path
        self.first = 0
        self._classes, self._size, self._formats, self._form = tuple(classes), size, tuple(formats), form
        self._images: dict[str, list[dict[str, Any]]] = {split: [] for split in SPLITS}
        self._annotations: dict[str, list[dict[str, Any]]] = {split: [] for split in SPLITS}
        self._runs: list[Any] = []

    @property
    def count(self) -> int:
        """The number of images."""
        return sum(map(len, self._images.values()))

    def statistics(self) -> dict[str, ClassStatistics]:
        """Return the statistics of the images, by class."""
        annotations = [annotation for split in SPLITS for annotation in self._annotations[split]]
        return statistics_of(self._classes, self._size, annotations)

    def open(self, *, force: bool = False, append: bool = False) -> None:
        """Create the folder, or continue an existing one.

        Args:
            force: remove the dataset that is in it.
            append: add to the dataset that is in it.

        Raises:
            LinkwrightError: VISION205 the folder is not empty; VISION206 the folder to append to has no dataset of
                these classes; VISION207 it cannot be made.
        """
        try:
            there = self.path.exists() and (not self.path.is_dir() or any(self.path.iterdir()))
            if there and append:
                self._read_existing()
            elif there and not (force and (self.path / CARD).is_file()):
                raise _occupied(self.path, is_dataset=(self.path / CARD).is_file())
            elif there:
                self._remove()
            for part in ("images", *(["labels"] if "yolo" in self._formats else [])):
                for split in SPLITS:
                    (self.path / part / split).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error) from None

    def add(self, taken: LabelledImage) -> None:
        """Write an image and its labels, either both or neither.

        Raises:
            OSError: they cannot be written.
        """
        name = f"{taken.index:06d}"
        image = self.path / "images" / taken.split / f"{name}.{self._form}"
        text = self.path / "labels" / taken.split / f"{name}.txt"
        width, height = self._size
        try:
            image.write_bytes(taken.data)
            if "yolo" in self._formats:
                text.write_text(_yolo(taken, width, height), encoding="utf-8")
        except BaseException:
            _remove([image, text])
            raise
        self._images[taken.split].append({"id": taken.index, "file_name": image.name, "width": width, "height": height})
        self._annotations[taken.split] += _coco(taken, width, height)

    def finish(self, card: Mapping[str, Any]) -> None:
        """Write the COCO annotations of all images and the card. If the disk is full, drop the last images.

        Args:
            card: the entry that describes how the images of this run were made.

        Raises:
            LinkwrightError: VISION207, the card cannot be written.
        """
        error = self._try_to_write(card)
        while error is not None and self.count:
            self._drop(-(-self.count // 4))
            error = self._try_to_write(card)
        if error is not None:
            self._remove()
            raise cannot_write(self.path, error)

    def _try_to_write(self, card: Mapping[str, Any]) -> OSError | None:
        try:
            self._write(card)
        except OSError as error:
            return error
        return None

    def _write(self, card: Mapping[str, Any]) -> None:
        made = {**card, "first": self.first, "images": self.count - sum(run["images"] for run in self._runs)}
        splits = {split: len(images) for split, images in self._images.items()}
        whole = {
            "form": _FORM,
            "classes": list(self._classes),
            "width": self._size[0],
            "height": self._size[1],
            "images": self.count,
            "splits": splits,
            "formats": list(self._formats),
            "made": [*self._runs, made],
            "statistics": {name: asdict(facts) for name, facts in self.statistics().items()},
        }
        if "coco" in self._formats:
            (self.path / "annotations").mkdir(exist_ok=True)
            for split in SPLITS:
                self._write_json(Path("annotations") / f"instances_{split}.json", self._coco(split, card))
        if "yolo" in self._formats:
            write_whole_file(self.path / "data.yaml", self._data_yaml(splits))
        self._write_json(Path(CARD), whole)

    def _write_json(self, name: Path, content: Any) -> None:
        indent = 1 if name.name == CARD else None
        separators = None if indent else (",", ":")
        text = json.dumps(content, indent=indent, separators=separators, ensure_ascii=False)
        write_whole_file(self.path / name, text + "\n")

    def _coco(self, split: str, card: Mapping[str, Any]) -> dict[str, Any]:
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

    def _data_yaml(self, splits: Mapping[str, int]) -> str:
        lines = ["# Made by linkwright dataset. Paths are relative to the folder of this file."]
        lines += [f"{split}: images/{split}" for split in SPLITS if splits[split]]
        lines += ["names:", *(f"  {number}: {json.dumps(name)}" for number, name in enumerate(self._classes))]
        return "\n".join(lines) + "\n"

    def _read_existing(self) -> None:
        """Load the card and the labels of an existing dataset."""
        shown = display_path(self.path)
        try:
            card = json.loads((self.path / CARD).read_text(encoding="utf-8"))
            lists = {
                split: json.loads((self.path / "annotations" / f"instances_{split}.json").read_text(encoding="utf-8"))
                for split in SPLITS
            }
        except (OSError, ValueError):
            message = phrase("'{folder}' has no dataset in COCO format to append to", folder=shown)
            raise LinkwrightError(Diagnostic("VISION206", message)) from None
        ours = (_FORM, list(self._classes), *self._size, list(self._formats))
        if (card.get("form"), card.get("classes"), card.get("width"), card.get("height"), card.get("formats")) != ours:
            message = phrase("the dataset in '{folder}' has different classes, sizes or formats", folder=shown)
            hint = phrase("its classes are {names}", names=", ".join(map(str, card.get("classes") or ())))
            raise LinkwrightError(Diagnostic("VISION206", message, hint=hint))
        for split, written in lists.items():
            self._images[split] = written["images"]
            self._annotations[split] = [
                {key: value for key, value in annotation.items() if key != "id"}
                for annotation in written["annotations"]
            ]
        self._runs = card["made"]
        numbers = [image["id"] for images in self._images.values() for image in images]
        self.first = max(numbers, default=-1) + 1

    def _drop(self, count: int) -> None:
        """Remove the last images."""
        newest = sorted(image["id"] for images in self._images.values() for image in images)[-count:]
        gone = set(newest)
        for split in SPLITS:
            files = [entry["file_name"] for entry in self._images[split] if entry["id"] in gone]
            for name in files:
                text = self.path / "labels" / split / f"{Path(name).stem}.txt"
                _remove([self.path / "images" / split / name, text])
            self._images[split] = [entry for entry in self._images[split] if entry["id"] not in gone]
            self._annotations[split] = [entry for entry in self._annotations[split] if entry["image_id"] not in gone]

    def _remove(self) -> None:
        """Remove the files of a dataset, and leave all other files."""
        for part in _PARTS:
            shutil.rmtree(self.path / part, ignore_errors=True)
        _remove([self.path / name for name in _FILES])


def _yolo(taken: LabelledImage, width: int, height: int) -> str:
    lines = []
    for label in taken.labels:
        if not label.ignored:
            left, top, right, bottom = label.box
            middle = (left + right) / 2 / width, (top + bottom) / 2 / height
            size = (right - left) / width, (bottom - top) / height
            lines.append(" ".join([str(label.label), *(f"{value:.6f}" for value in (*middle, *size))]) + "\n")
    return "".join(lines)


def _coco(taken: LabelledImage, width: int, height: int) -> list[dict[str, Any]]:
    found = []
    for label in taken.labels:
        left, top, right, bottom = label.box
        whole = label.whole
        found.append(
            {
                "image_id": taken.index,
                "category_id": label.label + 1,
                "bbox": [left, top, right - left, bottom - top],
                "area": label.area,
                "segmentation": {"size": [height, width], "counts": list(label.counts)},
                "iscrowd": int(label.ignored),
                "visibility": round(label.visibility, 4),
                "truncated": label.truncated,
                "amodal_bbox": [whole[0], whole[1], whole[2] - whole[0], whole[3] - whole[1]],
            }
        )
    return found


def _remove(files: Sequence[Path]) -> None:
    for path in files:
        with suppress(OSError):
            path.unlink(missing_ok=True)


def _occupied(path: Path, *, is_dataset: bool) -> LinkwrightError:
    shown = display_path(path)
    if is_dataset:
        message = phrase("'{folder}' already contains a dataset", folder=shown)
        hint = phrase("use --append to add to it, or --force to replace it")
    else:
        message = phrase("'{folder}' already exists and is not a dataset", folder=shown)
        hint = phrase("name an empty or new folder")
    return LinkwrightError(Diagnostic("VISION205", message, hint=hint))


def cannot_write(path: Path, error: OSError) -> LinkwrightError:
    """Return the error VISION207: a file of a dataset cannot be written."""
    reason = foreign(error.strerror or error)
    message = phrase("the dataset '{folder}' cannot be written: {reason}", folder=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION207", message))
