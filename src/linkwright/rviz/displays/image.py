"""The displays Image and Camera, which show the images of a topic, raw or compressed."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Literal

import numpy as np

from linkwright.diagnostics import foreign, phrase
from linkwright.graph import InvalidTopicNameError, QoSProfile
from linkwright.images import (
    COMPRESSED,
    BadImageError,
    ImageSource,
    Range,
    RangeFinder,
    Unpacker,
    decode_image,
    encoding_of,
    has_range,
    is_cut_off,
)
from linkwright.page.protocol.images import CameraModel, ImageFrame, ImageSize
from linkwright.rviz.config.property_store import qos_of
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose, ViewerDisplay
from linkwright.rviz.displays.base.topic_display import TOPIC, SideTopic, TopicDisplay, camera_info_topic
from linkwright.rviz.image_compression import ImageCompressor

_ENCODINGS: dict[int, Literal["grey", "rgb", "rgba"]] = {1: "grey", 3: "rgb", 4: "rgba"}
MOST_PIXELS = 2_100_000
"""Pages receive no more pixels of an image than Full HD has: panels are smaller, and pixels are not compressed."""


class ImageTopicDisplay(TopicDisplay):
    """The base class of displays of a topic's images.

    As in RViz, the suffix of the topic name selects the transport. Images on ``/compressed`` topics are in file formats
    that browsers can decode. They are sent to the page unchanged, unless their values have more than 8 bits.
    """

    MESSAGE = "sensor_msgs/msg/Image"

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self.ranges = RangeFinder()
        self._compressor = ImageCompressor()
        self._unpacker = Unpacker()
        self._source = ImageSource("")

    @classmethod
    def messages_shown(cls) -> tuple[str, ...]:
        """Return the message types of raw and compressed images."""
        return (cls.MESSAGE, "sensor_msgs/msg/CompressedImage")

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with, which depend on the transport."""
        source = self._named_source()
        return source.message_type, source.topic, super().subscription()[2]

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Decode an image and show it, or show the reason why it cannot be decoded."""
        try:
            image = self._image_of(message)
        except BadImageError as error:
            self.set_status_row("Image", "error", foreign(error))
            return
        self.process_image(image, pose)

    @abstractmethod
    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image.

        Args:
            message: a message with the fields of a sensor_msgs/msg/Image, or a sensor_msgs/msg/CompressedImage for
                browsers.
            pose: see `process_message`.
        """

    def reset(self) -> None:
        """Discard the image."""
        self.ranges.reset()
        super().reset()

    def show_image(self, message: Any, camera: CameraModel | None = None, pose: Pose | None = None) -> None:
        """Send an image to the pages, or show the reason why it cannot be drawn.

        Args:
            message: see `process_image`.
            camera: the camera of the image, or None.
            pose: the pose of the image's frame in the Fixed Frame, or None.
        """
        try:
            content = self._frame(message, camera)
        except BadImageError as error:
            self.set_status_row("Image", "error", foreign(error))
            return
        if content.encoding == "file" and is_cut_off(content.data):
            self.set_status_row("Image", "error", phrase("The image's file is truncated"))
        else:
            self.delete_status_row("Image")
        frame, stamp_ns = TopicDisplay.frame_of(self, message)
        shrink = partial(self._compressor.compressed, content)
        self.send(content, frame=frame.removeprefix("/"), pose=pose, stamp_ns=stamp_ns, shrink=shrink)

    def reduction(self, width: int, height: int) -> int:
        """Return the side length, in pixels, of the blocks that are averaged to one pixel before sending."""
        return 1

    def _named_source(self) -> ImageSource:
        """Return the topic and transport that the topic property selects.

        The result includes the message type if the topic has a publisher.
        """
        source = ImageSource.of(self.properties.text(TOPIC))
        if not source.topic:
            return source
        try:
            return source.carrying({carried for _, carried in self.context.published.publishers(source.topic)})
        except InvalidTopicNameError:  # the subscription reports the invalid name
            return source

    def _report_count(self) -> None:
        if self._count == 0 and self._named_source() != self._source:
            self._restart()
        else:
            super()._report_count()

    def _subscribe(self) -> None:
        source = self._source = self._named_source()
        if source.is_read:
            super()._subscribe()
        else:
            choice = phrase("choose {base} or {base}/{compressed}", base=source.base, compressed=COMPRESSED)
            self.set_status_row(
                TOPIC,
                "error",
                phrase(
                    "Images of transport '{transport}' are not supported: {choice}",
                    transport=source.transport,
                    choice=choice,
                ),
            )

    def _image_of(self, message: Any) -> Any:
        transport = self._source.transport_of(message)
        if transport == COMPRESSED and not has_range(encoding_of(message)):
            return message
        return self._unpacker.image(message, transport)

    def _frame(self, message: Any, camera: CameraModel | None) -> ImageFrame:
        if not hasattr(message, "encoding"):
            data = np.frombuffer(message.data, np.uint8)
            if not _is_readable(data[:16].tobytes()):
                raise BadImageError(
                    phrase("Browsers do not support the image's format: '{format}'", format=message.format)
                )
            return ImageFrame(0, 0, 0, 0, "file", data, camera)
        image = decode_image(message, self.ranges)
        shown = image.reduced(self.reduction(image.width, image.height)).thinned(MOST_PIXELS)
        return ImageFrame(
            width=image.width,
            height=image.height,
            columns=shown.width,
            rows=shown.height,
            encoding=_ENCODINGS[shown.channels],
            data=shown.pixels,
            camera=camera,
        )


