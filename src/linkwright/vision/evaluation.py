"""Evaluate detectors: average precision as COCO defines it, and confusion of classes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detections import Detections

OVERLAPS = tuple(round(0.5 + 0.05 * step, 2) for step in range(10))
"""The least intersection over union of a correct box: 0.50, 0.55, ... 0.95."""
MOST = 100
"""The number of detections of an image that count, the most certain ones."""
_RECALLS: NDArray[np.floating] = np.linspace(0.0, 1.0, 101)
_CONFUSION_SCORE, _CONFUSION_OVERLAP = 0.5, 0.5


@dataclass(frozen=True, slots=True)
class GroundTruth:
    """The labelled objects in an image.

    Attributes:
        boxes: shape ``(n, 4)``: left, top, right, bottom, in pixels.
        classes: shape ``(n,)``, indices in the dataset's names.
        ignored: shape ``(n,)``, whether a detection of the object counts neither as right nor as wrong (``iscrowd`` in
            COCO).
    """

    boxes: NDArray[np.float32]
    classes: NDArray[np.int32]
    ignored: NDArray[np.bool_]

    def where(self, chosen: NDArray[np.bool_]) -> GroundTruth:
        """Return the objects that a mask selects."""
        return GroundTruth(self.boxes[chosen], self.classes[chosen], self.ignored[chosen])


@dataclass(frozen=True, slots=True)
class ClassFigures:
    """The results for one class.

    Attributes:
        name: the name of the class.
        objects: the number of objects.
        ap50: the average precision at an overlap of 0.5; None if there is no object.
        ap: the mean of the average precision over `OVERLAPS`; None if there is no object.
        precision: the share of correct detections among those with a score of at least 0.5; None if there are none.
        recall: the share of objects that these detections find; None if there is no object.
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
        map50: the mean of `ClassFigures.ap50` over the classes with objects.
        map: the mean of `ClassFigures.ap`.
        classes: the results for each class.
        confusion: shape ``(classes + 1, classes + 1)``: how many objects of a class (row) were detected as a class
            (column) with a score of at least 0.5. The last column counts objects that were not found, the last row
            detections where there is no object.
        recall_by_size: for each size range its name, the number of objects, and the share of them found with a score of
            at least 0.5.
    """

    images: int
    map50: float
    map: float
    classes: tuple[ClassFigures, ...]
    confusion: NDArray[np.int64]
    recall_by_size: tuple[tuple[str, int, float], ...]


def overlap(first: NDArray[np.float32], second: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the intersection over union of each box of one set with each box of another.

    Args:
        first: shape ``(n, 4)``: left, top, right, bottom.
        second: shape ``(m, 4)``.

    Returns:
        Shape ``(n, m)``.
    """
    one: NDArray[np.float64] = first.astype(np.float64)[:, None]
    other: NDArray[np.float64] = second.astype(np.float64)[None]
    inner = np.clip(np.minimum(one[..., 2:], other[..., 2:]) - np.maximum(one[..., :2], other[..., :2]), 0, None)
    common = inner.prod(-1)
    union = (one[..., 2:] - one[..., :2]).prod(-1) + (other[..., 2:] - other[..., :2]).prod(-1) - common
    shares: NDArray[np.float64] = common / np.maximum(union, 1e-12)
    return shares


def evaluate(names: Sequence[str], truth: Sequence[GroundTruth], found: Sequence[Detections]) -> Evaluation:
    """Evaluate detections against labels.

    Args:
        names: the class names of `truth`.
        truth: the labels of each image.
        found: a detector's detections in the same images, with a threshold near 0. Classes are matched by name; those
            that `names` lacks do not count.
    """
    known = {name: place for place, name in enumerate(names)}
    detections = [_in_terms_of(known, detections) for detections in found]
    figures, confusion, sizes = [], _confusion(len(names), truth, detections), _by_size(truth, detections)
    for place, name in enumerate(names):
        precisions = _average_precisions(place, truth, detections)
        right = int(confusion[place, place])
        detected, there = int(confusion[:, place].sum()), int(confusion[place].sum())
        figures.append(
            ClassFigures(
                name,
                there,
                None if precisions is None else float(precisions[0]),
                None if precisions is None else float(precisions.mean()),
                right / detected if detected else None,
                right / there if there else None,
            )
        )
    return Evaluation(
        len(truth),
        _mean([figure.ap50 for figure in figures]),
        _mean([figure.ap for figure in figures]),
        tuple(figures),
        confusion,
        sizes,
    )


