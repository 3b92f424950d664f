"""Evaluate detectors: compute COCO's average precision and the confusion matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detections import Detections

OVERLAPS = tuple(round(0.5 + 0.05 * step, 2) for step in range(10))
"""The minimum intersection over union of a correct box: 0.50, 0.55, ... 0.95."""
MAX_DETECTIONS = 100
"""The maximum number of detections per class and image that count, the most certain first."""
_RECALL_LEVELS: NDArray[np.floating] = np.linspace(0.0, 1.0, 101)
_CONFUSION_SCORE, _CONFUSION_OVERLAP = 0.5, 0.5


@dataclass(frozen=True, slots=True)
class GroundTruth:
    """The labeled objects in an image.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom, in pixels.
        classes: shape ``(n,)``, indices into the dataset's names.
        ignored: shape ``(n,)``, whether a detection of the object counts neither as correct nor as wrong (``iscrowd``
            in COCO).
    """

    boxes: NDArray[np.float32]
    classes: NDArray[np.int32]
    ignored: NDArray[np.bool_]

    def select(self, mask: NDArray[np.bool_]) -> GroundTruth:
        """Return the objects that a mask selects."""
        return GroundTruth(self.boxes[mask], self.classes[mask], self.ignored[mask])


@dataclass(frozen=True, slots=True)
class ClassResults:
    """The results for one class.

    Attributes:
        name: the name of the class.
        objects: the number of objects.
        ap50: the average precision at an overlap of 0.5; None if there is no object.
        ap: the mean of the average precision over `OVERLAPS`; None if there is no object.
        precision: the fraction of correct detections among those with a score of at least 0.5; None if there are none.
        recall: the fraction of objects found with a score of at least 0.5; None if there is no object.
    """

    name: str
    objects: int
    ap50: float | None
    ap: float | None
    precision: float | None
    recall: float | None


@dataclass(frozen=True, slots=True)
class Evaluation:
    """The results of a detector on a set of images.

    Attributes:
        images: the number of images.
        map50: the mean of `ClassResults.ap50` over the classes with objects.
        map: the mean of `ClassResults.ap`.
        classes: the results for each class.
        confusion: shape ``(classes + 1, classes + 1)``: the number of objects of a class (row) detected as a class
            (column) with a score of at least 0.5. The last column counts objects that were not found, the last row
                detections at which there is no object.
        recall_by_size: for each size range its name, the number of objects, and the fraction of them that was found
            with a score of at least 0.5.
    """

    images: int
    map50: float
    map: float
    classes: tuple[ClassResults, ...]
    confusion: NDArray[np.int64]
    recall_by_size: tuple[tuple[str, int, float], ...]


def intersection_over_union(first: NDArray[np.float32], second: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the intersection over union of each box of one set with each box of another.

    Args:
        first: shape ``(n, 4)``: left, top, right, bottom.
        second: shape ``(m, 4)``.

    Returns:
        Shape ``(n, m)``.
    """
    first_boxes: NDArray[np.float64] = first.astype(np.float64)[:, None]
    second_boxes: NDArray[np.float64] = second.astype(np.float64)[None]
    overlap_sizes = np.clip(
        np.minimum(first_boxes[..., 2:], second_boxes[..., 2:])
        - np.maximum(first_boxes[..., :2], second_boxes[..., :2]),
        0,
        None,
    )
    intersection = overlap_sizes.prod(-1)
    union = (
        (first_boxes[..., 2:] - first_boxes[..., :2]).prod(-1)
        + (second_boxes[..., 2:] - second_boxes[..., :2]).prod(-1)
        - intersection
    )
    ratios: NDArray[np.float64] = intersection / np.maximum(union, 1e-12)
    return ratios


def evaluate(names: Sequence[str], truth: Sequence[GroundTruth], predictions: Sequence[Detections]) -> Evaluation:
    """Evaluate detections against labels.

    Args:
        names: the class names of `truth`.
        truth: the labels of each image.
        predictions: a detector's detections in the same images, with a threshold near 0. Classes are matched by name;
            detections of classes that are not in `names` do not count.
    """
    class_numbers = {name: index for index, name in enumerate(names)}
    detections = [_renumber_classes(class_numbers, detections) for detections in predictions]
    results, confusion, sizes = (
        [],
        _compute_confusion_matrix(len(names), truth, detections),
        _compute_recall_by_size(truth, detections),
    )
    for class_number, name in enumerate(names):
        precisions = _compute_average_precisions(class_number, truth, detections)
        correct_count = int(confusion[class_number, class_number])
        detected, objects = int(confusion[:, class_number].sum()), int(confusion[class_number].sum())
        results.append(
            ClassResults(
                name,
                objects,
                None if precisions is None else float(precisions[0]),
                None if precisions is None else float(precisions.mean()),
                correct_count / detected if detected else None,
                correct_count / objects if objects else None,
            )
        )
    return Evaluation(
        len(truth),
        _compute_mean([result.ap50 for result in results]),
        _compute_mean([result.ap for result in results]),
        tuple(results),
        confusion,
        sizes,
    )


