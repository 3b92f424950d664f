"""The displays LaserScan, PointCloud and PointCloud2, and displays of scalars."""

from __future__ import annotations

import asyncio
import math
import time
from abc import abstractmethod
from collections import deque
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.graph import TransformException
from linkwright.page.protocol.configuration import PropertyChanged
from linkwright.page.protocol.points import CloudPoints
from linkwright.rviz.clouds import (
    BadCloudError,
    Points,
    ScanProjector,
    compute_colors,
    decimate,
    deskew,
    find_supported_transformers,
    points_from_cloud,
    points_from_legacy_cloud,
)
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import TopicDisplay
from linkwright.rviz.displays.cloud_properties import (
    AUTO_INTENSITY,
    AUTO_VALUES,
    CHANNEL,
    COLOR_PROPERTIES,
    COLOR_TRANSFORMER,
    DECAY_TIME,
    INTENSITY_BOUNDS,
    STYLE_SPECS,
    TRANSFORMER_SPECS,
    VALUE_BOUNDS,
    read_color_settings,
    scalar_specs,
)

_COUNT_PERIOD_S = 0.25
"""Seconds between two updates of the status row with the number of points."""


@dataclass(slots=True)
class ShownCloud:
    """Points in pages, with the key under which they were sent, their pose, and when they arrived."""

    key: str
    points: Points
    pose: Pose
    stamp_ns: int
    received_s: float


