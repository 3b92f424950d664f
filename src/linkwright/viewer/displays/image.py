"""rviz_default_plugins/Image."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from linkwright.viewer.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.image_topic import ImageTopicDisplay
from linkwright.viewer.images import Range, has_range

_NORMALIZE = "Normalize Range"

_RANGE_SPECS: Schema = (
    PropertySpec(_NORMALIZE, "bool", True, "Find black and white in the values of the images."),
    PropertySpec("Min Value", "float", 0.0, "The value that is black.", when=((_NORMALIZE,), False)),
    PropertySpec("Max Value", "float", 1.0, "The value that is white.", when=((_NORMALIZE,), False)),
    PropertySpec(
        "Median window",
        "int",
        5,
        "Over so many images the median of black and of white is taken.",
        minimum=1,
        maximum=1000,
        when=((_NORMALIZE,), True),
    ),
)
_TOPIC_SPEC = topic_spec(
    description="sensor_msgs/msg/Image, or one below it with /compressed or /compressedDepth at its end."
)


class ImageDisplay(ImageTopicDisplay):
    """Images in a panel of their own.

    As in RViz the properties of the range are there once an image has values of more than 8 bits.
    """

    CLASS = "rviz_default_plugins/Image"
    SCHEMA = (_TOPIC_SPEC, *_RANGE_SPECS)
    TRANSFORMED = False

    _ranged = False

    def schema(self) -> Schema:
        """The properties; those of the range only for images that have one."""
        if self._ranged:
            return self.SCHEMA
        return (_TOPIC_SPEC, *(replace(spec, hidden=True) for spec in _RANGE_SPECS))

    def take_image(self, message: Any, pose: Pose | None) -> None:  # noqa: ARG002 - images have no place
        """Show an image."""
        ranged = has_range(getattr(message, "encoding", ""))
        if ranged != self._ranged:
            self._ranged = ranged
            self.publish_properties()
        self.ranges.window = int(self.properties.number("Median window"))
        self.ranges.fixed = None
        if not self.properties.flag(_NORMALIZE):
            self.ranges.fixed = Range(self.properties.number("Min Value"), self.properties.number("Max Value"))
        self.show_image(message)

    def changed(self, path: Path) -> None:
        """Show the image with another range."""
        super().changed(path)
        if any(spec.name == path[0] for spec in _RANGE_SPECS):
            self.show_again()