def balanced_score(names: Sequence[str], truth: Sequence[GroundTruth], found: Sequence[Detections]) -> float:
    """Return the score threshold with the greatest F1 over all classes.

    The arguments are those of `evaluate`.

    Returns:
        A score between 0.05 and 0.95; 0.5 if nothing was found.
    """
    known = {name: place for place, name in enumerate(names)}
    scores: list[NDArray[np.float32]] = [np.zeros(0, np.float32)]
    right: list[NDArray[np.bool_]] = [np.zeros(0, bool)]
    there = 0
    for objects, predictions in zip(truth, found, strict=True):
        detections, asked = _in_terms_of(known, predictions), objects.where(~objects.ignored)
        same = overlap(detections.boxes, asked.boxes) * (detections.classes[:, None] == asked.classes[None])
        hits = _matches(same, _CONFUSION_OVERLAP) >= 0
        hidden = _within(detections.boxes, objects.boxes[objects.ignored]) >= _CONFUSION_OVERLAP
        counts = hits | ~hidden
        scores.append(detections.scores[counts])
        right.append(hits[counts])
        there += len(asked.classes)
    whole: NDArray[np.float32] = np.concatenate(scores)
    order = np.argsort(-whole, kind="stable")
    hits_until: NDArray[np.int64] = np.concatenate(right)[order].cumsum()
    if not len(order) or not hits_until[-1]:
        return 0.5
    worth = 2 * hits_until / (np.arange(1, len(order) + 1) + there)
    return float(np.clip(whole[order[int(worth.argmax())]], 0.05, 0.95))


@dataclass(frozen=True, slots=True)
class _Found:
    """Detections with the dataset's class indices, the most certain first."""

    boxes: NDArray[np.float32]
    scores: NDArray[np.float32]
    classes: NDArray[np.int32]

    def where(self, chosen: NDArray[np.bool_]) -> _Found:
        return _Found(self.boxes[chosen], self.scores[chosen], self.classes[chosen])


def _in_terms_of(known: dict[str, int], found: Detections) -> _Found:
    numbers: NDArray[np.int32] = np.array([known.get(name, -1) for name in found.names] or [-1], np.int32)
    order = np.argsort(-found.scores, kind="stable")
    classes: NDArray[np.int32] = numbers[found.classes[order]] if len(found) else np.zeros(0, np.int32)
    every = _Found(found.boxes[order], found.scores[order], classes)
    return every.where(classes >= 0)


def _average_precisions(
    place: int, truth: Sequence[GroundTruth], found: Sequence[_Found]
) -> NDArray[np.float64] | None:
    """Return the average precisions of one class, shape (overlaps,); None if it has no object."""
    there = sum(int(((objects.classes == place) & ~objects.ignored).sum()) for objects in truth)
    if there == 0:
        return None
    scores: list[NDArray[np.float32]] = []
    right: list[NDArray[np.bool_]] = []
    wrong: list[NDArray[np.bool_]] = []
    for objects, detections in zip(truth, found, strict=True):
        mine = detections.where(detections.classes == place)
        boxes = mine.boxes[:MOST]
        scores.append(mine.scores[:MOST])
        same = objects.where(objects.classes == place)
        shares = overlap(boxes, same.boxes[~same.ignored])
        hidden = _within(boxes, same.boxes[same.ignored])
        right.append(np.stack([_matches(shares, least) >= 0 for least in OVERLAPS]))
        wrong.append(~right[-1] & np.stack([hidden < least for least in OVERLAPS]))
    all_scores: NDArray[np.float32] = np.concatenate(scores)
    order = np.argsort(-all_scores, kind="stable")
    hits: NDArray[np.int64] = np.concatenate(right, axis=1)[:, order].cumsum(axis=1)
    misses: NDArray[np.int64] = np.concatenate(wrong, axis=1)[:, order].cumsum(axis=1)
    precisions = hits / np.maximum(hits + misses, 1)
    return np.array([_area(row / there, best) for row, best in zip(hits, precisions, strict=True)])


