"""The display rviz_default_plugins/DepthCloud."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import foreign, phrase
from linkwright.graph import HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.images import RAW, TRANSPORTS, BadImageError, ImageSource, RangeFinder, Unpacker, decode_image
from linkwright.rviz.clouds import BadCloudError, DepthCamera, DepthCloudBuilder, Points
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import SideTopic, camera_info_topic
from linkwright.rviz.displays.cloud_properties import POSITION_TRANSFORMER, STYLE_SPECS, TRANSFORMER_SPECS
from linkwright.rviz.displays.point_clouds import CloudDisplay

RELIABILITY = "Reliability Policy"
DEPTH_TOPIC, DEPTH_TRANSPORT = "Depth Map Topic", "Depth Map Transport Hint"
INFO_TOPIC = "CameraInfo Topic"
COLOR_TOPIC, COLOR_TRANSPORT = "Color Image Topic", "Color Transport Hint"
QUEUE_SIZE = "Queue Size"
AUTO_SIZE, SIZE_FACTOR = "Auto Size", "Auto Size Factor"
OCCLUSION, OCCLUSION_TIMEOUT = "Occlusion Compensation", "Occlusion Time-Out"
TOPIC_FILTER = "Topic Filter"
_IMAGE = "sensor_msgs/msg/Image"

SOURCES = frozenset((RELIABILITY, DEPTH_TOPIC, DEPTH_TRANSPORT, INFO_TOPIC, COLOR_TOPIC, COLOR_TRANSPORT, QUEUE_SIZE))
"""The properties that select the sources of messages."""

DEPTH_SCHEMA: Schema = (
    PropertySpec(
        RELIABILITY,
        "enum",
        "Best effort",
        "Whether every message must arrive, or may be lost.",
        options=("System Default", "Reliable", "Best effort"),
    ),
    PropertySpec(TOPIC_FILTER, "bool", True, "Offer only topics whose names suggest depth and color images."),
    PropertySpec(
        DEPTH_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/Image with depths: 16UC1 in millimeters or 32FC1 in meters.",
        messages=(_IMAGE,),
        name_words=("depth",),
    ),
    PropertySpec(
        DEPTH_TRANSPORT, "enum", RAW, "The image transport of the depths: raw, or compressedDepth.", options=TRANSPORTS
    ),
    PropertySpec(
        INFO_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/CameraInfo of the depths. The default is camera_info in the same namespace.",
        messages=("sensor_msgs/msg/CameraInfo",),
    ),
    PropertySpec(
        COLOR_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/Image with the colors of the points.",
        messages=(_IMAGE,),
        name_words=("color", "rgb", "bgr", "gray", "mono"),
    ),
    PropertySpec(
        COLOR_TRANSPORT, "enum", RAW, "The image transport of the colors: raw, or compressed.", options=TRANSPORTS
    ),
    PropertySpec(QUEUE_SIZE, "int", 5, "The size of the message queue.", minimum=1, maximum=1000),
    PropertySpec(
        AUTO_SIZE,
        "bool",
        True,
        "Make each point as large as its pixel is at its depth.",
        expanded=True,
        children=(
            PropertySpec(
                SIZE_FACTOR,
                "float",
                1.0,
                "A factor on the size of the points.",
                minimum=0.0001,
                when=((AUTO_SIZE,), True),
            ),
        ),
    ),
    PropertySpec(
        OCCLUSION,
        "bool",
        False,
        "Keep points that nearer points cover, until the camera moves.",
        expanded=True,
        children=(
            PropertySpec(
                OCCLUSION_TIMEOUT,
                "float",
                30.0,
                "Seconds until covered points are removed.",
                when=((OCCLUSION,), True),
            ),
        ),
    ),
    *STYLE_SPECS,
    *(replace(spec, hidden=True) if spec.name == POSITION_TRANSFORMER else spec for spec in TRANSFORMER_SPECS),
)

DEPTH_SCHEMA_UNFILTERED: Schema = tuple(replace(spec, name_words=()) for spec in DEPTH_SCHEMA)
"""The schema if ``Topic Filter`` is off: topics with any name are offered."""

_MAX_TIME_DIFFERENCE_NS = 500_000_000
"""The largest time between a color image and its depth image, in nanoseconds."""

# The camera has moved if its pose changes by more than these values, in meters and radians.
_MOVE_THRESHOLD = 0.01
_TURN_THRESHOLD = np.radians(0.5)


class DepthCloudDisplay(CloudDisplay):
    """A display of the points of a depth image, optionally colored by a color image."""

    CLASS = "rviz_default_plugins/DepthCloud"
    MESSAGE = "sensor_msgs/msg/Image"
    SCHEMA = DEPTH_SCHEMA
    TOPIC = (DEPTH_TOPIC,)
    TOPIC_ROW: ClassVar[str] = "Depth Map"

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._is_filtered = True
        super().__init__(host, identity, config)
        self._is_filtered = self.properties.flag(TOPIC_FILTER)
        self._info_topic = SideTopic(host, "sensor_msgs/msg/CameraInfo", self._on_info)
        self._color_topic: SideTopic | None = None
        self._depth_unpacker = Unpacker()
        self._color_unpacker = Unpacker()
        self._builder = DepthCloudBuilder()
        self._info: Any = None
        self._pixel_width = 0.0
        self._recent_colors: deque[Any] = deque()
        self._pending: tuple[Any, Pose] | None = None
        self._camera_pose: Pose | None = None

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS of the depth image, according to its transport."""
        source = self._find_depth_source()
        return source.message_type, source.topic, self._make_qos()

    def max_waiting_messages(self) -> int:
        """Return the maximum number of queued depth images.

        The same limit applies to stored color images.
        """
        return int(self.properties.number(QUEUE_SIZE))

    def pixel_size(self) -> float:
        """Return the width of a point in m at a distance of 1 m, or 0 if ``Auto Size`` is off."""
        return (
            self._pixel_width * self.properties.number(AUTO_SIZE, SIZE_FACTOR)
            if self.properties.flag(AUTO_SIZE)
            else 0.0
        )

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show a depth image, or store it until its CameraInfo and its color image have arrived."""
        assert pose is not None
        color = self._find_nearest_color(message) if self._has_color_topic() else None
        if self._info is None or (color is None and self._has_color_topic()):
            self._pending = (message, pose)
            return
        self._pending = None
        self._show_depths(message, pose, color)

    def schema(self) -> Schema:
        """Return the properties.

        With ``Topic Filter``, only topics with suitable names are offered.
        """
        return DEPTH_SCHEMA if self._is_filtered else DEPTH_SCHEMA_UNFILTERED

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to other topics, apply the topic filter, or redraw the last depth image."""
        if path[0] in SOURCES:
            self._restart()
            return
        if path == (TOPIC_FILTER,):
            self._is_filtered = self.properties.flag(TOPIC_FILTER)
            self.publish_properties()
        super().on_property_changed(path)
        if path[0] in (AUTO_SIZE, OCCLUSION):
            self.show_again()

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        self._info_topic.resume()
        if self._color_topic is not None:
            self._color_topic.resume()
        super().on_time_changed()

    def reset(self) -> None:
        """Discard all points, including the points stored for occlusion compensation."""
        self._builder.reset()
        self._camera_pose = None
        self._pending = None
        if self.last_message is None:
            self._info = None
            self._recent_colors.clear()
        super().reset()

    # --- topics ------------------------------------------------------------------------------------------------

    def _make_qos(self) -> QoSProfile:
        is_reliable = self.properties.text(RELIABILITY) == "Reliable"
        return QoSProfile(
            depth=int(self.properties.number(QUEUE_SIZE)),
            history=HistoryPolicy.KEEP_LAST,
            reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        )

    def _find_depth_source(self) -> ImageSource:
        return ImageSource.of(self.properties.text(DEPTH_TOPIC), self.properties.text(DEPTH_TRANSPORT))

    def _find_color_source(self) -> ImageSource:
        return ImageSource.of(self.properties.text(COLOR_TOPIC), self.properties.text(COLOR_TRANSPORT))

    def _subscribe(self) -> None:
        depth, color = self._find_depth_source(), self._find_color_source()
        for name, source in ((DEPTH_TRANSPORT, depth), (COLOR_TRANSPORT, color)):
            if not source.is_supported:
                choice = phrase("choose raw, compressed or compressedDepth")
                self.set_status_row(
                    name,
                    "error",
                    phrase(
                        "Images of transport '{transport}' are not supported: {choice}",
                        transport=source.transport,
                        choice=choice,
                    ),
                )
        if not (depth.is_supported and color.is_supported):
            return
        super()._subscribe()
        if not depth.topic:
            return
        info = self.properties.text(INFO_TOPIC).strip() or camera_info_topic(depth.base)
        problem = self._info_topic.listen(info, self._make_qos())
        self.set_status_row(
            "Depth Camera Info",
            "error" if problem else "warn",
            problem or phrase("No CameraInfo received on [{topic}]", topic=info),
        )
        if color.topic:
            self._color_topic = SideTopic(self.host, color.message_type, self._on_color)
            if problem := self._color_topic.listen(color.topic, self._make_qos()):
                self.set_status_row("Message", "error", problem)
            self.choose_transformer("RGB8")

    def _unsubscribe(self) -> None:
        super()._unsubscribe()
        self._info_topic.close()
        if self._color_topic is not None:
            self._color_topic.close()
            self._color_topic = None

    def _on_info(self, info: Any) -> None:
        self._info = info
        self.set_status_row("Depth Camera Info", "ok", phrase("OK"))
        self._retry_pending_depths()

    def _on_color(self, message: Any) -> None:
        self._recent_colors.append(message)
        while len(self._recent_colors) > self.max_waiting_messages():
            self._recent_colors.popleft()
        self._retry_pending_depths()

    def _retry_pending_depths(self) -> None:
        if self._pending is not None:
            self.process_message(*self._pending)

    def _has_color_topic(self) -> bool:
        return bool(self.properties.text(COLOR_TOPIC).strip())

    def _find_nearest_color(self, depth: Any) -> Any:
        """Return the color image nearest in time to a depth image, or None if none is close enough."""
        stamp_ns = self.frame_of(depth)[1]
        nearest = min(self._recent_colors, key=lambda image: abs(self.frame_of(image)[1] - stamp_ns), default=None)
        if nearest is None or abs(self.frame_of(nearest)[1] - stamp_ns) > _MAX_TIME_DIFFERENCE_NS:
            return None
        return nearest

    # --- points ------------------------------------------------------------------------------------------------

    def _show_depths(self, message: Any, pose: Pose, color: Any) -> None:
        try:
            points = self._make_points(message, pose, color)
        except BadCloudError as error:
            self.set_status_row("Message", "error", foreign(error))
            return
        except BadImageError as error:
            self.set_status_row(
                "Message", "error", phrase("Error updating depth cloud: {reason}", reason=foreign(error))
            )
            return
        frames = (message.header.frame_id, color.header.frame_id if color is not None else message.header.frame_id)
        if frames[0] != frames[1]:
            text = phrase(
                "Depth image frame id [{depth}] doesn't match color image frame id [{color}]",
                depth=frames[0],
                color=frames[1],
            )
            self.set_status_row("Message", "warn", text)
        else:
            self.set_status_row("Message", "ok", phrase("Ok"))
        self.show(points, pose, self.frame_of(message)[1])

    def _make_points(self, message: Any, pose: Pose, color: Any) -> Points:
        depth = self._depth_unpacker.image(message, self._find_depth_source().transport)
        self.set_status_row(
            "Depth Image Size", "ok", phrase("{width} x {height}", width=depth.width, height=depth.height)
        )
        image = None
        if color is not None:
            color = self._color_unpacker.image(color, self._find_color_source().transport)
            self.set_status_row(
                "Image Size", "ok", phrase("{width} x {height}", width=color.width, height=color.height)
            )
            image = decode_image(color, RangeFinder())
        camera = DepthCamera.of(self._info, depth.width, depth.height)
        self._pixel_width = camera.pixel_width
        covered_seconds = (
            self.properties.number(OCCLUSION, OCCLUSION_TIMEOUT) if self.properties.flag(OCCLUSION) else None
        )
        if covered_seconds is not None and self._has_moved(pose):
            self._builder.reset()
        return self._builder.points(depth, camera, image, covered_timeout_s=covered_seconds, now=time.monotonic())

    def _has_moved(self, pose: Pose) -> bool:
        previous_pose = self._camera_pose
        if previous_pose is not None:
            distance = float(np.linalg.norm(pose[:3] - previous_pose[:3]))
            angle = 2.0 * np.arccos(min(1.0, abs(float(np.dot(pose[3:], previous_pose[3:])))))
            if distance <= _MOVE_THRESHOLD and angle <= _TURN_THRESHOLD:
                return False
        self._camera_pose = pose
        return True
