"""The labels of an image, computed from its exact segmentation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor
from typing import Any

import numpy as np

from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.renderer import Channels, Pixels, compute_image_axes
from linkwright.vision.datasets.arrangement import Arrangement
from linkwright.vision.datasets.randomized_world import MovableObject, RandomizedWorld

Box = tuple[int, int, int, int]
"""Left, top, right and bottom in pixels, where right and bottom are the first column and row outside."""

_MARGIN_IMAGE_WIDTHS = 1.0
"""The margin around an image within which an object's full box is measured, in image widths."""


@dataclass(frozen=True, slots=True)
class Label:
    """The label of an object in an image.

    Attributes:
        label: the index of its class.
        box: the box around its visible part, in pixels of the image.
        full_box: the box around the whole object, without occlusion; it may reach beyond the image.
        area: the number of its visible pixels.
        visibility: the visible pixels divided by the pixels of the object without occlusion and truncation.
        is_truncated: whether the object reaches beyond the image.
        is_ignored: whether the object is too small or too hidden for a label.
        run_lengths: the run lengths of its mask by columns, alternately outside and inside, beginning with outside.
    """

    label: int
    box: Box
    full_box: Box
    area: int
    visibility: float
    is_truncated: bool
    is_ignored: bool
    run_lengths: tuple[int, ...]


def label_image(
    world: RandomizedWorld, arrangement: Arrangement, geoms: Pixels, min_size: int, min_visible: float
) -> list[Label]:
    """Return the labels of all objects that are visible in an image.

    Args:
        world: the world in the state of the image.
        arrangement: the camera and the objects.
        geoms: the geom at each pixel, -1 for none, shape (height, width).
        min_size: the minimum length in pixels of a box's shorter side; a smaller object is ignored. For an object's
            largest geom, half of this length is enough.
        min_visible: the minimum visible fraction of an object and of its largest geom; a less visible object is
            ignored.
    """
    numbers = np.zeros(world.simulation.model.ngeom + 1, dtype=np.uint8)  # the last entry is for geom -1: none
    for number, movable in enumerate(arrangement.placed_objects, start=1):
        numbers[movable.geoms] = number
    objects = numbers[geoms]
    labels = []
    for number, movable in enumerate(arrangement.placed_objects, start=1):
        box = find_bounding_box(objects == number)
        if box is None:
            continue
        left, top, right, bottom = box
        mask = objects == number
        area = int(np.count_nonzero(mask[top:bottom, left:right]))
        full_box, full_count, main_count = _measure_unoccluded(world, arrangement, movable, box)
        full_count = max(full_count, area)
        main_mask = geoms[top:bottom, left:right] == movable.main_geom
        is_small = min(right - left, bottom - top) < min_size or _measure_shorter_side(main_mask) < min_size / 2
        is_truncated = (
            full_box[0] < 0 or full_box[1] < 0 or full_box[2] > geoms.shape[1] or full_box[3] > geoms.shape[0]
        )
        is_hidden = area < min_visible * full_count or int(np.count_nonzero(main_mask)) < min_visible * main_count
        is_ignored = is_small or is_hidden
        labels.append(
            Label(
                movable.label,
                box,
                full_box,
                area,
                area / full_count,
                is_truncated,
                is_ignored,
                encode_run_lengths(mask),
            )
        )
    return labels


def find_bounding_box(mask: Any) -> Box | None:
    """Return the bounding box of a mask in pixels: left, top, right, bottom; None if it is empty.

    The mask has the shape (height, width). `right` and `bottom` are exclusive.
    """
    rows = np.flatnonzero(mask.any(axis=1))
    if not len(rows):
        return None
    top, bottom = int(rows[0]), int(rows[-1]) + 1
    columns = np.flatnonzero(mask[top:bottom].any(axis=0))
    return int(columns[0]), top, int(columns[-1]) + 1, bottom


def _measure_shorter_side(mask: Any) -> int:
    """Return the shorter side of a mask's bounding box."""
    box = find_bounding_box(mask)
    return min(box[2] - box[0], box[3] - box[1]) if box else 0


