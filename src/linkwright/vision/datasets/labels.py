"""Compute the labels of an image from its exact segmentation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor
from typing import Any

import numpy as np

from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.renderer import Channels, Pixels, axes_of
from linkwright.vision.datasets.arranging import Shot
from linkwright.vision.datasets.stage import Prop, Stage

Box = tuple[int, int, int, int]
"""Left, top, right, bottom in pixels; it contains the columns left <= column < right."""

_BEYOND = 1.0
"""The margin around an image in which an object is searched, in widths of the image."""


@dataclass(frozen=True, slots=True)
class Label:
    """The label of an object in an image.

    Attributes:
        label: the index of its class.
        box: the box around its visible part, in pixels of the image.
        whole: the box around the whole object, without occlusion; may reach beyond the image.
        area: the number of its visible pixels.
        visibility: the visible share of the pixels that the object would have without occlusion and truncation.
        truncated: whether the object reaches beyond the image.
        ignored: whether too little of the object is visible to be found.
        counts: the run lengths of its mask, column by column, alternately outside and inside, beginning with outside.
    """

    label: int
    box: Box
    whole: Box
    area: int
    visibility: float
    truncated: bool
    ignored: bool
    counts: tuple[int, ...]


def label_image(stage: Stage, shot: Shot, geoms: Pixels, least_size: int, least_visible: float) -> list[Label]:
    """Return the labels of an image.

    Args:
        stage: the world, as it is in the image.
        shot: the camera.
        geoms: the geom of each pixel, shape (height, width).
        least_size: the shorter side of a box in pixels, below which an object is ignored; half of it for its largest
            shape.
        least_visible: the visible share of an object, and of its largest shape, below which it is ignored.
    """
    numbers = np.zeros(stage.simulation.model.ngeom + 1, dtype=np.uint8)  # the last is for geom -1: none
    for number, prop in enumerate(shot.shown, start=1):
        numbers[prop.geoms] = number
    objects = numbers[geoms]
    found = []
    for number, prop in enumerate(shot.shown, start=1):
        box = box_of(objects == number)
        if box is None:
            continue
        left, top, right, bottom = box
        mask = objects == number
        area = int(np.count_nonzero(mask[top:bottom, left:right]))
        whole, count, main_count = _uncovered(stage, shot, prop, box)
        count = max(count, area)
        main = geoms[top:bottom, left:right] == prop.main
        small = min(right - left, bottom - top) < least_size or _side_of(main) < least_size / 2
        beyond = whole[0] < 0 or whole[1] < 0 or whole[2] > geoms.shape[1] or whole[3] > geoms.shape[0]
        hidden = area < least_visible * count or int(np.count_nonzero(main)) < least_visible * main_count
        ignored = small or hidden
        found.append(Label(prop.label, box, whole, area, area / count, beyond, ignored, runs_of(mask)))
    return found


def box_of(mask: Any) -> Box | None:
    """Return the bounding box of a mask of shape (height, width); None for an empty mask."""
    rows = np.flatnonzero(mask.any(axis=1))
    if not len(rows):
        return None
    top, bottom = int(rows[0]), int(rows[-1]) + 1
    columns = np.flatnonzero(mask[top:bottom].any(axis=0))
    return int(columns[0]), top, int(columns[-1]) + 1, bottom


def _side_of(mask: Any) -> int:
    """Return the shorter side of a mask's bounding box."""
    box = box_of(mask)
    return min(box[2] - box[0], box[3] - box[1]) if box else 0


def runs_of(mask: Any) -> tuple[int, ...]:
    """Return a mask as COCO's uncompressed run lengths, by columns, beginning with false pixels."""
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    ends = [0, *changes.tolist(), len(flat)]
    counts = [after - before for before, after in pairwise(ends)]
    return tuple([0, *counts] if flat[0] else counts)


def _uncovered(stage: Stage, shot: Shot, prop: Prop, visible: Box) -> tuple[Box, int, int]:
    """Return an object's full box, its pixel count, and the pixel count of its largest geom.

    Occlusion and truncation are disregarded. An object that is larger than the image is rendered smaller, so its box is
    accurate only to a few pixels.
    """
    left, top, right, bottom = _window(stage, shot, prop, visible)
    optics = shot.optics
    scale = min(1.0, optics.width / (right - left), optics.height / (bottom - top))
    width, height = max(int((right - left) * scale), 1), max(int((bottom - top) * scale), 1)
    middle = (optics.cx - left) * scale, (optics.cy - top) * scale
    part = Optics(width, height, optics.fx * scale, optics.fy * scale, *middle, optics.near, optics.far)
    geoms = _alone(stage, prop, lambda: stage.renderer.render(part, shot.pose, Channels.GEOMS).geoms)
    mask = np.isin(geoms, prop.geoms)
    box = box_of(mask)
    if box is None:
        return visible, 0, 0
    whole = (
        min(floor(box[0] / scale) + left, visible[0]),
        min(floor(box[1] / scale) + top, visible[1]),
        max(ceil(box[2] / scale) + left, visible[2]),
        max(ceil(box[3] / scale) + top, visible[3]),
    )
    main = np.count_nonzero(geoms == prop.main)
    return whole, round(np.count_nonzero(mask) / scale**2), round(main / scale**2)


def _window(stage: Stage, shot: Shot, prop: Prop, visible: Box) -> Box:
    """Return the part of the image plane that contains an object and a margin, up to a maximum size."""
    optics, data, model = shot.optics, stage.simulation.data, stage.simulation.model
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    local = model.geom_aabb[prop.geoms, None, :3] + signs * model.geom_aabb[prop.geoms, None, 3:]
    turns = data.geom_xmat[prop.geoms].reshape(-1, 3, 3)
    corners = np.einsum("gij,gcj->gci", turns, local) + data.geom_xpos[prop.geoms, None, :]
    seen = (corners.reshape(-1, 3) - np.array(shot.pose[:3])) @ axes_of(shot.pose)
    wide, high = int(_BEYOND * optics.width), int(_BEYOND * optics.height)
    least, greatest = np.array([-wide, -high]), np.array([optics.width + wide, optics.height + high])
    if (seen[:, 2] > optics.near).all():
        places = optics.project(seen)
        least = np.maximum(least, np.floor(places.min(axis=0)) - 1)
        greatest = np.minimum(greatest, np.ceil(places.max(axis=0)) + 1)
    left, top = np.minimum(least, visible[:2]).astype(int).tolist()
    right, bottom = np.maximum(greatest, visible[2:]).astype(int).tolist()
    return left, top, right, bottom


def _alone(stage: Stage, prop: Prop, look: Callable[[], Any]) -> Any:
    """Call `look` while an object is the only visible one."""
    data = stage.simulation.data
    places = data.geom_xpos.copy()
    own = places[prop.geoms].copy()
    try:
        stage.hide(range(stage.simulation.model.ngeom))
        data.geom_xpos[prop.geoms] = own
        return look()
    finally:
        data.geom_xpos[:] = places
