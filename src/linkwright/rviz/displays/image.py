"""The displays Image and Camera, for raw and compressed images."""

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
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose, ViewerDisplay
from linkwright.rviz.displays.base.topic_display import TOPIC, SideTopic, TopicDisplay, camera_info_topic
from linkwright.rviz.image_compression import ImageCompressor

_ENCODINGS: dict[int, Literal["gray", "rgb", "rgba"]] = {1: "gray", 3: "rgb", 4: "rgba"}
MAX_PIXELS = 2_100_000
"""The largest number of pixels of an image that is sent to pages, about Full HD, because pixels are not compressed."""


class ImageTopicDisplay(TopicDisplay):
    """The base class of displays that show the images of a topic.

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
    def shown_message_types(cls) -> tuple[str, ...]:
        """Return the message types of raw and compressed images."""
        return (cls.MESSAGE, "sensor_msgs/msg/CompressedImage")

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with, according to the transport."""
        source = self._find_selected_source()
        return source.message_type, source.topic, super().subscription()[2]

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Decode an image and show it, or show the reason why it cannot be decoded."""
        try:
            image = self._to_image(message)
        except BadImageError as error:
            self.set_status_row("Image", "error", foreign(error))
            return
        self.process_image(image, pose)

    @abstractmethod
    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image.

        Args:
            message: a message with the fields of a sensor_msgs/msg/Image, or a sensor_msgs/msg/CompressedImage that
                browsers can decode.
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
            content = self._make_frame(message, camera)
        except BadImageError as error:
            self.set_status_row("Image", "error", foreign(error))
            return
        if content.encoding == "file" and is_cut_off(content.data):
            self.set_status_row("Image", "error", phrase("The image file is truncated"))
        else:
            self.delete_status_row("Image")
        frame, stamp_ns = TopicDisplay.frame_of(self, message)
        shrink = partial(self._compressor.compress, content)
        self.send(content, frame=frame.removeprefix("/"), pose=pose, stamp_ns=stamp_ns, shrink=shrink)

    def choose_reduction(self, width: int, height: int) -> int:
        """Return the block size by which an image is reduced before it is sent.

        Each square block of this side length, in pixels, is averaged to one pixel.
        """
        return 1

    def _find_selected_source(self) -> ImageSource:
        """Return the topic and transport that the topic property selects.

        The result includes the message type if the topic has a publisher.
        """
        source = ImageSource.of(self.properties.text(TOPIC))
        if not source.topic:
            return source
        try:
            return source.with_types(
                {message_type for _, message_type in self.context.published.publishers(source.topic)}
            )
        except InvalidTopicNameError:  # the subscription reports the invalid name
            return source

    def _report_count(self) -> None:
        if self._count == 0 and self._find_selected_source() != self._source:
            self._restart()
        else:
            super()._report_count()

    def _subscribe(self) -> None:
        source = self._source = self._find_selected_source()
        if source.is_supported:
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

    def _to_image(self, message: Any) -> Any:
        transport = self._source.transport_of(message)
        if transport == COMPRESSED and not has_range(encoding_of(message)):
            return message
        return self._unpacker.image(message, transport)

    def _make_frame(self, message: Any, camera: CameraModel | None) -> ImageFrame:
        if not hasattr(message, "encoding"):
            data = np.frombuffer(message.data, np.uint8)
            if not _is_readable(data[:16].tobytes()):
                raise BadImageError(
                    phrase("Browsers do not support the image format '{format}'", format=message.format)
                )
            return ImageFrame(0, 0, 0, 0, "file", data, camera)
        image = decode_image(message, self.ranges)
        reduced_image = image.reduce_by(self.choose_reduction(image.width, image.height)).subsample(MAX_PIXELS)
        return ImageFrame(
            width=image.width,
            height=image.height,
            columns=reduced_image.width,
            rows=reduced_image.height,
            encoding=_ENCODINGS[reduced_image.channels],
            data=reduced_image.pixels,
            camera=camera,
        )


def _is_readable(header: bytes) -> bool:
    """Return whether data starts with the signature of a JPEG, PNG, GIF, BMP or WebP file."""
    return header.startswith((b"\xff\xd8\xff", b"\x89PNG", b"GIF8", b"BM")) or header[8:12] == b"WEBP"


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
    """A display of images in a separate panel.

    As in RViz, the properties of the value range appear once an image has values of more than 8 bits.
    """

    CLASS = "rviz_default_plugins/Image"
    SCHEMA = (_TOPIC_SPEC, *_RANGE_SPECS)
    TRANSFORMED = False

    _has_range = False
    _panel: ImageSize | None = None
    """The size of the largest panel of any page, or None before a page has reported its panel."""

    @property
    def _is_hidden(self) -> bool:
        """Whether pages have reported their panels, and none of the panels is visible."""
        return self._panel is not None and (self._panel.width <= 0 or self._panel.height <= 0)

    def receive(self, message: Any) -> None:
        """Adapt the resolution of the images to the size of the largest panel.

        While no panel is visible, the display unsubscribes after its first image, so that a camera that publishes only
        to subscribers does not publish for a hidden panel.
        """
        previous_size, self._panel = self._panel, message
        if self._is_hidden:
            if self.last_message is not None:
                self._unsubscribe()
            return
        if self.enabled and self._subscription is None:
            self._subscribe()
            if self.last_message is not None:  # the previous image is still shown
                self._count = 1
                self._report_count()
        if previous_size is not None and (message.width > previous_size.width or message.height > previous_size.height):
            self.show_again()

    def choose_reduction(self, width: int, height: int) -> int:
        """Return the largest block size at which no panel loses detail."""
        panel = self._panel
        if panel is None or panel.width <= 0 or panel.height <= 0:
            return 1
        return max(1, int(max(width / panel.width, height / panel.height)))

    def schema(self) -> Schema:
        """Return the properties.

        The value range is hidden unless the last image has more than 8 bits.
        """
        if self._has_range:
            return self.SCHEMA
        return (_TOPIC_SPEC, *(replace(spec, hidden=True) for spec in _RANGE_SPECS))

    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image, or unsubscribe if no panel is visible."""
        if self._is_hidden:
            self._unsubscribe()
            return
        has_range_now = has_range(getattr(message, "encoding", ""))
        if has_range_now != self._has_range:
            self._has_range = has_range_now
            self.publish_properties()
        self.ranges.window = int(self.properties.number("Median window"))
        self.ranges.fixed = None
        if not self.properties.flag(_NORMALIZE):
            self.ranges.fixed = Range(self.properties.number("Min Value"), self.properties.number("Max Value"))
        self.show_image(message)

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again, or show the last image with a new value range."""
        super().on_property_changed(path)
        if any(spec.name == path[0] for spec in _RANGE_SPECS):
            self.show_again()


_INFO_ROW = "Camera Info"
_MAX_QUEUED = 10

_CAMERA_SPECS: Schema = (
    topic_spec(description="sensor_msgs/msg/Image. The topic camera_info in the same namespace describes the camera."),
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
        "The far clipping distance, in meters.",
        minimum=0.00001,
        maximum=100000.0,
    ),
)


class CameraDisplay(ImageTopicDisplay):
    """A display of the scene as seen by a camera, in a separate panel.

    The camera's image is drawn behind the scene, over it, or both.
    """

    CLASS = "rviz_default_plugins/Camera"
    SCHEMA = _CAMERA_SPECS

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._check_boxes: Schema = ()
        super().__init__(host, identity, config)
        self._info_topic = SideTopic(host, "sensor_msgs/msg/CameraInfo", self._on_camera_info)
        self._info: Any = None

    def schema(self) -> Schema:
        """Return the properties, with a check box for each other display."""
        check_box = PropertySpec(
            "Visibility",
            "bool",
            True,
            "The displays that the camera shows.",
            children=self._check_boxes,
            nested=True,
        )
        return (*_CAMERA_SPECS, check_box)

    def on_displays_rearranged(self, displays: Sequence[ViewerDisplay]) -> None:
        """Update the check boxes of the other displays."""
        check_boxes = self._make_check_boxes(displays, None)
        if check_boxes != self._check_boxes:
            self._check_boxes = check_boxes
            self.publish_properties()

    def _make_check_boxes(self, displays: Sequence[ViewerDisplay], group: DisplayConfig | None) -> Schema:
        """Return a check box for each other display in a group, including its subgroups.

        Of several displays with the same name, only the first has a check box. `group` is None for the top level.
        """
        specs: dict[str, PropertySpec] = {}
        for display in displays:
            config = display.config
            if config.group is not group or display is self or config.name in specs:
                continue
            children = self._make_check_boxes(displays, config) if config.is_group else ()
            text = "Show this display through the camera."
            specs[config.name] = PropertySpec(
                config.name, "bool", True, text, children=children, nested=config.is_group
            )
        return tuple(specs.values())

    def max_waiting_messages(self) -> int:
        """Return the maximum number of queued messages, a constant as in RViz."""
        return _MAX_QUEUED

    def process_image(self, message: Any, pose: Pose | None) -> None:
        """Show an image, with the camera's parameters if they are known."""
        camera = self._make_camera_model(message)
        self.show_image(message, camera, pose)

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        self._info_topic.resume()
        super().on_time_changed()

    def reset(self) -> None:
        """Discard the image and the camera parameters."""
        if self.last_message is None:
            self._info = None
        super().reset()

    def _subscribe(self) -> None:
        super()._subscribe()
        topic = self.properties.text(TOPIC).strip()
        if not topic:
            return
        info = camera_info_topic(topic)
        problem = self._info_topic.listen(info, qos_from_properties(self.properties))
        text = problem or phrase("No CameraInfo received on [{topic}]. Topic may not exist.", topic=info)
        self.set_status_row(_INFO_ROW, "error" if problem else "warn", text)

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._info_topic.close()

    def _on_camera_info(self, info: Any) -> None:
        is_first = self._info is None
        self._info = info
        if is_first:
            self.show_again()

    def _make_camera_model(self, image: Any) -> CameraModel | None:
        """Return the camera model for an image, or None if there is no valid CameraInfo.

        If the CameraInfo is not valid, the reason is shown in the status.
        """
        info = self._info
        if info is None:
            return None
        arrays = [np.asarray(array, np.float64) for array in (info.d, info.k, info.r, info.p)]
        if not all(np.isfinite(matrix).all() for matrix in arrays):
            self.set_status_row(_INFO_ROW, "error", phrase("Contains invalid floating point values (nans or infs)"))
            return None
        width = info.width or getattr(image, "width", 0)
        height = info.height or getattr(image, "height", 0)
        if width == 0 or height == 0:
            text = phrase(
                "Could not determine width/height of image due to malformed CameraInfo (either width or height is 0)"
            )
            self.set_status_row(_INFO_ROW, "error", text)
            return None
        projection = arrays[3]
        if projection[0] == 0.0 or projection[5] == 0.0:
            text = phrase("CameraInfo/P resulted in an invalid position calculation (nans or infs)")
            self.set_status_row(_INFO_ROW, "error", text)
            return None
        self.set_status_row(_INFO_ROW, "ok", phrase("OK"))
        return CameraModel(
            width=float(width),
            height=float(height),
            focal_x=float(projection[0]),
            focal_y=float(projection[5]),
            center_x=float(projection[2]),
            center_y=float(projection[6]),
            offset_x=float(-projection[3] / projection[0]),
            offset_y=float(-projection[7] / projection[5]),
        )