def _within(boxes: NDArray[np.float32], hidden: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the largest share of each box that is within one of the ignored regions."""
    if not len(hidden):
        return np.zeros(len(boxes))
    inner = np.minimum(boxes[:, None, 2:], hidden[None, :, 2:]) - np.maximum(boxes[:, None, :2], hidden[None, :, :2])
    areas = (boxes[:, 2:] - boxes[:, :2]).prod(-1).astype(np.float64)
    shares: NDArray[np.float64] = np.clip(inner, 0, None).prod(-1).max(1) / np.maximum(areas, 1e-12)
    return shares


def _area(recall: NDArray[np.float64], precision: NDArray[np.float64]) -> float:
    """Return the mean of the interpolated precision at 101 recall values."""
    best: NDArray[np.float64] = np.maximum.accumulate(precision[::-1])[::-1]
    places = np.searchsorted(recall, _RECALLS, side="left")
    reached = places < len(best)
    return float(best[places[reached]].sum() / len(_RECALLS))


def _matches(shares: NDArray[np.float64], least: float) -> NDArray[np.int64]:
    """Return the object that each detection matches, or -1; each object is matched once at most.

    The most certain detections choose first.

    Args:
        shares: the overlap of each detection with each object, shape (detections, objects).
        least: the minimum overlap of a correct box.
    """
    found: NDArray[np.int64] = np.full(len(shares), -1, np.int64)
    if shares.shape[1] == 0:
        return found
    free: NDArray[np.bool_] = np.ones(shares.shape[1], bool)
    for number, row in enumerate(shares):
        open_shares = np.where(free, row, -1.0)
        index = int(open_shares.argmax())
        if open_shares[index] >= min(least, 1 - 1e-10):
            found[number] = index
            free[index] = False
    return found


def _confusion(classes: int, truth: Sequence[GroundTruth], found: Sequence[_Found]) -> NDArray[np.int64]:
    table: NDArray[np.int64] = np.zeros((classes + 1, classes + 1), np.int64)
    for objects, detections in zip(truth, found, strict=True):
        sure = detections.where(detections.scores >= _CONFUSION_SCORE)
        hidden = objects.where(objects.ignored)
        objects = objects.where(~objects.ignored)
        shares = overlap(sure.boxes, objects.boxes)
        # Match objects of the same class first: another overlapping box does not make a correct detection a confusion.
        same = shares * (sure.classes[:, None] == objects.classes[None])
        matches = _matches(same, _CONFUSION_OVERLAP)
        left = shares.copy()
        left[:, matches[matches >= 0]] = 0
        left[matches >= 0] = 0
        others = _matches(left, _CONFUSION_OVERLAP)
        matches = np.where(matches >= 0, matches, others)
        unseen = _within(sure.boxes, hidden.boxes) >= _CONFUSION_OVERLAP
        for number, index in enumerate(matches):
            if index < 0 and unseen[number]:
                continue
            table[objects.classes[index] if index >= 0 else classes, sure.classes[number]] += 1
        for index in set(range(len(objects.classes))) - set(matches.tolist()):
            table[objects.classes[index], classes] += 1
    return table


_SIZES = (("under 16 pixels", 0.0, 16.0), ("16 to 32 pixels", 16.0, 32.0), ("32 to 96 pixels", 32.0, 96.0),
          ("over 96 pixels", 96.0, np.inf))  # fmt: skip
"""Ranges of the longer side of a box, in pixels of the image."""


def _by_size(truth: Sequence[GroundTruth], found: Sequence[_Found]) -> tuple[tuple[str, int, float], ...]:
    sides: list[float] = []
    hit: list[bool] = []
    for objects, detections in zip(truth, found, strict=True):
        sure = detections.where(detections.scores >= _CONFUSION_SCORE)
        objects = objects.where(~objects.ignored)
        same = overlap(sure.boxes, objects.boxes) * (sure.classes[:, None] == objects.classes[None])
        matched = set(_matches(same, _CONFUSION_OVERLAP).tolist())
        sides += (objects.boxes[:, 2:] - objects.boxes[:, :2]).max(axis=1, initial=0).tolist()
        hit += [index in matched for index in range(len(objects.classes))]
    rows = []
    for name, least, most in _SIZES:
        inside = [was for side, was in zip(sides, hit, strict=True) if least <= side < most]
        rows.append((name, len(inside), sum(inside) / len(inside) if inside else 0.0))
    return tuple(rows)


def _mean(values: Sequence[float | None]) -> float:
    there = [value for value in values if value is not None]
    return sum(there) / len(there) if there else 0.0
