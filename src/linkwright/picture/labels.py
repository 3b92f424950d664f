"""Labels with the names of links or joints, next to their origins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.picture.bodies import Anchor
from linkwright.picture.camera import Camera
from linkwright.picture.lines import draw_lines
from linkwright.picture.stroke_font import LINE_HEIGHT, make_text_lines
from linkwright.picture.vectors import Floats

_TEXT_HEIGHT_PX = 15.0
"""The height of a line of text in pixels, for an image whose shorter side has `_DEFAULT_SIDE_PX` pixels."""
_DEFAULT_SIDE_PX, _MIN_SCALE = 600.0, 0.75
_LINE_RADIUS_PX, _HALO_RADIUS_PX, _DOT_RADIUS_PX = 0.75, 2.6, 2.4
"""Half the width of lines, the radius of the bright area around them, and the radius of the dots."""
_TEXT_OFFSET_PX, _SPACING_PX, _BORDER_PX = 14.0, 2.0, 4.0
"""The distances from a text to its anchor, to other texts, and to the border of the image."""


@dataclass(frozen=True, slots=True)
class _PlacedLabel:
    """A label in an image: its anchor, and the upper left corner and extent of its text.

    All values are in pixels.
    """

    text: str
    anchor: tuple[float, float]
    corner: tuple[float, float]
    extent: tuple[float, float]

    def overlaps(self, other: _PlacedLabel) -> bool:
        return all(
            self.corner[axis] < other.corner[axis] + other.extent[axis] + _SPACING_PX
            and other.corner[axis] < self.corner[axis] + self.extent[axis] + _SPACING_PX
            for axis in (0, 1)
        )


def draw_labels(colors: Floats, alpha: Floats, anchors: Sequence[Anchor], camera: Camera) -> None:
    """Draw labels over an image.

    Args:
        colors: the light of the pixels multiplied by their opacity, shape (height, width, 3), which is changed.
        alpha: the opacity of the pixels, shape (height, width), which is changed.
        anchors: the texts of the labels, and the points to which they belong.
        camera: the camera of the image.
    """
    if not anchors:
        return
    x, y, _ = camera.project(np.array([anchor.position for anchor in anchors]))
    scale = max(min(camera.size) / _DEFAULT_SIDE_PX, _MIN_SCALE)
    labels: list[_PlacedLabel] = []
    for index in sorted(range(len(anchors)), key=lambda index: (float(y[index]), index)):
        labels.append(_place_label(anchors[index].text, (float(x[index]), float(y[index])), labels, camera.size, scale))
    for label in labels:
        draw_lines(
            colors, alpha, _make_leader_line(label), _LINE_RADIUS_PX * 0.7 * scale, _HALO_RADIUS_PX * 0.5 * scale
        )
    for label in labels:
        draw_lines(
            colors,
            alpha,
            np.array([(label.anchor, label.anchor)]),
            _DOT_RADIUS_PX * scale,
            (_DOT_RADIUS_PX + 1.0) * scale,
        )
    for label in labels:
        draw_lines(colors, alpha, _make_letter_lines(label), _LINE_RADIUS_PX * scale, _HALO_RADIUS_PX * scale)


def _place_label(
    text: str, anchor: tuple[float, float], placed_labels: Sequence[_PlacedLabel], size: tuple[int, int], scale: float
) -> _PlacedLabel:
    """Return a label next to its anchor, at the first position without an overlap."""
    unit = _TEXT_HEIGHT_PX * scale / LINE_HEIGHT
    extent = (make_text_lines(text)[1] * unit, _TEXT_HEIGHT_PX * scale)
    is_left = anchor[0] + _TEXT_OFFSET_PX * scale + extent[0] + _BORDER_PX > size[0]
    x = anchor[0] - _TEXT_OFFSET_PX * scale - extent[0] if is_left else anchor[0] + _TEXT_OFFSET_PX * scale
    x = min(max(x, _BORDER_PX), max(_BORDER_PX, size[0] - extent[0] - _BORDER_PX))
    top = min(max(anchor[1] - extent[1] / 2, _BORDER_PX), size[1] - extent[1] - _BORDER_PX)
    step = extent[1] / 2 + _SPACING_PX
    for attempt in range(2 * int(size[1] / step) + 2):
        shift = (attempt + 1) // 2 * (step if attempt % 2 else -step)
        label = _PlacedLabel(text, anchor, (x, top + shift), extent)
        is_inside = _BORDER_PX <= label.corner[1] <= size[1] - extent[1] - _BORDER_PX
        if is_inside and not any(label.overlaps(other) for other in placed_labels):
            return label
    return _PlacedLabel(text, anchor, (x, top), extent)


def _make_leader_line(label: _PlacedLabel) -> Array:
    """Return the line that connects an anchor to its text."""
    is_right = label.corner[0] > label.anchor[0]
    x = label.corner[0] - _SPACING_PX if is_right else label.corner[0] + label.extent[0] + _SPACING_PX
    return np.array([(label.anchor, (x, label.corner[1] + label.extent[1] / 2))])


def _make_letter_lines(label: _PlacedLabel) -> Array:
    """Return the lines of the letters of a label."""
    lines, _ = make_text_lines(label.text)
    unit = label.extent[1] / LINE_HEIGHT
    lines = lines * unit
    lines[:, :, 0] += label.corner[0]
    lines[:, :, 1] = label.corner[1] + label.extent[1] - lines[:, :, 1]
    return lines
