"""The displays LaserScan, PointCloud and PointCloud2, and displays of one value such as FluidPressure."""

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
    coloured,
    decimated,
    points_of_cloud,
    points_of_legacy_cloud,
    supported_transformers,
    swept,
)
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.topic_display import TopicDisplay
from linkwright.rviz.displays.cloud_properties import (
    AUTO_INTENSITY,
    AUTO_VALUES,
    CHANNEL,
    COLOUR_PROPERTIES,
    COLOUR_TRANSFORMER,
    DECAY_TIME,
    INTENSITY_BOUNDS,
    STYLE_SPECS,
    TRANSFORMER_SPECS,
    VALUE_BOUNDS,
    colour_settings,
    scalar_specs,
)

_COUNT_PERIOD = 0.25
"""Seconds between two updates of the row that counts points."""


@dataclass(slots=True)
class _Shown:
    key: str
    points: Points
    pose: Pose
    stamp_ns: int
    received: float


class CloudDisplay(TopicDisplay):
    """The base class of displays that draw points.

    The colours are computed here and sent with the positions; the page applies style, size and opacity. With a Decay
    Time, the points of each message are sent separately, and are removed after that time.
    """

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._transformers: tuple[str, ...] = ()
        self._channels: tuple[str, ...] = ()
        super().__init__(host, identity, config)
        self._shown: deque[_Shown] = deque()
        self._number = 0
        self._decay: asyncio.TimerHandle | None = None
        self._counting: asyncio.TimerHandle | None = None
        self._computed: dict[str, tuple[float, float]] = {}

    def pixel_size(self) -> float:
        """Return the width that a point has per metre of distance, or 0 to use the size of the properties."""
        return 0.0

    def choose_transformer(self, transformer: str) -> None:
        """Select a colour transformer that the messages support; the file stays unchanged."""
        if self.properties.set_read_only((COLOUR_TRANSFORMER,), transformer):
            self.publish_properties()

    def schema(self) -> Schema:
        """Return the properties, with the transformers and channels that the last message supports."""
        offered: dict[str, tuple[str, ...]] = {}
        if self._transformers:
            offered[COLOUR_TRANSFORMER] = tuple(sorted(self._transformers))
        if self._channels:
            offered[CHANNEL] = self._channels
        if not offered:
            return self.SCHEMA
        return tuple(
            replace(spec, options=offered[spec.name]) if spec.name in offered else spec for spec in self.SCHEMA
        )

    def show(self, points: Points, pose: Pose, stamp_ns: int) -> None:
        """Show points at the pose of their frame, in addition to points within the Decay Time.

        Args:
            points: the points.
            pose: the pose of their frame in the Fixed Frame.
            stamp_ns: the stamp of the message, ns.
        """
        self._offer_transformers(points)
        now = time.monotonic()
        decay = self.properties.number(DECAY_TIME)
        self._number += 1
        if decay == 0:
            for earlier in self._shown:
                if earlier.key:
                    self.forget(earlier.key)
            self._shown.clear()
        shown = _Shown(str(self._number) if decay > 0 else "", points, pose, stamp_ns, now)
        self._shown.append(shown)
        self._draw(shown)
        self._expire()
        self._count_points()

    def changed(self, path: Path) -> None:
        """Subscribe again if necessary, colour the points again, or apply the Decay Time."""
        super().changed(path)
        if path == (AUTO_INTENSITY,):
            self._keep_bounds(AUTO_INTENSITY, *((name,) for name in INTENSITY_BOUNDS))
        elif path == (AUTO_VALUES,):
            self._keep_bounds(AUTO_VALUES, *((AUTO_VALUES, name) for name in VALUE_BOUNDS))
        if path[0] in COLOUR_PROPERTIES:
            for shown in self._shown:
                self._draw(shown)
        elif path == (DECAY_TIME,):
            self._expire()
            self._count_points()

    def reset(self) -> None:
        """Discard all points."""
        self._shown.clear()
        self._cancel()
        super().reset()

    def stop(self) -> None:
        """Unsubscribe, and cancel timers."""
        self._cancel()
        super().stop()

    def fields_of(self, key: str, index: int) -> dict[str, float | str] | None:
        """Return the channels of a point by name, or None if the point is no longer shown.

        Args:
            key: the key under which the points were sent.
            index: the index of the point among the points of this key.
        """
        shown = next((shown for shown in self._shown if shown.key == key), None)
        if shown is None or not 0 <= index < len(shown.points):
            return None
        fields: dict[str, float | str] = {}
        for name, values in shown.points.channels.items():
            value = values[index]
            if name in ("rgb", "rgba"):
                packed = int(value.astype(value.dtype.newbyteorder("=")).view("u4")) if value.itemsize == 4 else 0
                fields[name] = f"#{packed & 0xFFFFFF:06x}{packed >> 24:02x}"
            else:
                number = float(value)
                fields[name] = number if math.isfinite(number) else str(number)
        return fields

    # --- colours -----------------------------------------------------------------------------------------------

    def _draw(self, shown: _Shown) -> None:
        settings = colour_settings(self.properties)
        colours, computed = coloured(shown.points, settings, shown.pose)
        if computed is not None:
            self._computed[AUTO_INTENSITY if settings.transformer == "Intensity" else AUTO_VALUES] = computed
        content = CloudPoints(
            positions=shown.points.positions,
            colours=colours,
            translucent=settings.transformer == "RGB8" and bool((colours[:, 3] < 255).any()),
            pixel=self.pixel_size(),
        )
        shrink = partial(decimated, content)
        self.send(content, key=shown.key, pose=shown.pose, stamp_ns=shown.stamp_ns, shrink=shrink)

    def _offer_transformers(self, points: Points) -> None:
        transformers = supported_transformers(points)
        channels = ("x", "y", "z", *points.channels)
        if (transformers, channels) != (self._transformers, self._channels):
            self._transformers, self._channels = transformers, channels
            self.publish_properties()
        if self.properties.text(COLOUR_TRANSFORMER) not in transformers:
            self.choose_transformer(transformers[0])

    def _keep_bounds(self, auto: str, *paths: Path) -> None:
        """Set the bounds in the properties to the last computed ones if computing them was switched off."""
        computed = self._computed.get(auto)
        if computed is None or self.properties.flag(auto):
            return
        for path, value in zip(paths, computed, strict=True):
            taken = self.properties.set(path, value)
            self.pages.publish(PropertyChanged(self.property_id(path), taken))

    # --- decay -------------------------------------------------------------------------------------------------

    def _expire(self) -> None:
        """Remove points older than the Decay Time; if it is 0, remove all but those of the newest message."""
        if self._decay is not None:
            self._decay.cancel()
            self._decay = None
        decay = self.properties.number(DECAY_TIME)
        if decay == 0:
            self._leave(len(self._shown) - 1)
            return
        now = time.monotonic()
        self._leave(sum(now - shown.received > decay for shown in self._shown))
        if self._shown:
            due = self._shown[0].received + decay - now
            self._decay = asyncio.get_running_loop().call_later(max(0.01, due + 0.005), self._decayed)

    def _decayed(self) -> None:
        self._decay = None
        self._expire()
        self._count_points()

    def _leave(self, count: int) -> None:
        for _ in range(count):
            self.forget(self._shown.popleft().key)

    def _cancel(self) -> None:
        for handle in (self._decay, self._counting):
            if handle is not None:
                handle.cancel()
        self._decay = self._counting = None

    # --- status ------------------------------------------------------------------------------------------------

    def _count_points(self) -> None:
        if self._counting is None:
            self._report_points()
            self._counting = asyncio.get_running_loop().call_later(_COUNT_PERIOD, self._count_ended)

    def _count_ended(self) -> None:
        self._counting = None
        self._report_points()

    def _report_points(self) -> None:
        points = sum(len(shown.points) for shown in self._shown)
        self.set_status_row(
            "Points",
            "ok",
            phrase("Showing [{points}] points from [{shown}] messages", points=points, shown=len(self._shown)),
        )


_IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class PointsDisplay(CloudDisplay):
    """The base class of displays whose points a subclass extracts from each message."""

    @abstractmethod
    def points_of(self, message: Any) -> Points:
        """Return the points of a message, in the frame of the message's header.

        Raises:
            BadCloudError: the message has no usable points.
        """

    def lack_of_points(self, message: Any) -> Phrase | None:
        """Return a warning that explains why a message has no points, or None if that is normal."""
        return None

    def placed(self, points: Points, message: Any, pose: Pose) -> tuple[Points, Pose]:
        """Return the points and the pose of their frame, after a correction for the scanner's motion."""
        return points, pose

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show the points of a message, or the reason why it has none."""
        assert pose is not None
        try:
            points = self.points_of(message)
        except BadCloudError as error:
            self.set_status_row("Message", "error", foreign(error))
            return
        self.delete_status_row("Message")
        lack = self.lack_of_points(message) if len(points) == 0 else None
        self.delete_status_row("Values") if lack is None else self.set_status_row("Values", "warn", lack)
        self.show(*self.placed(points, message, pose), self.frame_of(message)[1])


class LaserScanDisplay(PointsDisplay):
    """A display of the points of a planar laser scanner.

    Each ray starts at the pose that the scanner had at the time of the ray, as in laser_geometry. If no transform is
    available for the end of a scan, the whole scan is placed at the scanner's pose at the beginning; RViz would drop
    it.
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

    def lack_of_points(self, message: Any) -> Phrase | None:
        """Return a warning if all ranges are invalid, or None.

        By REP 117, an infinite range means that no object is in range, which is not a reason for a warning.
        """
        ranges = np.frombuffer(message.ranges, np.float32)
        finite = ranges[np.isfinite(ranges)]
        if len(finite):
            return phrase(
                "All ranges, {low:.2f} to {high:.2f} m, are outside of the message's range_min and range_max, "
                "{least:.2f} and {most:.2f} m",
                low=float(finite.min()),
                high=float(finite.max()),
                least=message.range_min,
                most=message.range_max,
            )
        if len(ranges) and np.isnan(ranges).all():
            return phrase("All {count} ranges are NaN: the sensor could not measure", count=len(ranges))
        return None

    def placed(self, points: Points, message: Any, pose: Pose) -> tuple[Points, Pose]:
        """Return the points and the pose of their frame, after a correction for the scanner's motion.

        If the scanner moved during the scan, the points are in the Fixed Frame and the pose is the identity. Otherwise
        the points are in the scanner's own frame.
        """
        steps = len(message.ranges) - 1
        frame, stamp_ns = self.frame_of(message)
        seconds = steps * float(message.time_increment)
        if stamp_ns == 0 or steps < 1 or not 0.0 < seconds < 3600.0:
            return points, pose
        fixed_frame = self.host.frames.fixed_frame
        try:
            end = self.context.transforms.pose(fixed_frame, frame.removeprefix("/"), stamp_ns + int(seconds * 1e9))
        except TransformException:
            return points, pose
        if np.allclose(end, pose, rtol=0.0, atol=1e-9):
            return points, pose
        return swept(points, points.channels["index"] / steps, pose, end), _IDENTITY


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
        return points_of_legacy_cloud(message)


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
        return points_of_cloud(message)

    def lack_of_points(self, message: Any) -> Phrase | None:
        """Return a warning if the message has points but none has finite coordinates, or None."""
        count = message.width * message.height
        return phrase("All {count} points are NaN or infinite", count=count) if count else None


class ScalarDisplay(PointsDisplay):
    """The base class of displays of one measured value, as a coloured point at the sensor's origin."""

    FIELD: ClassVar[str]
    """The field of the message with the number, and the channel of the point."""

    def points_of(self, message: Any) -> Points:
        """Return a single point at the origin, with the measured value as its channel."""
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
    """A display of the temperature, in degrees Celsius; cold is violet and hot is red."""

    CLASS = "rviz_default_plugins/Temperature"
    MESSAGE = "sensor_msgs/msg/Temperature"
    FIELD = "temperature"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 100.0, inverted=True),
    )