def find_best_f1_threshold(
    names: Sequence[str], truth: Sequence[GroundTruth], predictions: Sequence[Detections]
) -> float:
    """Return the score threshold at which F1 over all classes is highest.

    The arguments are those of `evaluate`.

    Returns:
        A score between 0.05 and 0.95; 0.5 if no object was found.
    """
    class_numbers = {name: index for index, name in enumerate(names)}
    scores: list[NDArray[np.float32]] = [np.zeros(0, np.float32)]
    is_correct: list[NDArray[np.bool_]] = [np.zeros(0, bool)]
    object_count = 0
    for objects, image_predictions in zip(truth, predictions, strict=True):
        detections, counted_objects = (
            _renumber_classes(class_numbers, image_predictions),
            objects.select(~objects.ignored),
        )
        overlaps = intersection_over_union(detections.boxes, counted_objects.boxes) * (
            detections.classes[:, None] == counted_objects.classes[None]
        )
        is_hit = _match_objects(overlaps, _CONFUSION_OVERLAP) >= 0
        is_ignored = _compute_ignored_shares(detections.boxes, objects.boxes[objects.ignored]) >= _CONFUSION_OVERLAP
        is_counted = is_hit | ~is_ignored
        scores.append(detections.scores[is_counted])
        is_correct.append(is_hit[is_counted])
        object_count += len(counted_objects.classes)
    all_scores: NDArray[np.float32] = np.concatenate(scores)
    order = np.argsort(-all_scores, kind="stable")
    hits_until: NDArray[np.int64] = np.concatenate(is_correct)[order].cumsum()
    if not len(order) or not hits_until[-1]:
        return 0.5
    f1 = 2 * hits_until / (np.arange(1, len(order) + 1) + object_count)
    return float(np.clip(all_scores[order[int(f1.argmax())]], 0.05, 0.95))


@dataclass(frozen=True, slots=True)
class _SortedDetections:
    """Detections with class numbers of the dataset, the most certain first."""

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]

    def select(self, mask: NDArray[np.bool_]) -> _SortedDetections:
        return _SortedDetections(self.boxes[mask], self.scores[mask], self.classes[mask])


def _renumber_classes(class_numbers: dict[str, int], detections: Detections) -> _SortedDetections:
    numbers: NDArray[np.int32] = np.array([class_numbers.get(name, -1) for name in detections.names] or [-1], np.int32)
    order = np.argsort(-detections.scores, kind="stable")
    classes: NDArray[np.int32] = numbers[detections.classes[order]] if len(detections) else np.zeros(0, np.int32)
    sorted_detections = _SortedDetections(detections.boxes[order], detections.scores[order], classes)
    return sorted_detections.select(classes >= 0)


def _compute_average_precisions(
    class_number: int, truth: Sequence[GroundTruth], predictions: Sequence[_SortedDetections]
) -> NDArray[np.float64] | None:
    """Return the average precisions of a class, shape (overlaps,), or None if it has no object."""
    object_count = sum(int(((objects.classes == class_number) & ~objects.ignored).sum()) for objects in truth)
    if object_count == 0:
        return None
    scores: list[NDArray[np.float32]] = []
    is_correct: list[NDArray[np.bool_]] = []
    is_wrong: list[NDArray[np.bool_]] = []
    for objects, detections in zip(truth, predictions, strict=True):
        of_class = detections.select(detections.classes == class_number)
        boxes = of_class.boxes[:MAX_DETECTIONS]
        scores.append(of_class.scores[:MAX_DETECTIONS])
        objects_of_class = objects.select(objects.classes == class_number)
        overlaps = intersection_over_union(boxes, objects_of_class.boxes[~objects_of_class.ignored])
        ignored_shares = _compute_ignored_shares(boxes, objects_of_class.boxes[objects_of_class.ignored])
        is_correct.append(np.stack([_match_objects(overlaps, min_overlap) >= 0 for min_overlap in OVERLAPS]))
        is_wrong.append(~is_correct[-1] & np.stack([ignored_shares < min_overlap for min_overlap in OVERLAPS]))
    all_scores: NDArray[np.float32] = np.concatenate(scores)
    order = np.argsort(-all_scores, kind="stable")
    hits: NDArray[np.int64] = np.concatenate(is_correct, axis=1)[:, order].cumsum(axis=1)
    misses: NDArray[np.int64] = np.concatenate(is_wrong, axis=1)[:, order].cumsum(axis=1)
    precisions = hits / np.maximum(hits + misses, 1)
    return np.array(
        [
            _compute_interpolated_precision(row / object_count, class_precision)
            for row, class_precision in zip(hits, precisions, strict=True)
        ]
    )


