"""The output layout of YOLO networks, determined from shapes and metadata.

Three layouts exist. Networks since v8, and YOLOv5 as exported by Ultralytics' newer program (``yolov5u``), have one
column for each grid cell: center, size and a score for each class. The classic YOLOv5 has three rows for each grid cell
with one more number, the probability that there is an object at all. Networks that were exported with ``nms=True``, and
YOLO26 with ``end2end``, output up to 300 final rows: corners, score, class. Segmentation adds mask coefficients after
the scores, and pose estimation adds keypoints.

Other networks have similar shapes with a different meaning: YOLOX has one row for each grid cell, not decoded, and
RT-DETR has 300 rows of fractions of the image. They are not supported.
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

_STRIDE_SETS = ((8, 16, 32), (8, 16, 32, 64), (8, 16, 32, 64, 128), (4, 8, 16, 32), (8, 16), (16, 32))
"""The strides of a network's grids in pixels, for each supported combination of grids."""
_BOXES_PER_CELL = 3
"""The number of boxes that the classic YOLOv5 has for each grid cell."""
_IGNORED_OUTPUTS = {"": "", "detect": "", "segment": "masks", "pose": "keypoints"}
"""The additional outputs of each task that finds upright boxes. They are ignored."""
_CORNERS_OF_CENTERS = np.array([[1, 0, -0.5, 0], [0, 1, 0, -0.5], [1, 0, 0.5, 0], [0, 1, 0, 0.5]], np.float32)


class BoxArrangement(Enum):
    """The arrangement of a box's numbers in the output."""

    COLUMNS = "xywh and scores in columns"
    ROWS = "xywh, objectness and scores in rows"
    FINAL = "corners, score and class in rows"


