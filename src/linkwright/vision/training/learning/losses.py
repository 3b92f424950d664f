"""Assign cells to objects, and compute the loss.

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
_NEAR = 8.0  # for small objects: cells within this many pixels of the centre may be assigned
_BOX_WEIGHT, _SCORE_WEIGHT = 4.0, 1.0
_SMALL = 1e-7


@dataclass(frozen=True, slots=True)
class Assignment:
    """The targets of each cell.

    Attributes:
        boxes: shape (batch, cells, 4), pixels; meaningless for cells without an object.
        scores: shape (batch, cells, classes), between 0 and 1.
        taken: shape (batch, cells), whether an object is assigned to the cell.
        unasked: shape (batch, cells), whether the cell has no target because its object is ignored.
    """

    boxes: Tensor
    scores: Tensor
    taken: Tensor
    unasked: Tensor


def overlaps(first: Tensor, second: Tensor) -> tuple[Tensor, Tensor]:
    """Return the IoU and the generalised IoU of boxes.

    Args:
        first: shape (..., 4), left, top, right, bottom.
        second: boxes whose shape broadcasts with `first`.

    Returns:
        The intersection over union, and the generalised one (Rezatofighi and others 2019), which also differs between
        boxes that do not touch. Both have the broadcast shape without the last axis.
    """
    inner = (torch.minimum(first[..., 2:], second[..., 2:]) - torch.maximum(first[..., :2], second[..., :2])).clamp(0)
    outer = (torch.maximum(first[..., 2:], second[..., 2:]) - torch.minimum(first[..., :2], second[..., :2])).clamp(0)
    common = inner.prod(-1)
    union = (first[..., 2:] - first[..., :2]).prod(-1) + (second[..., 2:] - second[..., :2]).prod(-1) - common
    hull = outer.prod(-1)
    iou = common / (union + _SMALL)
    return iou, iou - (hull - union) / (hull + _SMALL)


@torch.no_grad()
def assign(boxes: Tensor, logits: Tensor, middles: Tensor, objects: Tensor) -> Assignment:
    """Assign cells to each object.

    Args:
        boxes: the boxes of the network, shape (batch, cells, 4).
        logits: the class logits of the network, shape (batch, cells, classes).
        middles: the centres of the cells, shape (cells, 2).
        objects: shape (batch, most, 5): class, left, top, right, bottom. Class -1 pads images with fewer objects; a
            class below -1 marks an ignored object.
    """
    real = objects[..., 0] >= 0
    kinds = objects[..., 0].clamp(0).long()
    places = objects[..., 1:]
    _, cells, classes = logits.shape
    iou, _ = overlaps(places[:, :, None], boxes[:, None])
    scores = logits.sigmoid().transpose(1, 2).gather(1, kinds[..., None].expand(-1, -1, cells))
    fit = scores**_SCORE_POWER * iou**_OVERLAP_POWER
    half = ((places[..., 2:] - places[..., :2]) / 2).clamp(_NEAR)
    middle = (places[..., :2] + places[..., 2:]) / 2
    near = ((middles - middle[:, :, None]).abs() <= half[:, :, None]).all(3) & real[..., None]
    fit = (fit + _SMALL * iou) * near
    best = fit.topk(min(_CELLS_PER_OBJECT, cells), 2).indices
    chosen = torch.zeros_like(near).scatter_(2, best, value=True) & near & (fit > 0)
    # A cell claimed by several objects is assigned to the object that its box overlaps most.
    wanted = torch.where(chosen, iou, torch.full_like(iou, -1.0))
    most, owner = wanted.max(1)
    taken = most >= 0
    chosen = chosen & functional.one_hot(owner, objects.shape[1]).transpose(1, 2).bool()
    fit = fit * chosen
    level = fit / (fit.amax(2, keepdim=True) + 1e-12) * (iou * chosen).amax(2, keepdim=True)
    certainty = level.amax(1) * taken
    target = functional.one_hot(kinds.gather(1, owner), classes) * certainty[..., None]
    within = (middles >= places[:, :, None, :2]).all(3) & (middles <= places[:, :, None, 2:]).all(3)
    unasked = (within & (objects[..., 0] < -1)[..., None]).any(1) & ~taken
    return Assignment(places.gather(1, owner[..., None].expand(-1, -1, 4)), target.to(boxes.dtype), taken, unasked)


def loss(boxes: Tensor, logits: Tensor, middles: Tensor, objects: Tensor) -> tuple[Tensor, Tensor]:
    """Return the loss of a batch; the arguments are those of `assign`.

    Returns:
        The total loss, and its box and score parts, shape (2,), without gradients.
    """
    wanted = assign(boxes, logits, middles, objects)
    whole = wanted.scores.sum().clamp(1.0)
    of_scores = functional.binary_cross_entropy_with_logits(logits, wanted.scores, reduction="none")
    # Empty cells with confident scores weigh most; those that are already right weigh next to nothing.
    weights = torch.where(wanted.scores > 0, wanted.scores, 0.75 * logits.sigmoid().detach() ** 2)
    of_scores = (of_scores * weights * ~wanted.unasked[..., None]).sum() / whole
    weight = wanted.scores.sum(2)[wanted.taken]
    _, overlap = overlaps(boxes[wanted.taken], wanted.boxes[wanted.taken])
    of_boxes = ((1 - overlap) * weight).sum() / whole
    total = _BOX_WEIGHT * of_boxes + _SCORE_WEIGHT * of_scores
    return total, torch.stack((of_boxes, of_scores)).detach()
