"""The display of an image over the scene."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import foreign
from linkwright.images.decoding import BadImageError, RangeFinder, decode_image
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.overlays.base import Figure, OverlayDisplay

_IMAGE_ROW = "Image"
_MAX_PIXELS_PER_PIXEL = 2
"""The largest number of pixels that are sent for each pixel of the figure."""


class OverlayImageDisplay(OverlayDisplay):
    """A display of images at a place of the window."""

    CLASS = "jsk_rviz_plugin/OverlayImage"
    MESSAGE = "sensor_msgs/msg/Image"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec("keep aspect ratio", "bool", False, "Take the height from the width and the image."),
        PropertySpec("width", "int", 128, "Width, in pixels.", minimum=1),
        PropertySpec("height", "int", 128, "Height, in pixels.", minimum=1),
        PropertySpec("left", "int", 128, "Distance from the left edge, in pixels.", minimum=0),
        PropertySpec("top", "int", 128, "Distance from the upper edge, in pixels.", minimum=0),
        PropertySpec("alpha", "float", 0.8, "Opacity of the image.", minimum=0.0, maximum=1.0),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._ranges = RangeFinder()

    def reset(self) -> None:
        """Discard the image."""
        self._ranges.reset()
        super().reset()

    def figure(self, message: Any) -> Figure | None:
        """Return the image, or show in the status why it cannot be drawn."""
        try:
            image = decode_image(message, self._ranges)
        except BadImageError as error:
            self.set_status_row(_IMAGE_ROW, "error", foreign(error))
            return None
        self.delete_status_row(_IMAGE_ROW)
        number = self.properties.number
        width, height = number("width"), number("height")
        if self.properties.flag("keep aspect ratio") and image.width:
            height = width * image.height / image.width
        figure = Figure(number("left"), number("top"), width, height)
        pixels = image.subsample(max(1, int(_MAX_PIXELS_PER_PIXEL * width * height))).rgb()
        opacity = np.full((*pixels.shape[:2], 1), round(255 * number("alpha")), dtype=np.uint8)
        figure.image = np.concatenate([pixels, opacity], axis=2)
        return figure
