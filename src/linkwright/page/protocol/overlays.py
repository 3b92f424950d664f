"""Content of the displays that draw over the scene: texts, lines and images at a place of the window."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Bytes, DataContent, Record

OverlayKind = Literal["line", "area", "text"]
HorizontalSide = Literal["left", "center", "right"]
VerticalSide = Literal["top", "center", "bottom"]


class OverlayShape(Record):
    """A part of an overlay; lengths are in CSS pixels from its top left corner.

    `points` are x and y of each corner of a line or an area, or of the place of a text. `size` is the width of a line,
    or the height of a text. Lines of a text are wrapped at `wrap`, if it is not 0. The place of a text is
    its upper edge, or its lower edge with `is_above`.
    """

    shape: OverlayKind
    points: list[float]
    color: list[float]
    size: float = 0.0
    text: str = ""
    align: HorizontalSide = "left"
    wrap: float = 0.0
    is_above: bool = False


class OverlayFigure(DataContent):
    """A figure over the scene, at a distance from two sides of the window; lengths are in CSS pixels.

    `label` describes the figure to those who cannot see it. `corner` is the radius of the background's corners.
    `pixels` are the rows of an image that fills the figure, red, green, blue and opacity; there may be none.
    """

    label: str
    horizontal: HorizontalSide
    vertical: VerticalSide
    x: float
    y: float
    width: float
    height: float
    background: list[float]
    corner: float
    shapes: list[OverlayShape]
    image_width: int
    image_height: int
    pixels: Bytes
