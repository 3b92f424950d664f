"""Determine the output layout of YOLO networks from shapes and metadata.

Three layouts exist. Networks since v8, and YOLOv5 as exported by Ultralytics' newer program (``yolov5u``), have a
column for each place of the image: centre, size and a score for each class. The classic YOLOv5 has a row for each place
with one more number, the probability that there is an object at all. Networks that were exported with ``nms=True``, and
YOLO26 with ``end2end``, output up to 300 final rows: corners, score, class. Segmentation adds mask coefficients after
the scores, and pose estimation adds keypoints.

Other networks have similar shapes with a different meaning: YOLOX has one row for each place, not decoded, and RT-DETR
has 300 rows of fractions of the image. Only three rows per place are supported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.vision.detectors.metadata import Metadata

_HEADS = ((8, 16, 32), (8, 16, 32, 64), (8, 16, 32, 64, 128), (4, 8, 16, 32), (8, 16), (16, 32))
"""The strides of the networks' grids."""
_SHAPES = 3
"""Boxes that the classic YOLOv5 has for each place of a grid."""
_BOXES = {"": "", "detect": "", "segment": "masks", "pose": "key points"}
"""Tasks whose networks find upright boxes -> their further outputs, which are ignored."""
_CORNERS_OF_CENTRES = np.array([[1, 0, -0.5, 0], [0, 1, 0, -0.5], [1, 0, 0.5, 0], [0, 1, 0, 0.5]], np.float32)


class Form(Enum):
    """The arrangement of a box's numbers in the output."""

    COLUMNS = "xywh and scores in columns"
    ROWS = "xywh, objectness and scores in rows"
    FINAL = "corners, score and class in rows"


@dataclass(frozen=True, slots=True)
class Candidates:
    """Unfiltered boxes of a network, in pixels of its input.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom.
        scores: shape ``(n,)``.
        classes: shape ``(n,)``.
    """

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class Layout:
    """The layout of a network's first output.

    Attributes:
        form: the arrangement of the numbers.
        classes: the number of classes; 0 if the outputs do not determine it, as with final boxes.
        left_out: the kind of additional outputs for each box, which are ignored: ``masks``, ``key points`` or empty.
    """

    form: Form
    classes: int
    left_out: str = ""

    def candidates(self, output: NDArray[np.float32], threshold: float) -> Candidates:
        """Return the boxes with a minimum score; unless the layout is final, an object has several boxes.

        Args:
            output: shape ``(1, a, b)``.
            threshold: the minimum score.
        """
        numbers = output[0]
        if self.form is Form.FINAL:
            rows = numbers[numbers[:, 4] >= threshold]
            return Candidates(rows[:, :4].copy(), rows[:, 4].copy(), rows[:, 5].astype(np.int32))
        if self.form is Form.COLUMNS:
            scores = numbers[4 : 4 + self.classes]
            best = scores.max(axis=0)
            places = np.flatnonzero(best >= threshold)
            found, best = scores[:, places].argmax(axis=0), best[places]
            centres = numbers[:4, places]
        else:
            rows = numbers[numbers[:, 4] >= threshold]
            products = rows[:, 5 : 5 + self.classes] * rows[:, 4:5]
            found, best = products.argmax(axis=1), products.max(axis=1)
            certain = best >= threshold
            found, best = found[certain], best[certain]
            centres = rows[certain, :4].T
        corners = (_CORNERS_OF_CENTRES @ centres).T
        return Candidates(np.ascontiguousarray(corners), best, found.astype(np.int32))


def find_layout(
    shapes: Sequence[Sequence[int]],
    size: tuple[int, int],
    metadata: Metadata,
    file: Path,
    labels: int | None,
    labels_file: Path | None = None,
) -> Layout:
    """Return the layout of a network's outputs.

    Args:
        shapes: the shapes of its outputs, for one image.
        size: height and width of that image.
        metadata: the metadata of its file.
        file: the network's file, for messages.
        labels: the number of names in the label file, if there is one; takes precedence over the metadata.
        labels_file: the label file, for messages.

    Raises:
        LinkwrightError: VISION106 the network does not output boxes, or its layout is unknown; VISION107 the numbers of
            classes and names differ.
    """
    if metadata.task not in _BOXES:
        message = phrase(
            "the network in '{file}' is for '{task}', so it outputs no boxes", file=file.name, task=metadata.task
        )
        raise LinkwrightError(Diagnostic("VISION106", message, hint=phrase("use a network for 'detect'")))
    more, task = _more_numbers(shapes, metadata)
    named = labels if labels is not None or metadata.names is None else len(metadata.names)
    first = shapes[0] if shapes else ()
    forms = _possible(first, size, more, suppressed=metadata.suppressed) if len(first) == 3 else []
    if not forms:
        shown = " ".join(str(list(shape)) for shape in shapes)
        message = phrase(
            "the outputs of '{file}' are not boxes in a YOLO format: {shapes}", file=file.name, shapes=shown
        )
        hint = phrase(
            "supported are [1, 4 + classes, N], [1, N, 5 + classes] with three rows for each place, and [1, N, "
            "6]; YOLOX, YOLOv6 and RT-DETR have other boxes"
        )
        raise LinkwrightError(Diagnostic("VISION106", message, hint=hint))
    form, classes = next((form for form in forms if form[1] in (0, named)), forms[0])
    if named is not None and classes not in (0, named):
        raise wrong_number(file, classes, named, labels_file)
    return Layout(form, classes, _BOXES[task])


def wrong_number(file: Path, classes: int, named: int, labels: Path | None) -> LinkwrightError:
    """Return the error VISION107: the numbers of names and of the network's classes differ.

    Args:
        file: the file of the network.
        classes: the number of its classes.
        named: the number of names.
        labels: the file with the names; None if they are in the file of the network.
    """
    if labels is None:
        message = phrase(
            "the network in '{file}' has {classes} classes, but its metadata name {named}",
            file=file.name,
            classes=classes,
            named=named,
        )
        return LinkwrightError(Diagnostic("VISION107", message, hint=phrase("give a labels file with as many names")))
    message = phrase(
        "the network in '{file}' has {classes} classes, but '{labels}' names {named}",
        file=file.name,
        classes=classes,
        labels=labels,
        named=named,
    )
    return LinkwrightError(Diagnostic("VISION107", message, hint=phrase("give the labels that it was trained with")))


def _more_numbers(shapes: Sequence[Sequence[int]], metadata: Metadata) -> tuple[int, str]:
    """Return the number of values after a box's scores, and the task that they belong to."""
    if metadata.task == "pose":
        return metadata.key_numbers, "pose"
    masks = next((shape[1] for shape in shapes[1:] if len(shape) == 4), 0)
    if metadata.task in ("", "segment") and masks:
        return masks, "segment"
    return 0, metadata.task


def _possible(shape: Sequence[int], size: tuple[int, int], more: int, *, suppressed: bool) -> list[tuple[Form, int]]:
    """Return the forms that an output's shape allows, likeliest first, with their numbers of classes."""
    batch, first, second = shape
    if batch != 1:
        return []
    places = {sum((size[0] // stride) * (size[1] // stride) for stride in strides) for strides in _HEADS}
    triples = {_SHAPES * place for place in places}
    if second == 6 + more and (suppressed or first not in places | triples):
        return [(Form.FINAL, 0)]
    as_columns, as_rows = (Form.COLUMNS, first - 4 - more), (Form.ROWS, second - 5 - more)
    found = [as_columns] if second in places or second > first else []
    if first in triples:
        found.insert(len(found) if second in places else 0, as_rows)
    return [layout for layout in found if layout[1] >= 1]