class CloudDisplay(TopicDisplay):
    """The base class of displays that draw points.

    The colors are computed here and sent with the positions. The page applies style, size and opacity. With a Decay
    Time, the points of each message are sent separately, and are removed after that time.
    """

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._transformers: tuple[str, ...] = ()
        self._channels: tuple[str, ...] = ()
        super().__init__(host, identity, config)
        self._shown_clouds: deque[ShownCloud] = deque()
        self._number = 0
        self._decay_timer: asyncio.TimerHandle | None = None
        self._count_timer: asyncio.TimerHandle | None = None
        self._computed_bounds: dict[str, tuple[float, float]] = {}

    def pixel_size(self) -> float:
        """Return the width of a point in m at a distance of 1 m.

        If it is 0, the size in the properties applies.
        """
        return 0.0

    def choose_transformer(self, transformer: str) -> None:
        """Select a color transformer that the messages support, without changing the file."""
        if self.properties.set_read_only((COLOR_TRANSFORMER,), transformer):
            self.publish_properties()

    def schema(self) -> Schema:
        """Return the properties, with the transformers and channels that the last message supports."""
        options: dict[str, tuple[str, ...]] = {}
        if self._transformers:
            options[COLOR_TRANSFORMER] = tuple(sorted(self._transformers))
        if self._channels:
            options[CHANNEL] = self._channels
        if not options:
            return self.SCHEMA
        return tuple(
            replace(spec, options=options[spec.name]) if spec.name in options else spec for spec in self.SCHEMA
        )

    def show(self, points: Points, pose: Pose, stamp_ns: int) -> None:
        """Show points at the pose of their frame, and remove points older than the Decay Time.

        Args:
            points: the points.
            pose: the pose of the points' frame in the Fixed Frame.
            stamp_ns: the stamp of the message, in ns since the epoch.
        """
        self._offer_transformers(points)
        now = time.monotonic()
        decay_time = self.properties.number(DECAY_TIME)
        self._number += 1
        if decay_time == 0:
            for previous in self._shown_clouds:
                if previous.key:
                    self.remove_content(previous.key)
            self._shown_clouds.clear()
        cloud = ShownCloud(str(self._number) if decay_time > 0 else "", points, pose, stamp_ns, now)
        self._shown_clouds.append(cloud)
        self._draw(cloud)
        self._remove_expired()
        self._count_points()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if necessary, color the points again, or apply the Decay Time."""
        super().on_property_changed(path)
        if path == (AUTO_INTENSITY,):
            self._store_computed_bounds(AUTO_INTENSITY, *((name,) for name in INTENSITY_BOUNDS))
        elif path == (AUTO_VALUES,):
            self._store_computed_bounds(AUTO_VALUES, *((AUTO_VALUES, name) for name in VALUE_BOUNDS))
        if path[0] in COLOR_PROPERTIES:
            for cloud in self._shown_clouds:
                self._draw(cloud)
        elif path == (DECAY_TIME,):
            self._remove_expired()
            self._count_points()

    def reset(self) -> None:
        """Discard all points."""
        self._shown_clouds.clear()
        self._cancel_timers()
        super().reset()

    def stop(self) -> None:
        """Unsubscribe, and cancel timers."""
        self._cancel_timers()
        super().stop()

    def get_fields(self, key: str, index: int) -> dict[str, float | str] | None:
        """Return the channels of a point by name, or None if the point is no longer shown.

        Args:
            key: the key under which the points were sent.
            index: the index of the point among the points of this key.
        """
        shown_cloud = next((cloud for cloud in self._shown_clouds if cloud.key == key), None)
        if shown_cloud is None or not 0 <= index < len(shown_cloud.points):
            return None
        fields: dict[str, float | str] = {}
        for name, values in shown_cloud.points.channels.items():
            value = values[index]
            if name in ("rgb", "rgba"):
                packed = int(value.astype(value.dtype.newbyteorder("=")).view("u4")) if value.itemsize == 4 else 0
                fields[name] = f"#{packed & 0xFFFFFF:06x}{packed >> 24:02x}"
            else:
                number = float(value)
                fields[name] = number if math.isfinite(number) else str(number)
        return fields

    # --- colors -----------------------------------------------------------------------------------------------

    def _draw(self, cloud: ShownCloud) -> None:
        settings = read_color_settings(self.properties)
        colors, bounds = compute_colors(cloud.points, settings, cloud.pose)
        if bounds is not None:
            self._computed_bounds[AUTO_INTENSITY if settings.transformer == "Intensity" else AUTO_VALUES] = bounds
        content = CloudPoints(
            positions=cloud.points.positions,
            colors=colors,
            translucent=settings.transformer == "RGB8" and bool((colors[:, 3] < 255).any()),
            pixel=self.pixel_size(),
        )
        shrink = partial(decimate, content)
        self.send(content, key=cloud.key, pose=cloud.pose, stamp_ns=cloud.stamp_ns, shrink=shrink)

    def _offer_transformers(self, points: Points) -> None:
        transformers = find_supported_transformers(points)
        channels = ("x", "y", "z", *points.channels)
        if (transformers, channels) != (self._transformers, self._channels):
            self._transformers, self._channels = transformers, channels
            self.publish_properties()
        if self.properties.text(COLOR_TRANSFORMER) not in transformers:
            self.choose_transformer(transformers[0])

    def _store_computed_bounds(self, auto_property: str, *paths: Path) -> None:
        """Copy the last computed bounds to the properties if the bounds are no longer computed."""
        bounds = self._computed_bounds.get(auto_property)
        if bounds is None or self.properties.flag(auto_property):
            return
        for path, value in zip(paths, bounds, strict=True):
            accepted_value = self.properties.set(path, value)
            self.pages.publish(PropertyChanged(self.property_id(path), accepted_value))

    # --- decay -------------------------------------------------------------------------------------------------

    def _remove_expired(self) -> None:
        """Remove points older than the Decay Time.

        If the Decay Time is 0, keep only the points of the newest message.
        """
        if self._decay_timer is not None:
            self._decay_timer.cancel()
            self._decay_timer = None
        decay_time = self.properties.number(DECAY_TIME)
        if decay_time == 0:
            self._remove_oldest(len(self._shown_clouds) - 1)
            return
        now = time.monotonic()
        self._remove_oldest(sum(now - cloud.received_s > decay_time for cloud in self._shown_clouds))
        if self._shown_clouds:
            remaining_time = self._shown_clouds[0].received_s + decay_time - now
            self._decay_timer = asyncio.get_running_loop().call_later(max(0.01, remaining_time + 0.005), self._on_decay)

    def _on_decay(self) -> None:
        self._decay_timer = None
        self._remove_expired()
        self._count_points()

    def _remove_oldest(self, count: int) -> None:
        for _ in range(count):
            self.remove_content(self._shown_clouds.popleft().key)

    def _cancel_timers(self) -> None:
        for handle in (self._decay_timer, self._count_timer):
            if handle is not None:
                handle.cancel()
        self._decay_timer = self._count_timer = None

    # --- status ------------------------------------------------------------------------------------------------

    def _count_points(self) -> None:
        if self._count_timer is None:
            self._report_points()
            self._count_timer = asyncio.get_running_loop().call_later(_COUNT_PERIOD_S, self._on_count_period)

    def _on_count_period(self) -> None:
        self._count_timer = None
        self._report_points()

    def _report_points(self) -> None:
        points = sum(len(cloud.points) for cloud in self._shown_clouds)
        self.set_status_row(
            "Points",
            "ok",
            phrase(
                "Showing [{points}] points from [{messages}] messages", points=points, messages=len(self._shown_clouds)
            ),
        )


_IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class PointsDisplay(CloudDisplay):
    """The base class of displays that extract points from each message in `points_of`."""

    @abstractmethod
    def points_of(self, message: Any) -> Points:
        """Return the points of a message, in the frame of the message's header.

        Raises:
            BadCloudError: the message has no usable points.
        """

    def explain_missing_points(self, message: Any) -> Phrase | None:
        """Return a warning that explains why a message has no points, or None."""
        return None

    def place(self, points: Points, message: Any, pose: Pose) -> tuple[Points, Pose]:
        """Return the points and the pose of their frame, corrected for the scanner's motion.

        By default, both are returned unchanged.
        """
        return points, pose

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the points of a message, or the reason why it has no points."""
        assert pose is not None
        try:
            points = self.points_of(message)
        except BadCloudError as error:
            self.set_status_row("Message", "error", foreign(error))
            return
        self.delete_status_row("Message")
        warning = self.explain_missing_points(message) if len(points) == 0 else None
        self.delete_status_row("Values") if warning is None else self.set_status_row("Values", "warn", warning)
        self.show(*self.place(points, message, pose), self.frame_of(message)[1])