def _compute_ignored_shares(boxes: NDArray[np.float32], hidden: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return for each box the largest fraction of its area that is inside one ignored box."""
    if not len(hidden):
        return np.zeros(len(boxes))
    overlap_sizes = np.minimum(boxes[:, None, 2:], hidden[None, :, 2:]) - np.maximum(
        boxes[:, None, :2], hidden[None, :, :2]
    )
    areas = (boxes[:, 2:] - boxes[:, :2]).prod(-1).astype(np.float64)
    shares: NDArray[np.float64] = np.clip(overlap_sizes, 0, None).prod(-1).max(1) / np.maximum(areas, 1e-12)
    return shares


def _compute_interpolated_precision(recall: NDArray[np.float64], precision: NDArray[np.float64]) -> float:
    """Return the mean of the interpolated precision over 101 recall levels."""
    interpolated: NDArray[np.float64] = np.maximum.accumulate(precision[::-1])[::-1]
    indices = np.searchsorted(recall, _RECALL_LEVELS, side="left")
    is_reached = indices < len(interpolated)
    return float(interpolated[indices[is_reached]].sum() / len(_RECALL_LEVELS))


def _match_objects(overlaps: NDArray[np.float64], min_overlap: float) -> NDArray[np.int64]:
    """Return the index of the object that each detection matches, or -1.

    An object is matched at most once. The detections must be sorted, because earlier ones are matched first.

    Args:
        overlaps: the overlap of each detection with each object, shape (detections, objects).
        min_overlap: the minimum overlap of a correct box.
    """
    matches: NDArray[np.int64] = np.full(len(overlaps), -1, np.int64)
    if overlaps.shape[1] == 0:
        return matches
    is_free: NDArray[np.bool_] = np.ones(overlaps.shape[1], bool)
    for detection, row in enumerate(overlaps):
        free_overlaps = np.where(is_free, row, -1.0)
        index = int(free_overlaps.argmax())
        if free_overlaps[index] >= min(min_overlap, 1 - 1e-10):
            matches[detection] = index
            is_free[index] = False
    return matches


def _compute_confusion_matrix(
    classes: int, truth: Sequence[GroundTruth], predictions: Sequence[_SortedDetections]
) -> NDArray[np.int64]:
    table: NDArray[np.int64] = np.zeros((classes + 1, classes + 1), np.int64)
    for objects, detections in zip(truth, predictions, strict=True):
        certain = detections.select(detections.scores >= _CONFUSION_SCORE)
        ignored_objects = objects.select(objects.ignored)
        objects = objects.select(~objects.ignored)
        overlaps = intersection_over_union(certain.boxes, objects.boxes)
        # Match objects of the same class first: a detection that also overlaps another object is correct.
        same_class_overlaps = overlaps * (certain.classes[:, None] == objects.classes[None])
        matches = _match_objects(same_class_overlaps, _CONFUSION_OVERLAP)
        remaining_overlaps = overlaps.copy()
        remaining_overlaps[:, matches[matches >= 0]] = 0
        remaining_overlaps[matches >= 0] = 0
        other_matches = _match_objects(remaining_overlaps, _CONFUSION_OVERLAP)
        matches = np.where(matches >= 0, matches, other_matches)
        is_ignored = _compute_ignored_shares(certain.boxes, ignored_objects.boxes) >= _CONFUSION_OVERLAP
        for number, index in enumerate(matches):
            if index < 0 and is_ignored[number]:
                continue
            table[objects.classes[index] if index >= 0 else classes, certain.classes[number]] += 1
        for index in set(range(len(objects.classes))) - set(matches.tolist()):
            table[objects.classes[index], classes] += 1
    return table


_SIZE_RANGES = (("under 16 pixels", 0.0, 16.0), ("16 to 32 pixels", 16.0, 32.0), ("32 to 96 pixels", 32.0, 96.0),
          ("over 96 pixels", 96.0, np.inf))  # fmt: skip
"""Ranges of the longer side of a box, in pixels of the image."""


def _compute_recall_by_size(
    truth: Sequence[GroundTruth], predictions: Sequence[_SortedDetections]
) -> tuple[tuple[str, int, float], ...]:
    lengths: list[float] = []
    is_found: list[bool] = []
    for objects, detections in zip(truth, predictions, strict=True):
        certain = detections.select(detections.scores >= _CONFUSION_SCORE)
        objects = objects.select(~objects.ignored)
        same_class_overlaps = intersection_over_union(certain.boxes, objects.boxes) * (
            certain.classes[:, None] == objects.classes[None]
        )
        matched = set(_match_objects(same_class_overlaps, _CONFUSION_OVERLAP).tolist())
        lengths += (objects.boxes[:, 2:] - objects.boxes[:, :2]).max(axis=1, initial=0).tolist()
        is_found += [index in matched for index in range(len(objects.classes))]
    rows = []
    for name, minimum, maximum in _SIZE_RANGES:
        found_in_range = [found for side, found in zip(lengths, is_found, strict=True) if minimum <= side < maximum]
        rows.append((name, len(found_in_range), sum(found_in_range) / len(found_in_range) if found_in_range else 0.0))
    return tuple(rows)


def _compute_mean(values: Sequence[float | None]) -> float:
    defined_values = [value for value in values if value is not None]
    return sum(defined_values) / len(defined_values) if defined_values else 0.0