@dataclass(frozen=True, slots=True)
class Candidates:
    """Boxes of a network before non-maximum suppression, in pixels of its input.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom.
        scores: shape ``(n,)``, 0 to 1.
        classes: shape ``(n,)``, class numbers.
    """

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class Layout:
    """The layout of a network's first output.

    Attributes:
        arrangement: the arrangement of the numbers.
        classes: the number of classes; 0 if the outputs do not determine it, as for final boxes.
        ignored_outputs: the kind of additional outputs for each box, which are ignored: ``masks``, ``keypoints`` or
            empty.
    """

    arrangement: BoxArrangement
    classes: int
    ignored_outputs: str = ""

    def find_candidates(self, output: NDArray[np.float32], threshold: float) -> Candidates:
        """Return the boxes with at least the minimum score.

        An object can have several boxes, except in the final layout.

        Args:
            output: the network's first output, shape ``(1, a, b)``.
            threshold: the minimum score.
        """
        values = output[0]
        if self.arrangement is BoxArrangement.FINAL:
            rows = values[values[:, 4] >= threshold]
            return Candidates(rows[:, :4].copy(), rows[:, 4].copy(), rows[:, 5].astype(np.int32))
        if self.arrangement is BoxArrangement.COLUMNS:
            scores = values[4 : 4 + self.classes]
            best_scores = scores.max(axis=0)
            columns = np.flatnonzero(best_scores >= threshold)
            class_numbers, best_scores = scores[:, columns].argmax(axis=0), best_scores[columns]
            centers = values[:4, columns]
        else:
            rows = values[values[:, 4] >= threshold]
            class_scores = rows[:, 5 : 5 + self.classes] * rows[:, 4:5]
            class_numbers, best_scores = class_scores.argmax(axis=1), class_scores.max(axis=1)
            is_certain = best_scores >= threshold
            class_numbers, best_scores = class_numbers[is_certain], best_scores[is_certain]
            centers = rows[is_certain, :4].T
        corners = (_CORNERS_OF_CENTERS @ centers).T
        return Candidates(np.ascontiguousarray(corners), best_scores, class_numbers.astype(np.int32))


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
        shapes: the shapes of the outputs for one image.
        size: the height and width of that image in pixels.
        metadata: the metadata of the network's file.
        file: the network's file, for messages.
        labels: the number of names in the label file, which override the names in the metadata; None if there is no
            label file.
        labels_file: the label file, for messages.

    Raises:
        LinkwrightError: VISION106 the network does not output boxes, or its layout is not supported; VISION107 the
            numbers of classes and names differ.
    """
    if metadata.task not in _IGNORED_OUTPUTS:
        message = phrase(
            "the network in '{file}' is for '{task}', so it outputs no boxes", file=file.name, task=metadata.task
        )
        raise LinkwrightError(Diagnostic("VISION106", message, hint=phrase("use a network for 'detect'")))
    extra_values, task = _count_extra_values(shapes, metadata)
    name_count = labels if labels is not None or metadata.names is None else len(metadata.names)
    first_shape = shapes[0] if shapes else ()
    forms = (
        _find_possible_forms(first_shape, size, extra_values, is_suppressed=metadata.is_suppressed)
        if len(first_shape) == 3
        else []
    )
    if not forms:
        shapes_text = " ".join(str(list(shape)) for shape in shapes)
        message = phrase(
            "the outputs of '{file}' are not boxes in a YOLO format: {shapes}", file=file.name, shapes=shapes_text
        )
        hint = phrase(
            "use a network with outputs [1, 4 + classes, N], [1, N, 5 + classes] with three rows for each grid "
            "cell, or [1, N, 6]; YOLOX, YOLOv6 and RT-DETR are not supported"
        )
        raise LinkwrightError(Diagnostic("VISION106", message, hint=hint))
    form, classes = next((form for form in forms if form[1] in (0, name_count)), forms[0])
    if name_count is not None and classes not in (0, name_count):
        raise class_count_error(file, classes, name_count, labels_file)
    return Layout(form, classes, _IGNORED_OUTPUTS[task])


def class_count_error(file: Path, classes: int, name_count: int, labels: Path | None) -> LinkwrightError:
    """Return the error for a network with more or fewer classes than names (VISION107).

    Args:
        file: the file of the network.
        classes: the number of its classes.
        name_count: the number of names.
        labels: the file with the names; None if they are in the file of the network.
    """
    if labels is None:
        message = phrase(
            "the network in '{file}' has {classes} classes, but its metadata has {names} names",
            file=file.name,
            classes=classes,
            names=name_count,
        )
        return LinkwrightError(
            Diagnostic("VISION107", message, hint=phrase("pass a labels file with one name per class"))
        )
    message = phrase(
        "the network in '{file}' has {classes} classes, but '{labels}' has {names} names",
        file=file.name,
        classes=classes,
        labels=labels,
        names=name_count,
    )
    return LinkwrightError(
        Diagnostic("VISION107", message, hint=phrase("pass the labels that the network was trained with"))
    )


def _count_extra_values(shapes: Sequence[Sequence[int]], metadata: Metadata) -> tuple[int, str]:
    """Return the number of values after the scores of a box, and the task that they belong to."""
    if metadata.task == "pose":
        return metadata.keypoint_value_count, "pose"
    masks = next((shape[1] for shape in shapes[1:] if len(shape) == 4), 0)
    if metadata.task in ("", "segment") and masks:
        return masks, "segment"
    return 0, metadata.task


def _find_possible_forms(
    shape: Sequence[int], size: tuple[int, int], extra_values: int, *, is_suppressed: bool
) -> list[tuple[BoxArrangement, int]]:
    """Return the forms that an output's shape allows, most likely first, with their class counts."""
    batch, first, second = shape
    if batch != 1:
        return []
    cell_counts = {sum((size[0] // stride) * (size[1] // stride) for stride in strides) for strides in _STRIDE_SETS}
    row_counts = {_BOXES_PER_CELL * cells for cells in cell_counts}
    if second == 6 + extra_values and (is_suppressed or first not in cell_counts | row_counts):
        return [(BoxArrangement.FINAL, 0)]
    as_columns, as_rows = (
        (BoxArrangement.COLUMNS, first - 4 - extra_values),
        (BoxArrangement.ROWS, second - 5 - extra_values),
    )
    forms = [as_columns] if second in cell_counts or second > first else []
    if first in row_counts:
        forms.insert(len(forms) if second in cell_counts else 0, as_rows)
    return [layout for layout in forms if layout[1] >= 1]