def encode_run_lengths(mask: Any) -> tuple[int, ...]:
    """Return a mask as COCO's uncompressed run lengths by columns, beginning with false pixels."""
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    ends = [0, *changes.tolist(), len(flat)]
    counts = [end - previous_end for previous_end, end in pairwise(ends)]
    return tuple([0, *counts] if flat[0] else counts)


def _measure_unoccluded(
    world: RandomizedWorld, arrangement: Arrangement, movable: MovableObject, visible: Box
) -> tuple[Box, int, int]:
    """Return an object's full box, its pixel count, and the pixel count of its largest geom.

    The measurement ignores occlusion and truncation. An object larger than the image is rendered smaller, so its box is
    accurate only to a few pixels.
    """
    left, top, right, bottom = _project_bounds(world, arrangement, movable, visible)
    optics = arrangement.optics
    scale = min(1.0, optics.width / (right - left), optics.height / (bottom - top))
    width, height = max(int((right - left) * scale), 1), max(int((bottom - top) * scale), 1)
    middle = (optics.cx - left) * scale, (optics.cy - top) * scale
    optics_of_part = Optics(width, height, optics.fx * scale, optics.fy * scale, *middle, optics.near, optics.far)
    geoms = _render_alone(
        world, movable, lambda: world.renderer.render(optics_of_part, arrangement.pose, Channels.GEOMS).geoms
    )
    mask = np.isin(geoms, movable.geoms)
    box = find_bounding_box(mask)
    if box is None:
        return visible, 0, 0
    full_box = (
        min(floor(box[0] / scale) + left, visible[0]),
        min(floor(box[1] / scale) + top, visible[1]),
        max(ceil(box[2] / scale) + left, visible[2]),
        max(ceil(box[3] / scale) + top, visible[3]),
    )
    main_pixels = np.count_nonzero(geoms == movable.main_geom)
    return full_box, round(np.count_nonzero(mask) / scale**2), round(main_pixels / scale**2)


def _project_bounds(world: RandomizedWorld, arrangement: Arrangement, movable: MovableObject, visible: Box) -> Box:
    """Return the rectangle of the image plane that contains an object, in pixels.

    The rectangle reaches at most one image width and height beyond the image. It has this maximum size if part of the
    object is behind the camera.
    """
    optics, data, model = arrangement.optics, world.simulation.data, world.simulation.model
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    local = model.geom_aabb[movable.geoms, None, :3] + signs * model.geom_aabb[movable.geoms, None, 3:]
    rotations = data.geom_xmat[movable.geoms].reshape(-1, 3, 3)
    world_corners = np.einsum("gij,gcj->gci", rotations, local) + data.geom_xpos[movable.geoms, None, :]
    camera_corners = (world_corners.reshape(-1, 3) - np.array(arrangement.pose[:3])) @ compute_image_axes(
        arrangement.pose
    )
    margin_x, margin_y = int(_MARGIN_IMAGE_WIDTHS * optics.width), int(_MARGIN_IMAGE_WIDTHS * optics.height)
    minimum, maximum = np.array([-margin_x, -margin_y]), np.array([optics.width + margin_x, optics.height + margin_y])
    if (camera_corners[:, 2] > optics.near).all():
        pixels = optics.project(camera_corners)
        minimum = np.maximum(minimum, np.floor(pixels.min(axis=0)) - 1)
        maximum = np.minimum(maximum, np.ceil(pixels.max(axis=0)) + 1)
    left, top = np.minimum(minimum, visible[:2]).astype(int).tolist()
    right, bottom = np.maximum(maximum, visible[2:]).astype(int).tolist()
    return left, top, right, bottom


def _render_alone(world: RandomizedWorld, movable: MovableObject, render: Callable[[], Any]) -> Any:
    """Return the result of `render`, called while all other objects are hidden."""
    data = world.simulation.data
    positions = data.geom_xpos.copy()
    object_positions = positions[movable.geoms].copy()
    try:
        world.hide(range(world.simulation.model.ngeom))
        data.geom_xpos[movable.geoms] = object_positions
        return render()
    finally:
        data.geom_xpos[:] = positions
