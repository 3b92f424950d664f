"""The assignment of cells to objects, and the loss.

An object is assigned to the cells that already predict it best, judged by score and overlap combined. The better a
cell's box is, the higher its target score (task-aligned assignment, Feng and others 2021).
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn import functional

_SCORE_POWER, _OVERLAP_POWER = 1.0, 4.0
_CELLS_PER_OBJECT = 10
_MIN_HALF_SIZE_PIXELS = 8.0  # for small objects: cells within this many pixels of the center may be assigned
_BOX_WEIGHT, _SCORE_WEIGHT = 4.0, 1.0
_EPSILON = 1e-7
"""Avoids divisions by zero."""


@dataclass(frozen=True, slots=True)
class Assignment:
    """The targets of each cell.

    Attributes:
        boxes: shape (batch, cells, 4), pixels; only meaningful for cells with an object.
        scores: shape (batch, cells, classes), the target scores between 0 and 1.
        is_assigned: shape (batch, cells), whether an object is assigned to the cell.
        is_ignored: shape (batch, cells), whether the cell is left out of the score loss, because it is inside an
            ignored object and not assigned.
    """

    boxes: Tensor
    scores: Tensor
    is_assigned: Tensor
    is_ignored: Tensor


def pairwise_iou(first: Tensor, second: Tensor) -> tuple[Tensor, Tensor]:
    """Return the IoU and the generalized IoU of pairs of boxes.

    Args:
        first: shape (..., 4), left, top, right, bottom.
        second: boxes whose shape broadcasts with `first`.

    Returns:
        The intersection over union, and the generalized one (Rezatofighi and others 2019), which also differs between
        boxes that do not touch. Both have the broadcast shape without the last axis.
    """
    intersection_sizes = (
        torch.minimum(first[..., 2:], second[..., 2:]) - torch.maximum(first[..., :2], second[..., :2])
    ).clamp(0)
    hull_sizes = (
        torch.maximum(first[..., 2:], second[..., 2:]) - torch.minimum(first[..., :2], second[..., :2])
    ).clamp(0)
    intersection = intersection_sizes.prod(-1)
    union = (first[..., 2:] - first[..., :2]).prod(-1) + (second[..., 2:] - second[..., :2]).prod(-1) - intersection
    hull = hull_sizes.prod(-1)
    iou = intersection / (union + _EPSILON)
    return iou, iou - (hull - union) / (hull + _EPSILON)


@torch.no_grad()
def assign_cells(boxes: Tensor, logits: Tensor, centers: Tensor, objects: Tensor) -> Assignment:
    """Assign cells to each object, and return the targets of all cells.

    Args:
        boxes: the boxes of the network, shape (batch, cells, 4).
        logits: the class logits of the network, shape (batch, cells, classes).
        centers: the centers of the cells, shape (cells, 2).
        objects: shape (batch, count, 5): class, left, top, right, bottom. Class -1 pads images with fewer objects; a
            class below -1 marks an ignored object.
    """
    is_object = objects[..., 0] >= 0
    class_indices = objects[..., 0].clamp(0).long()
    object_boxes = objects[..., 1:]
    _, cells, classes = logits.shape
    iou, _ = pairwise_iou(object_boxes[:, :, None], boxes[:, None])
    scores = logits.sigmoid().transpose(1, 2).gather(1, class_indices[..., None].expand(-1, -1, cells))
    alignment = scores**_SCORE_POWER * iou**_OVERLAP_POWER
    half_sizes = ((object_boxes[..., 2:] - object_boxes[..., :2]) / 2).clamp(_MIN_HALF_SIZE_PIXELS)
    object_centers = (object_boxes[..., :2] + object_boxes[..., 2:]) / 2
    is_near = ((centers - object_centers[:, :, None]).abs() <= half_sizes[:, :, None]).all(3) & is_object[..., None]
    alignment = (alignment + _EPSILON * iou) * is_near
    best_cells = alignment.topk(min(_CELLS_PER_OBJECT, cells), 2).indices
    is_candidate = torch.zeros_like(is_near).scatter_(2, best_cells, value=True) & is_near & (alignment > 0)
    # A cell that is a candidate for several objects is assigned to the object with the highest IoU.
    candidate_iou = torch.where(is_candidate, iou, torch.full_like(iou, -1.0))
    max_iou, assigned_object = candidate_iou.max(1)
    is_assigned = max_iou >= 0
    is_candidate = is_candidate & functional.one_hot(assigned_object, objects.shape[1]).transpose(1, 2).bool()
    alignment = alignment * is_candidate
    cell_scores = alignment / (alignment.amax(2, keepdim=True) + 1e-12) * (iou * is_candidate).amax(2, keepdim=True)
    target_scores = cell_scores.amax(1) * is_assigned
    target = functional.one_hot(class_indices.gather(1, assigned_object), classes) * target_scores[..., None]
    is_inside = (centers >= object_boxes[:, :, None, :2]).all(3) & (centers <= object_boxes[:, :, None, 2:]).all(3)
    is_ignored = (is_inside & (objects[..., 0] < -1)[..., None]).any(1) & ~is_assigned
    return Assignment(
        object_boxes.gather(1, assigned_object[..., None].expand(-1, -1, 4)),
        target.to(boxes.dtype),
        is_assigned,
        is_ignored,
    )


def compute_loss(boxes: Tensor, logits: Tensor, centers: Tensor, objects: Tensor) -> tuple[Tensor, Tensor]:
    """Return the loss of a batch, given the arguments of `assign_cells`.

    Returns:
        The total loss; and the box loss and the score loss, shape (2,), without gradients.
    """
    targets = assign_cells(boxes, logits, centers, objects)
    normalizer = targets.scores.sum().clamp(1.0)
    score_loss = functional.binary_cross_entropy_with_logits(logits, targets.scores, reduction="none")
    # Empty cells with high scores weigh most. Empty cells with low scores are already correct and weigh almost nothing.
    weights = torch.where(targets.scores > 0, targets.scores, 0.75 * logits.sigmoid().detach() ** 2)
    score_loss = (score_loss * weights * ~targets.is_ignored[..., None]).sum() / normalizer
    box_weights = targets.scores.sum(2)[targets.is_assigned]
    _, generalized_iou = pairwise_iou(boxes[targets.is_assigned], targets.boxes[targets.is_assigned])
    box_loss = ((1 - generalized_iou) * box_weights).sum() / normalizer
    total = _BOX_WEIGHT * box_loss + _SCORE_WEIGHT * score_loss
    return total, torch.stack((box_loss, score_loss)).detach()