def _is_readable(start: bytes) -> bool:
    """Return whether data starts with the signature of a JPEG, PNG, GIF, BMP or WebP file."""
    return start.startswith((b"\xff\xd8\xff", b"\x89PNG", b"GIF8", b"BM")) or start[8:12] == b"WEBP"


_NORMALIZE = "Normalize Range"

_RANGE_SPECS: Schema = (
    PropertySpec(_NORMALIZE, "bool", True, "Derive black and white from the values of the images."),
    PropertySpec("Min Value", "float", 0.0, "The value that is black.", when=((_NORMALIZE,), False)),
    PropertySpec("Max Value", "float", 1.0, "The value that is white.", when=((_NORMALIZE,), False)),
    PropertySpec(
        "Median window",
        "int",
        5,
        "The number of images over which black and white are the median.",
        minimum=1,
        maximum=1000,
        when=((_NORMALIZE,), True),
    ),
)
_TOPIC_SPEC = topic_spec(
    description="sensor_msgs/msg/Image, or a topic below it that ends in /compressed or /compressedDepth."
)


class ImageDisplay(ImageTopicDisplay):
    """A display of images in a panel of their own.

    As in RViz, the properties of the value range appear once an image has values of more than 8 bits.
    """

    CLASS = "rviz_default_plugins/Image"
    SCHEMA = (_TOPIC_SPEC, *_RANGE_SPECS)
    TRANSFORMED = False

    _ranged = False
    _panel: ImageSize | None = None
    """The largest panel of pages; None before a page has reported its panel."""

    @property
    def _is_hidden(self) -> bool:
        """Whether pages have reported their panels and none of these is visible."""
        return self._panel is not None and (self._panel.width <= 0 or self._panel.height <= 0)

    def receive(self, message: Any) -> None:
        """Handle the size of the largest panel, and send no more pixels than it shows.

        While no panel is visible, the display unsubscribes after its first image. A camera that publishes only while it
        has subscribers then publishes no images for a hidden panel.
        """
        before, self._panel = self._panel, message
        if self._is_hidden:
            if self.last is not None:
                self._unsubscribe()
            return
        if self.enabled and self._subscription is None:
            self._subscribe()
            if self.last is not None:  # the former image is still shown
                self._count = 1
                self._report_count()
        if before is not None and (message.width > before.width or message.height > before.height):
            self.show_again()

    def reduction(self, width: int, height: int) -> int:
        """Return the largest block size at which no panel loses detail."""
        panel = self._panel
        if panel is None or panel.width <= 0 or panel.height <= 0:
            return 1
        return max(1, int(max(width / panel.width, height / panel.height)))

    def schema(self) -> Schema:
        """Return the properties; those of the value range are hidden unless the last image has one."""
        if self._ranged:
            return self.SCHEMA
        return (_TOPIC_SPEC, *(replace(spec, hidden=True) for spec in _RANGE_SPECS))

    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image, or unsubscribe if no panel is visible."""
        if self._is_hidden:
            self._unsubscribe()
            return
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
        """Subscribe again, or show the last image with a new value range."""
        super().changed(path)
        if any(spec.name == path[0] for spec in _RANGE_SPECS):
            self.show_again()


_INFO = "Camera Info"
_MOST_WAITING = 10

_SPECS: Schema = (
    topic_spec(description="sensor_msgs/msg/Image; the topic camera_info beside it gives the camera."),
    PropertySpec(
        "Image Rendering",
        "enum",
        "background and overlay",
        "Draw the image behind everything else, over it, or both.",
        options=("background", "overlay", "background and overlay"),
    ),
    PropertySpec("Overlay Alpha", "float", 0.5, "Opacity of the image over the scene.", minimum=0.0, maximum=1.0),
    PropertySpec(
        "Zoom Factor",
        "float",
        1.0,
        "The zoom: below 1 shows more of the scene than the image, above 1 less.",
        minimum=0.00001,
        maximum=100000.0,
    ),
    PropertySpec(
        "Far Plane Distance",
        "float",
        100.0,
        "The far clipping distance, in metres.",
        minimum=0.00001,
        maximum=100000.0,
    ),
)


class CameraDisplay(ImageTopicDisplay):
    """A display of the scene as seen by a camera, in a panel of its own.

    The camera's image is drawn behind the scene, over it, or both.
    """

    CLASS = "rviz_default_plugins/Camera"
    SCHEMA = _SPECS

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._boxes: Schema = ()
        super().__init__(host, identity, config)
        self._infos = SideTopic(host, "sensor_msgs/msg/CameraInfo", self._info_received)
        self._info: Any = None

    def schema(self) -> Schema:
        """Return the properties, with a check box for each other display."""
        check_box = PropertySpec(
            "Visibility",
            "bool",
            True,
            "The displays that the camera shows.",
            children=self._boxes,
            nested=True,
        )
        return (*_SPECS, check_box)

    def arranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Update the check boxes of the other displays."""
        boxes = self._boxes_of(displays, None)
        if boxes != self._boxes:
            self._boxes = boxes
            self.publish_properties()

    def _boxes_of(self, displays: Sequence[ViewerDisplay], group: DisplayConfig | None) -> Schema:
        """Return a check box for each other display in a group, with those of subgroups as children.

        Of several displays with the same name, only the first has a check box. `group` is None for the top level.
        """
        found: dict[str, PropertySpec] = {}
        for display in displays:
            config = display.config
            if config.group is not group or display is self or config.name in found:
                continue
            inside = self._boxes_of(displays, config) if config.is_group else ()
            text = "Show this display through the camera."
            found[config.name] = PropertySpec(config.name, "bool", True, text, children=inside, nested=config.is_group)
        return tuple(found.values())

    def most_waiting(self) -> int:
        """Return RViz's fixed maximum of queued messages; the display has no property for it."""
        return _MOST_WAITING

    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image, with the camera's parameters if they are known."""
        camera = self._model(message)
        self.show_image(message, camera, pose)

    def time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        self._infos.resume()
        super().time_changed()

    def reset(self) -> None:
        """Discard the image and the camera parameters."""
        if self.last is None:
            self._info = None
        super().reset()

    def _subscribe(self) -> None:
        super()._subscribe()
        topic = self.properties.text(TOPIC).strip()
        if not topic:
            return
        info = camera_info_topic(topic)
        problem = self._infos.listen(info, qos_of(self.properties))
        text = problem or phrase("No CameraInfo received on [{topic}]. Topic may not exist.", topic=info)
        self.set_status_row(_INFO, "error" if problem else "warn", text)

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._infos.close()

    def _info_received(self, info: Any) -> None:
        first = self._info is None
        self._info = info
        if first:
            self.show_again()

    def _model(self, image: Any) -> CameraModel | None:
        """Return the camera model for an image, or None if there is no valid CameraInfo.

        If the CameraInfo is not valid, the reason is shown in the status.
        """
        info = self._info
        if info is None:
            return None
        numbers = [np.asarray(part, np.float64) for part in (info.d, info.k, info.r, info.p)]
        if not all(np.isfinite(part).all() for part in numbers):
            self.set_status_row(_INFO, "error", phrase("Contains invalid floating point values (nans or infs)"))
            return None
        width = info.width or getattr(image, "width", 0)
        height = info.height or getattr(image, "height", 0)
        if width == 0 or height == 0:
            text = phrase(
                "Could not determine width/height of image due to malformed CameraInfo (either width or height is 0)"
            )
            self.set_status_row(_INFO, "error", text)
            return None
        p = numbers[3]
        if p[0] == 0.0 or p[5] == 0.0:
            text = phrase("CameraInfo/P resulted in an invalid position calculation (nans or infs)")
            self.set_status_row(_INFO, "error", text)
            return None
        self.set_status_row(_INFO, "ok", phrase("OK"))
        return CameraModel(
            width=float(width),
            height=float(height),
            focal_x=float(p[0]),
            focal_y=float(p[5]),
            centre_x=float(p[2]),
            centre_y=float(p[6]),
            offset_x=float(-p[3] / p[0]),
            offset_y=float(-p[7] / p[5]),
        )