class LaserScanDisplay(PointsDisplay):
    """A display of the points of a planar laser scanner.

    Each ray starts at the pose that the scanner had at the time of the ray, as in laser_geometry. If no transform is
    available for the end of a scan, the whole scan is placed at the pose of the scanner at its beginning, while RViz
    drops the scan.
    """

    CLASS = "rviz_default_plugins/LaserScan"
    MESSAGE = "sensor_msgs/msg/LaserScan"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._projector = ScanProjector()

    def points_of(self, message: Any) -> Points:
        """Return the end points of the rays that hit an object."""
        return self._projector.points(message)

    def explain_missing_points(self, message: Any) -> Phrase | None:
        """Return a warning if all ranges are invalid, or None.

        By REP 117, an infinite range means that no object is in range. This is not a reason for a warning.
        """
        ranges = np.frombuffer(message.ranges, np.float32)
        finite = ranges[np.isfinite(ranges)]
        if len(finite):
            return phrase(
                "All ranges, {shortest:.2f} to {longest:.2f} m, are outside the range limits of the message, "
                "{minimum:.2f} to {maximum:.2f} m",
                shortest=float(finite.min()),
                longest=float(finite.max()),
                minimum=message.range_min,
                maximum=message.range_max,
            )
        if len(ranges) and np.isnan(ranges).all():
            return phrase("All {count} ranges are NaN: the sensor measured nothing", count=len(ranges))
        return None

    def place(self, points: Points, message: Any, pose: Pose) -> tuple[Points, Pose]:
        """Return the points and the pose of their frame, corrected for the scanner's motion.

        If the scanner moved during the scan, the points are in the Fixed Frame and the pose is the identity. Otherwise
        the points are in the frame of the scanner.
        """
        interval_count = len(message.ranges) - 1
        frame, stamp_ns = self.frame_of(message)
        duration = interval_count * float(message.time_increment)
        if stamp_ns == 0 or interval_count < 1 or not 0.0 < duration < 3600.0:
            return points, pose
        fixed_frame = self.host.frames.fixed_frame
        try:
            end_pose = self.context.transforms.pose(
                fixed_frame, frame.removeprefix("/"), stamp_ns + int(duration * 1e9)
            )
        except TransformException:
            return points, pose
        if np.allclose(end_pose, pose, rtol=0.0, atol=1e-9):
            return points, pose
        return deskew(points, points.channels["index"] / interval_count, pose, end_pose), _IDENTITY


class PointCloudDisplay(PointsDisplay):
    """A display of point clouds in the legacy message type sensor_msgs/msg/PointCloud."""

    CLASS = "rviz_default_plugins/PointCloud"
    MESSAGE = "sensor_msgs/msg/PointCloud"
    SCHEMA = (
        topic_spec(description="sensor_msgs/msg/PointCloud", filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def points_of(self, message: Any) -> Points:
        """Return the points with finite coordinates."""
        return points_from_legacy_cloud(message)


class PointCloud2Display(PointsDisplay):
    """A display of point clouds of type sensor_msgs/msg/PointCloud2."""

    CLASS = "rviz_default_plugins/PointCloud2"
    MESSAGE = "sensor_msgs/msg/PointCloud2"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *STYLE_SPECS,
        *TRANSFORMER_SPECS,
    )

    def points_of(self, message: Any) -> Points:
        """Return the points with finite coordinates."""
        return points_from_cloud(message)

    def explain_missing_points(self, message: Any) -> Phrase | None:
        """Return a warning if the message has points but none has finite coordinates, or None."""
        count = message.width * message.height
        return phrase("All {count} points are NaN or infinite", count=count) if count else None


class ScalarDisplay(PointsDisplay):
    """The base class of displays of a scalar, as a colored point at the sensor's origin."""

    FIELD: ClassVar[str]
    """The message field that contains the scalar. The channel of the point has the same name."""

    def points_of(self, message: Any) -> Points:
        """Return a single point at the origin, with the measured value as a channel."""
        value = np.array([getattr(message, self.FIELD)], np.float64)
        return Points(np.zeros((1, 3), np.float32), {self.FIELD: value})


class FluidPressureDisplay(ScalarDisplay):
    """A display of the pressure of air or water, in pascals."""

    CLASS = "rviz_default_plugins/FluidPressure"
    MESSAGE = "sensor_msgs/msg/FluidPressure"
    FIELD = "fluid_pressure"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 98000.0, 105000.0),
    )


class IlluminanceDisplay(ScalarDisplay):
    """A display of the illuminance, in lux."""

    CLASS = "rviz_default_plugins/Illuminance"
    MESSAGE = "sensor_msgs/msg/Illuminance"
    FIELD = "illuminance"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 1000.0),
    )


class RelativeHumidityDisplay(ScalarDisplay):
    """A display of the relative humidity of the air, 0 to 1."""

    CLASS = "rviz_default_plugins/RelativeHumidity"
    MESSAGE = "sensor_msgs/msg/RelativeHumidity"
    FIELD = "relative_humidity"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 1.0),
    )


class TemperatureDisplay(ScalarDisplay):
    """A display of the temperature in degrees Celsius, from violet for cold to red for hot."""

    CLASS = "rviz_default_plugins/Temperature"
    MESSAGE = "sensor_msgs/msg/Temperature"
    FIELD = "temperature"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 100.0, inverted=True),
    )
